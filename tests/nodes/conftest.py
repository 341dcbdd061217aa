"""Running a piece of source text as an unmodified program on a kernel of its own."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.nodes import Universe
from cfepy.rtos import Kernel
from cfepy.trace import Trace

CONTEXTS = ("thread", "greenlet")


class Program:
    """A program that ran, or is running.

    Args:
        kernel: the computer it runs on.
        universe: its universe.
        traps: the loops in it that waited without a sleep.
    """

    def __init__(self, kernel: Kernel, universe: Universe, traps: list[object]) -> None:
        self.kernel = kernel
        self.universe = universe
        self.traps = traps

    @property
    def lines(self) -> list[str]:
        """Return its output, without the node's name."""
        start = len(self.universe.name) + 3
        return [line[start:] for line in self.universe.output]

    @property
    def text(self) -> str:
        """The same as one text."""
        return "\n".join(self.lines)

    def global_(self, name: str) -> Any:
        """Return a global of its `__main__`."""
        return getattr(self.universe.importer.modules["__main__"], name)


@pytest.fixture(params=CONTEXTS)
def context(request: pytest.FixtureRequest) -> str:
    """Both task contexts."""
    return str(request.param)


@pytest.fixture
def start(context: str, tmp_path: Path) -> Iterator[Callable[..., Program]]:
    """Make and start a program from source text; further programs share the kernel of the first."""
    with Kernel(context=context, trace=Trace()) as kernel:

        def begin(source: str, name: str = "node", **options: Any) -> Program:
            script = tmp_path / f"{name}.py"
            script.write_text(textwrap.dedent(source), encoding="utf-8")
            traps: list[object] = []
            universe = Universe(kernel, name=name, script=script, traps=traps, **options)
            universe.spawn()
            return Program(kernel, universe, traps)

        yield begin


@pytest.fixture
def run(start: Callable[..., Program]) -> Callable[..., Program]:
    """Run a program to its end."""

    def whole(source: str, **options: Any) -> Program:
        program = start(source, **options)
        program.kernel.run()
        return program

    return whole
