"""`OpenFiles`: the files that a program has open, which are written out and closed when it ends, as Python does it.

Left to the garbage collector, the parts of a file would be closed in any order, and what is still in its buffer lost.
Imports nothing of cfepy.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from typing import IO, Any
from weakref import WeakValueDictionary

_PATHS = (str, bytes, os.PathLike)


class OpenFiles:
    """The open files of one program.

    Args:
        resolve: makes a path of the program one of the computer.
    """

    def __init__(self, resolve: Callable[[Any], str]) -> None:
        self._resolve = resolve
        self._files: WeakValueDictionary[int, IO[Any]] = WeakValueDictionary()
        self._numbers = count()

    def opener(self) -> Callable[..., IO[Any]]:
        """The program's `open`, with paths relative to its working directory."""

        def open_file(file: Any, *args: Any, **options: Any) -> IO[Any]:
            opened: IO[Any] = open(self._resolve(file) if isinstance(file, _PATHS) else file, *args, **options)  # noqa: SIM115
            self._files[next(self._numbers)] = opened
            return opened

        return open_file

    def close_all(self) -> None:
        """The program has ended; a full disk is not its problem any more."""
        for opened in list(self._files.values()):
            with suppress(OSError, ValueError):
                opened.close()
