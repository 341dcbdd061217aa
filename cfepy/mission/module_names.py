"""Names in `sys.modules` for the code of applications: unique in the process, yet the same in every run.

They can be seen from inside a mission (in a traceback, in `__name__`), so no address of an object may be in them: each
mission takes the lowest number that no other living mission has. Imports nothing of cfepy.
"""

from __future__ import annotations

import sys
from itertools import count
from types import ModuleType

PREFIX = "cfepy_app_"


class ModuleNames:
    """The names of one mission."""

    def __init__(self) -> None:
        self._root = ""
        self._number = 0
        self._of: dict[str, str] = {}

    def new(self, owner: str) -> str:
        """A name for the module of an application; the one it had before goes, so that restarts pile up nothing."""
        if not self._root:
            self._root = _take_root()
        self._forget(self._of.pop(owner, ""))
        self._number += 1
        self._of[owner] = name = f"{self._root}_{self._number}"
        return name

    def forget(self) -> None:
        """Take all modules of the mission out of the process."""
        for name in self._of.values():
            self._forget(name)
        self._of.clear()
        sys.modules.pop(self._root, None)
        self._root = ""

    def _forget(self, name: str) -> None:
        """A module, and those that it consists of."""
        for each in [each for each in list(sys.modules) if each.partition(".")[0] == name]:
            del sys.modules[each]


def _take_root() -> str:
    mine = ModuleType(PREFIX)  # holds the place
    return next(root for root in map(f"{PREFIX}{{}}".format, count()) if sys.modules.setdefault(root, mine) is mine)
