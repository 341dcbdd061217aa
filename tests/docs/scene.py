"""The environment of a page's reader, and how its commands are executed here: a page's part of scenes.yaml."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from tests.docs.pages import ROOT, Block, blocks, commands, name_of

CTRL_C = 130
SCENES = Path(__file__).with_name("scenes.yaml")


@dataclass(frozen=True)
class Step:
    """How to execute one command, and its expected results.

    Attributes:
        status: its exit status; by default 130 after Ctrl-C and 0 otherwise.
        typed: its standard input, which ends then.
        ready: a pattern; after printing it, the command runs in the background until Ctrl-C at the end of the page.
        until: a pattern; Ctrl-C follows as soon as the command has printed it.
        ends: background commands that end before it, as written on the page.
        says: a text that it must have printed.
        shown: a text in the code block of the page with its output, if that is not below the command.
        differs: why its output here differs from the page.
        needs: programs without which it is left out.
    """

    status: int | None = None
    typed: str = ""
    ready: str = ""
    until: str = ""
    ends: tuple[str, ...] = ()
    says: str = ""
    shown: str = ""
    differs: str = ""
    needs: tuple[str, ...] = ()

    @property
    def ends_with(self) -> int:
        """Its exit status."""
        if self.status is not None:
            return self.status
        return CTRL_C if self.ready or self.until else 0

    @property
    def is_left_out(self) -> bool:
        """Return whether this computer lacks a program that it needs."""
        return any(shutil.which(program) is None for program in self.needs)


@dataclass(frozen=True)
class Scene:
    """A page's scene.

    Attributes:
        elsewhere: command to the file of the test that runs it unchanged.
        needs: programs without which the page is left out.
        files: path in the scratch folder to path in the repository, None for the same, or to `{block: TEXT}` for the
            page's code block that contains this text; `{block: TEXT, page: PAGE}` is a block of another page.
        before: commands that the reader executed before the page.
        instead: text in commands to its replacement here, so that they end soon or find a computer.
        steps: command to a step, if it needs more than running.
        not_run: command to the reason why it is not run here.
    """

    page: Path
    elsewhere: dict[str, str] = field(default_factory=dict)
    needs: tuple[str, ...] = ()
    files: dict[str, Any] = field(default_factory=dict)
    before: tuple[str, ...] = ()
    instead: dict[str, str] = field(default_factory=dict)
    steps: dict[str, dict[str, Any]] = field(default_factory=dict)
    not_run: dict[str, str] = field(default_factory=dict)

    @property
    def commands(self) -> list[str]:
        """The commands that are run, as they stand on the page."""
        others = {*self.not_run, *self.elsewhere}
        own = [command for command in commands(self.page) if command not in others]
        return [*self.before, *own] if own else []

    def step(self, command: str) -> Step:
        """How a command is given."""
        return Step(**self.steps.get(command, {}))

    def line(self, command: str) -> str:
        """Return a command as it is run."""
        for text, other in self.instead.items():
            command = command.replace(text, other)
        return command

    def shown(self, command: str) -> str:
        """Return the page's output of a command, or "" for none."""
        step = self.step(command)
        if step.shown:
            return self._block_with(step.shown).text
        return "" if step.differs else self._below().get(command, "")

    def set_up(self, folder: Path) -> None:
        """Put the reader's files into a folder."""
        for name, source in self.files.items():
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            if isinstance(source, dict):
                target.write_text(self._block_with(**source).text, encoding="utf-8")
            elif (ROOT / (source or name)).is_dir():
                shutil.copytree(ROOT / (source or name), target, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(ROOT / (source or name), target)

    def idle(self) -> Iterator[str]:
        """Entries of the scene that fit nothing on the page."""
        given = commands(self.page)
        yield from (command for command in (*self.not_run, *self.elsewhere) if command not in given)
        yield from (command for command in self.steps if command not in self.commands)
        yield from (text for text in self.instead if not any(text in command for command in self.commands))
        for name, source in self.files.items():
            if isinstance(source, dict):
                self._block_with(**source)
            elif not (ROOT / (source or name)).exists():
                yield name
        for command in self.steps:
            step = self.step(command)
            if step.shown:
                self._block_with(step.shown)
            if step.differs and not self._below().get(command, "").strip():
                yield f"{command}: differs"

    def _below(self) -> dict[str, str]:
        return {command: shown for block in blocks(self.page) for command, shown in block.session}

    def _block_with(self, block: str, page: str = "") -> Block:
        found = [each for each in blocks(ROOT / page if page else self.page) if block in each.text]
        assert len(found) == 1, f"{len(found)} blocks of {page or self.page} contain {block!r}"
        return found[0]


@cache
def table() -> dict[str, dict[str, Any]]:
    """Return the scenes by page, unprocessed."""
    found: dict[str, dict[str, Any]] = yaml.safe_load(SCENES.read_text(encoding="utf-8"))["pages"]
    return found


def scene_of(page: Path) -> Scene:
    """Return the scene of a page.

    Raises:
        KeyError: it has none.
    """
    return Scene(page, **table()[name_of(page)] or {})


def overlooked(page: Path) -> list[str]:
    """Return the commands of a page without a scene, and lines that look like commands but are not read as such."""
    unread = [line for block in blocks(page) for line in block.overlooked]
    return unread if name_of(page) in table() else [*commands(page), *unread]
