"""Modules whose code runs when somebody first looks for a name in them: what saves a small node half of `logging`.

They are in the node's table like any other, and nothing else tells that their code has not run yet. Stands for
`importlib.util.LazyLoader`. Imports nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

_RUN = "__run__"


class LateModule(ModuleType):
    """A module before its code has run."""

    def __getattr__(self, name: str) -> Any:
        if name == "__path__":  # asked of every module, by whoever imports something from it; a package is never late
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        _wake(self)
        return getattr(self, name)

    def __setattr__(self, name: str, value: Any) -> None:
        _wake(self)
        setattr(self, name, value)

    def __delattr__(self, name: str) -> None:
        _wake(self)
        delattr(self, name)

    def __dir__(self) -> list[str]:
        _wake(self)
        return dir(self)


def postpone(module: ModuleType, run: Callable[[], object]) -> ModuleType:
    """Have the code of a module run later.

    Args:
        module: one that nothing has happened to yet.
        run: executes its code.
    """
    vars(module)[_RUN] = run
    module.__class__ = LateModule
    return module


def _wake(module: ModuleType) -> None:
    """Run the module's code; while it runs, it is a module like any other."""
    run = vars(module).pop(_RUN)
    object.__setattr__(module, "__class__", ModuleType)
    try:
        run()
    except BaseException:
        postpone(module, run)
        raise
