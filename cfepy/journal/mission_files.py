"""The files that make a mission, as they were when it ran: found, hashed, and kept for a journal.

What a mission with a startup script can use is in its folder, which is taken as a whole. What else is read on the way,
by nodes, applications, launch files or their libraries, is seen when it is opened, and so are the folders that nodes
look into: an audit hook of Python reports it. A process has one hook for all runs, since hooks cannot be taken away.
What belongs to Python, to installed packages or to cfepy itself is left out: the versions stand for it.
"""

from __future__ import annotations

import importlib.util
import os
import site
import stat
import sys
import sysconfig
import zlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from hashlib import file_digest, sha256
from pathlib import Path
from typing import Any

from cfepy.journal.computer_facts import own_places
from cfepy.mission import MissionSpec
from cfepy.nodes import ASKED, LISTED, MADE, NEEDED
from cfepy.nodes.node_sources import AGAIN
from cfepy.reading.input_files import open_input, read_limited
from cfepy.status import UsageError

CARRIED = 32 << 20  # bytes of files that a journal carries, before they are compressed
MOST_FILES = 5_000  # of a folder
_SKIPPED = ("__pycache__",)
_BYTE_CODE = ".pyc"
_VOLATILE = ("/proc/", "/sys/", "/dev/")  # no files, but questions to the operating system


@dataclass(frozen=True, slots=True)
class MissionFile:
    """A file of the computer that a run had.

    Attributes:
        path: absolute.
        size: in bytes.
        sha256: of its content, hexadecimal; empty when it could not be had.
        packed: its content, compressed; None when the journal does not carry it.
        mode: its permissions.
    """

    path: str
    size: int
    sha256: str
    packed: bytes | None = None
    mode: int = 0o777

    @property
    def data(self) -> bytes | None:
        """Its content, if the journal carries it.

        Raises:
            UsageError: what is packed is not the file.
        """
        if self.packed is None:
            return None
        unpacker = zlib.decompressobj()
        try:
            content = unpacker.decompress(self.packed, self.size + 1)
        except zlib.error as error:
            raise UsageError(f"the journal's copy of {self.path} is damaged: {error}") from None
        if len(content) != self.size or sha256(content).hexdigest() != self.sha256:
            raise UsageError(f"the journal's copy of {self.path} does not match its checksum; record the run again")
        return content

    def same_on_disk(self) -> bool:
        """Whether the file at its path has this content now."""
        try:
            if not self.sha256:
                return not (os.path.isfile(self.path) and os.access(self.path, os.R_OK))
            is_like = os.path.isfile(self.path) and os.path.getsize(self.path) == self.size
            return is_like and self._digest_on_disk() == self.sha256
        except (OSError, ValueError):
            return not self.sha256

    def _digest_on_disk(self) -> str:
        with open_input(self.path) as file:
            return file_digest(file, "sha256").hexdigest()


class Carrier:
    """Reads files, and says which contents are still to be carried.

    Args:
        limit: bytes of contents that are carried altogether; 0 for none.
    """

    def __init__(self, limit: int) -> None:
        self._left = limit

    def take(self, path: str) -> MissionFile:
        """A file as it is now."""
        try:
            content = read_limited(path, sys.maxsize)
        except (OSError, UsageError):
            return MissionFile(path, 0, "")
        packed = None
        if len(content) <= self._left:
            self._left -= len(content)
            packed = zlib.compress(content)
        mode = stat.S_IMODE(os.stat(path).st_mode)
        return MissionFile(path, len(content), sha256(content).hexdigest(), packed, mode)


def files_of(spec: MissionSpec) -> list[str]:
    """The files that a mission can use by itself, sorted: its folder's, if it has a startup script."""
    if spec.startup is not None and spec.mission_file is None:
        return []  # made from a launch file or a node script, which may lie anywhere; what it uses is seen
    found = [str(path) for path in _below(spec.folder)]
    return sorted({*found, str(spec.script)})


def _below(folder: Path) -> Iterator[Path]:
    count = 0
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in _SKIPPED)
        for name in sorted(names):
            path = Path(place, name)
            if path.is_file() and not name.startswith("."):
                count += 1
                if count > MOST_FILES:
                    return
                yield path


def hash_of(files: Iterable[MissionFile]) -> str:
    """SHA-256 over names and contents."""
    whole = sha256()
    for each in sorted(files, key=lambda file: file.path):
        whole.update(f"{each.path}\0{each.size}\0{each.sha256}\n".encode())
    return whole.hexdigest()


class ReadFiles:
    """Tells of each file that is opened for reading, once; use as a context manager.

    Args:
        seen: gets the absolute path. It may open files, which are not told.
        listed: gets the absolute path of a folder that a node looks into for the first time, and the names in it but
            for those of files that the run has written.
        asked: gets the absolute path, without links but for its last part, of what the run looks for, whether it is
            there or not.
    """

    def __init__(
        self,
        seen: Callable[[str], object],
        listed: Callable[[str, list[str]], object] = lambda path, names: None,
        asked: Callable[[str], object] = lambda path: None,
    ) -> None:
        self._seen = seen
        self._listed = listed
        self._asked = asked
        self._known: set[str] = set()
        self._written: set[str] = set()
        self._own: list[str] = []
        self._needed: set[str] = set()  # folders of which only that is known
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

    def forget_below(self, folder: str) -> None:
        """What the run itself has written is there, and no file of the computer."""
        self._own.append(os.path.join(folder, ""))

    def is_product(self, path: str) -> bool:
        """Whether the run, or an attachment, has written a file."""
        return path in self._written

    def opened(self, path: Any, flags: int) -> None:
        """A file is opened."""
        if self._busy or isinstance(path, int) or not isinstance(path, (str, bytes, os.PathLike)):
            return
        name = os.path.abspath(os.fsdecode(path))
        if name in self._known or name.startswith(tuple(self._own)):
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
        if (folder not in self._known or (names and folder in self._needed)) and not folder.startswith(
            (*_VOLATILE, *_left_out())
        ):
            self._known.add(folder)
            (self._needed.discard if names else self._needed.add)(folder)
            found = [os.fsdecode(name) for name in names]
            self._listed(folder, [name for name in found if os.path.join(folder, name) not in self._written])

    def looked_for(self, path: str) -> None:
        """The run looks whether something is at a path."""
        if self._busy or path in self._written or path.startswith((*_VOLATILE, *_left_out(), *self._own)):
            return
        self._asked(path)

    def _told(self, source: str) -> None:
        self._busy = True
        try:
            if os.path.isfile(source):
                self._seen(source)
        finally:
            self._busy = False


@cache
def _listeners() -> list[ReadFiles]:
    """The listeners of the one hook of this process."""
    found: list[ReadFiles] = []

    def hook(event: str, values: tuple[Any, ...]) -> None:
        for each in tuple(found):
            if event == "open":
                each.opened(values[0], values[2])
            elif event == AGAIN:
                each.opened(values[0], os.O_RDONLY)
            elif event == ASKED:
                each.looked_for(values[0])
            elif event == NEEDED:
                each.looked_into(values[0], ())
            elif event == MADE:
                each.forget_below(values[0])
            elif event == LISTED:
                each.looked_into(*values)

    _left_out()  # now: it asks sysconfig, which may be in the middle of its own files when the hook is called
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
