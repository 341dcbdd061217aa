"""Waiting until a person changes files: their stamps are compared a few times a second."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path

LOOK_S = 0.3
MOST_FILES = 5_000  # of a folder
_LEFT_OUT = ("__pycache__",)
_ENDINGS = (".pyc", "~", ".swp")

Stamp = tuple[int, int, int]
"""Time of the last change in ns, size, and number of the file."""


class WatchedFiles:
    """Files and a folder with their stamps.

    Args:
        folder: all files in it count, also new ones, but none that is hidden or that Python or editors make; None for
            none.
        files: further files.
        but: files and folders that do not count.

    Attributes:
        stamps: the stamps of the files that exist.
    """

    def __init__(self, folder: Path | None, files: Iterable[str] = (), but: Collection[str] = ()) -> None:
        self._folder = folder
        self._but = tuple(os.path.abspath(each) for each in but)
        self._files = {os.path.abspath(each) for each in files}
        self.stamps: Mapping[str, Stamp] = self._present()

    def add(self, files: Iterable[str]) -> None:
        """Watch more files, from their present stamps on."""
        new = {os.path.abspath(each) for each in files} - self._files
        self._files |= new
        found = ((path, _stamp(path)) for path in new if path not in self.stamps and self._counts(path))
        self.stamps = {**self.stamps, **{path: stamp for path, stamp in found if stamp is not None}}

    def changed(self) -> list[str]:
        """Return the files that were changed, made or removed since the stamps, sorted."""
        now, then = self._present(), self.stamps
        return sorted(path for path in {*now, *then} if now.get(path) != then.get(path))

    def wait(self, pause: Callable[[float], object] = time.sleep) -> list[str]:
        """Wait until files have changed, and then until they rest; return the changed ones.

        Args:
            pause: waits for a number of seconds.
        """
        before = dict(self.stamps)
        while True:
            pause(LOOK_S)
            now = self._present()
            if now == before and (found := self.changed()):  # an editor may write several files
                self.stamps = now
                return found
            before = now

    def _counts(self, path: str) -> bool:
        return not any(path == each or path.startswith(each + os.sep) for each in self._but)

    def _present(self) -> dict[str, Stamp]:
        paths = {*self._files, *(() if self._folder is None else _below(self._folder))}
        found = ((path, _stamp(path)) for path in paths if self._counts(path))
        return {path: stamp for path, stamp in found if stamp is not None}


def _stamp(path: str) -> Stamp | None:
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def _below(folder: Path) -> list[str]:
    found: list[str] = []
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in _LEFT_OUT)
        found += (
            os.path.abspath(os.path.join(place, name))
            for name in sorted(names)
            if not name.startswith(".") and not name.endswith(_ENDINGS)
        )
        if len(found) > MOST_FILES:
            break
    return found
