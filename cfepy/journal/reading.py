"""Seeing which files a run reads, whoever opens them: nodes, applications, launch files, their libraries; and which
folders its nodes look into.

Python tells an audit hook of each file that is opened; a process has one hook for all runs, since hooks cannot be
taken away. What belongs to Python, to installed packages or to cfepy itself is left out: the versions stand for it.
"""

from __future__ import annotations

import importlib.util
import os
import site
import sys
import sysconfig
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

from cfepy.journal.facts import own_places
from cfepy.nodes.os_module import LISTED
from cfepy.nodes.sources import AGAIN

_BYTE_CODE = ".pyc"
_VOLATILE = ("/proc/", "/sys/", "/dev/")  # no files, but questions to the operating system


class ReadFiles:
    """Tells of each file that is opened for reading, once; use as a context manager.

    Args:
        seen: gets the absolute path. It may open files, which are not told.
        listed: gets the absolute path of a folder that a node looks into for the first time, and the names in it but
            for those of files that the run has written.
    """

    def __init__(
        self, seen: Callable[[str], object], listed: Callable[[str, list[str]], object] = lambda path, names: None
    ) -> None:
        self._seen = seen
        self._listed = listed
        self._known: set[str] = set()
        self._written: set[str] = set()
        self._busy = False

    def __enter__(self) -> ReadFiles:
        _listeners().append(self)
        return self

    def __exit__(self, *error: object) -> None:
        _listeners().remove(self)

    def forget(self, path: str) -> None:
        """A file that is none of the run's."""
        self._known.add(os.path.abspath(path))
        self._written.add(os.path.abspath(path))

    def is_product(self, path: str) -> bool:
        """Whether the run, or what looks on, has written a file."""
        return path in self._written

    def opened(self, path: Any, flags: int) -> None:
        """A file is opened."""
        if self._busy or isinstance(path, int) or not isinstance(path, (str, bytes, os.PathLike)):
            return
        name = os.path.abspath(os.fsdecode(path))
        if name in self._known:
            return
        self._known.add(name)
        if flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT):
            self._written.add(name)
            return  # what a run writes is its own product, also when it reads it again
        source = _source_of(name)
        if (source in self._known and source != name) or source.startswith((*_VOLATILE, *_left_out())):
            return
        self._known.add(source)
        self._told(source)

    def looked_into(self, path: Any, names: Sequence[Any]) -> None:
        """A node looks into a folder."""
        if self._busy or isinstance(path, int):
            return
        folder = os.path.abspath(os.fsdecode(path))
        if folder not in self._known and not folder.startswith((*_VOLATILE, *_left_out())):
            self._known.add(folder)
            found = [os.fsdecode(name) for name in names]
            self._listed(folder, [name for name in found if os.path.join(folder, name) not in self._written])

    def _told(self, source: str) -> None:
        self._busy = True
        try:
            if os.path.isfile(source):
                self._seen(source)
        finally:
            self._busy = False


@cache
def _listeners() -> list[ReadFiles]:
    """Who is told by the one hook of this process."""
    found: list[ReadFiles] = []

    def hook(event: str, values: tuple[Any, ...]) -> None:
        for each in tuple(found):
            if event == "open":
                each.opened(values[0], values[2])
            elif event == AGAIN:
                each.opened(values[0], os.O_RDONLY)
            elif event == LISTED:
                each.looked_into(*values)

    sys.addaudithook(hook)
    return found


def _source_of(name: str) -> str:
    """What a file of byte code was made of."""
    if not name.endswith(_BYTE_CODE):
        return name
    try:
        return importlib.util.source_from_cache(name)
    except ValueError:
        return name


@cache
def _left_out() -> tuple[str, ...]:
    """Where Python, installed packages and cfepy itself lie."""
    places = {sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    places |= {*site.getsitepackages(), site.getusersitepackages(), *own_places()}
    names = {name for place in places if place for name in (place, os.path.realpath(place))}
    return tuple(sorted(os.path.join(name, "") for name in names))
