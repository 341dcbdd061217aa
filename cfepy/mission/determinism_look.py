"""Looking at a run in the very moment in which it makes a certain record of its trace: who, where, after what.

May import cfepy.nodes, cfepy.trace and cfepy.mission.
"""

from __future__ import annotations

import linecache
import sys
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from hashlib import blake2b
from pathlib import Path
from types import FrameType
from typing import Any

from cfepy.nodes.sources import own_files
from cfepy.trace import Trace

_CFEPY = str(Path(__file__).parents[1])
_ROSPY = str(Path(__file__).parents[2] / "rospy_shim")
_LIBRARIES = str(Path(_ROSPY, "libraries"))
_STANDARD_LIBRARY = str(Path(linecache.__file__).parent)
_INSTALLED = ("site-packages", "dist-packages")


@dataclass(frozen=True, slots=True)
class Line:
    """A line of code that was being executed: file, number, function, and its text."""

    file: str
    number: int
    function: str
    source: str


@dataclass(frozen=True, slots=True)
class Look:
    """What was seen at a record.

    Attributes:
        record: its bytes; empty when the run was over before.
        before: stands for all records before it.
        lines: the last records before it and the record itself, as text.
        stack: the lines of node, application and libraries that were being executed, outermost first.
        files: the nodes' own source files.
    """

    record: bytes
    before: str
    lines: tuple[str, ...]
    stack: tuple[Line, ...]
    files: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Itself as plain data."""
        return asdict(self) | {"record": self.record.hex()}

    @classmethod
    def from_dict(cls, plain: dict[str, Any]) -> Look:
        """The other way round."""
        stack = tuple(Line(**line) for line in plain["stack"])
        record = bytes.fromhex(plain["record"])
        return cls(record, plain["before"], tuple(plain["lines"]), stack, tuple(plain["files"]))

    def without_root(self, root: str) -> Look:
        """The same with the places that source files have when this folder is not their root."""
        stack = tuple(replace(line, file=line.file.removeprefix(root)) for line in self.stack)
        return replace(self, stack=stack, files=tuple(file.removeprefix(root) for file in self.files))

    @property
    def culprit(self) -> Line | None:
        """The innermost line of code that somebody wrote for this mission, not for a library."""
        own = [line for line in self.stack if not is_library(line.file)]
        return own[-1] if own else None


class _Counted(list[bytes]):
    """A trace's list of records that calls `reached` with the record that has a certain number."""

    def __init__(self, index: int, reached: Callable[[bytes], object]) -> None:
        super().__init__()
        self._left = index
        self._reached = reached

    def append(self, record: bytes) -> None:
        """As of a list; the host's empty marks are not counted."""
        if record:
            if self._left == 0:
                self._reached(record)
            self._left -= 1
        super().append(record)


class LookingTrace(Trace):
    """A trace that looks around when it gets a certain record.

    Args:
        index: number of the record, from 0.
        describe: makes lines of text of records; it gets up to two batches that end with the record.
        seen: gets what was seen, inside the simulation.
    """

    __slots__ = ("_before", "_describe", "_latest", "_seen")

    def __init__(
        self, index: int, describe: Callable[[list[bytes]], list[str]], seen: Callable[[Look], object]
    ) -> None:
        super().__init__(self._keep)
        self._before = blake2b(digest_size=16)
        self._latest: list[bytes] = []
        self._describe = describe
        self._seen = seen
        self.records = _Counted(index, self._look)
        self.append = self.records.append

    def _keep(self, records: list[bytes]) -> None:
        self._latest = [record for record in records if record]
        self._before.update(b"".join(self._latest))

    def _look(self, record: bytes) -> None:
        self._seen(self.look(record, sys._getframe(2)))

    def look(self, record: bytes, frame: FrameType | None = None) -> Look:
        """What there is to see now.

        Args:
            record: the record that is about to be made; empty at the end of the run.
            frame: of who makes it.
        """
        waiting = [each for each in self.records if each]
        self._before.update(b"".join(waiting))
        lines = self._describe([*self._latest, *waiting, record])
        return Look(record, self._before.hexdigest(), tuple(lines), stack_of(frame), tuple(own_files()))


def stack_of(frame: FrameType | None) -> tuple[Line, ...]:
    """The lines of node, application and libraries that a frame and its callers execute, outermost first."""
    found: list[Line] = []
    while frame is not None:
        code = frame.f_code
        if is_shown(code.co_filename):
            text = linecache.getline(code.co_filename, frame.f_lineno).strip()
            found.append(Line(code.co_filename, frame.f_lineno, code.co_qualname, text))
        frame = frame.f_back
    return tuple(reversed(found))


def is_shown(file: str) -> bool:
    """Whether code is the mission's or a library's, not the simulator's."""
    hidden = file.startswith((_CFEPY, "<")) or (file.startswith(_ROSPY) and not file.startswith(_LIBRARIES))
    return not hidden


def is_library(file: str) -> bool:
    """Whether a source file is the standard library's or that of an installed package."""
    parts = Path(file).parts
    return file.startswith((_STANDARD_LIBRARY, _LIBRARIES)) or any(name in parts for name in _INSTALLED)


def is_standard(file: str) -> bool:
    """Whether a source file is the standard library's."""
    return file.startswith(_STANDARD_LIBRARY) and not any(name in Path(file).parts for name in _INSTALLED)
