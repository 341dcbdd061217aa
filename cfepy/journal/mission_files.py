"""The files of a mission, as they were during the run: found, hashed, and stored for a journal.

A mission with a startup script uses its folder, which is taken as a whole. Other files that nodes, applications, launch
files or their libraries read, and folders that nodes list, are reported by a Python audit hook. A process has one hook
for all runs, since hooks cannot be removed. Files of Python, installed packages and cfepy itself are left out, since
the versions identify them.
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

CARRIED = 32 << 20  # maximum number of bytes of files in a journal, before compression
MOST_FILES = 5_000  # maximum number of files of a folder
_SKIPPED = ("__pycache__",)
_BYTE_CODE = ".pyc"
_VOLATILE = ("/proc/", "/sys/", "/dev/")  # not files, but queries to the operating system


@dataclass(frozen=True, slots=True)
class MissionFile:
    """A file used by a run.

    Attributes:
        path: absolute path.
        size: size in bytes.
        sha256: hash of the contents, in hexadecimal; empty if the contents could not be read.
        packed: compressed contents; None if the journal does not contain them.
        mode: its permissions.
    """

    path: str
    size: int
    sha256: str
    packed: bytes | None = None
    mode: int = 0o777

    @property
    def data(self) -> bytes | None:
        """Return its contents, if the journal contains them.

        Raises:
            UsageError: if the packed data is not the file.
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
        """Return whether the file at its path has this content now."""
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
    """Reads files, and decides which contents are still stored.

    Args:
        limit: maximum number of bytes of all stored contents; 0 for none.
    """

    def __init__(self, limit: int) -> None:
        self._left = limit

    def take(self, path: str) -> MissionFile:
        """Return a file as it is now."""
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
    """Return the files that a mission can use by itself, sorted: the files of its folder, if it has a startup
    script.
    """
    if spec.startup is not None and spec.mission_file is None:
        return []  # made from a launch file or a node script, which may be anywhere; files that it uses are observed
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
    """Return the SHA-256 over names and contents."""
    whole = sha256()
    for each in sorted(files, key=lambda file: file.path):
        whole.update(f"{each.path}\0{each.size}\0{each.sha256}\n".encode())
    return whole.hexdigest()


class ReadFiles:
    """Reports each file that is opened for reading, once; use as a context manager.

    Args:
        seen: receives the absolute path. Files that it opens are not reported.
        listed: receives the absolute path of a folder at its first listing by a node, and the names in it without files
            that the run has written.
        asked: receives the absolute path of each file or folder that the run checks, whether it exists or not, with
            links resolved except in the last part.
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
        self._needed: set[str] = set()  # folders that are only known to be needed
        self._busy = False

    def __enter__(self) -> ReadFiles:
        _listeners().append(self)
        return self

    def __exit__(self, *error: object) -> None:
        _listeners().remove(self)

    def forget(self, path: str) -> None:
        """Report a file that does not belong to the run."""
        self._known.add(os.path.abspath(path))
        self._written.add(os.path.abspath(path))

    def forget_below(self, folder: str) -> None:
        """Files that the run has written exist, but are not files of the computer."""
        self._own.append(os.path.join(folder, ""))

    def is_product(self, path: str) -> bool:
        """Return whether the run, or an attachment, has written a file."""
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
            return  # a file written by the run is its own product, even if the run reads it again
        source = _source_of(name)
        if (source in self._known and source != name) or source.startswith((*_VOLATILE, *_left_out())):
            return
        self._known.add(source)
        self._told(source)

    def looked_into(self, path: Any, names: Sequence[Any]) -> None:
        """A node lists a folder."""
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
        """The run checks whether a path exists."""
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
    """Return the listeners of the one hook of this process."""
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

    _left_out()  # at once: it asks sysconfig, which may be in use when the hook is called
    sys.addaudithook(hook)
    return found


def _source_of(name: str) -> str:
    """Return the source of a byte code file."""
    if not name.endswith(_BYTE_CODE):
        return name
    try:
        return importlib.util.source_from_cache(name)
    except ValueError:
        return name


@cache
def _left_out() -> tuple[str, ...]:
    """Return the folders of Python, installed packages and cfepy itself."""
    places = {sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    places |= {*site.getsitepackages(), site.getusersitepackages(), *own_places()}
    names = {name for place in places if place for name in (place, os.path.realpath(place))}
    return tuple(sorted(os.path.join(name, "") for name in names))
