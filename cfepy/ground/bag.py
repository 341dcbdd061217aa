"""Bags on the host's side: a run's ROS topics recorded as `rosbag record -a` would, and bags and MCAP files read.

Recording watches the bus (`cfepy.mission.topic_watch`), so it changes nothing in the run.
"""

from __future__ import annotations

import importlib
import struct
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import ModuleType, TracebackType
from typing import TYPE_CHECKING, Self

from cfepy.mission import TopicMessage, TopicWatch, described, matches
from cfepy.reading.input_files import beginning_of, open_input
from cfepy.status import UsageError

if TYPE_CHECKING:
    from rosbag_storage import BagFile, Connection, Entry

CHUNK_BYTES = 768 * 1024


class RunRecorder(TopicWatch, ABC):
    """Records a run into a file; use as a context manager around the run.

    Args:
        take: gets each message.
        file: where to; an older one is written over.
        patterns: see `TopicWatch`.

    Raises:
        UsageError: the file cannot be written.

    Attributes:
        count: messages so far.
    """

    def __init__(self, take: Callable[[TopicMessage], None], file: str, patterns: Sequence[str]) -> None:
        super().__init__(take, patterns)
        self.count = 0
        self._failed: OSError | None = None  # the run goes on without the file; its sender is not to blame
        try:
            self._file = Path(file).open("w+b")  # noqa: SIM115  # closed by `__exit__`
        except OSError as error:
            raise _unwritable(file, error) from None

    @abstractmethod
    def _finish(self) -> None:
        """Write the index."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        """The run is over: write the index, unless the disk is full.

        Raises:
            UsageError: it is.
        """
        try:
            with self._file:
                self._finish()
        except OSError as failed:
            self._failed = failed
        if self._failed is not None:
            raise _unwritable(self._file.name, self._failed) from None


class BagRecorder(RunRecorder):
    """Records topics into a bag.

    Args:
        file: the bag; an older one is written over.
        patterns: see `TopicWatch`.

    Raises:
        UsageError: the file cannot be written.
    """

    def __init__(self, file: str, patterns: Sequence[str] = ()) -> None:
        super().__init__(self._write, file, patterns)
        self._connections: dict[tuple[str, str], Connection] = {}
        self._bag: BagFile = storage().BagFile(self._file)
        self._bag.create()

    def _finish(self) -> None:
        self._bag.finish()

    def _write(self, message: TopicMessage) -> None:
        if message.stamp_ns is None or self._failed is not None:
            return  # rosbag, too, begins when there is a time
        key = (message.topic, message.header.get("callerid", ""))
        connection = self._connections.get(key)
        if connection is None or connection.md5sum != message.header["md5sum"]:
            connection = self._connections[key] = self._bag.connect(message.topic, message.header)
        self.count += 1
        try:
            if self._bag.write(connection, message.stamp_ns, message.data) > CHUNK_BYTES:
                self._bag.flush()
        except OSError as error:
            self._failed = error


def _unwritable(file: str, error: OSError) -> UsageError:
    """The error of a recording that cannot be written."""
    return UsageError(f"could not be written: {error.strerror}", file=file, field="--bag")


class BagReader:
    """A bag to look into, or the topics of ROS 1 of an MCAP file; use as a context manager.

    Args:
        file: the bag.

    Raises:
        UsageError: there is none, or it is broken.
    """

    def __init__(self, file: str) -> None:
        try:
            self._file = open_input(file, handed=True)  # closed by `__exit__`
        except OSError as error:
            raise UsageError(f"could not be read: {error.strerror}", file=file) from None
        try:
            self._bag: BagFile = storage().opened(self._file)
            self._bag.read_version()
            self._bag.open()
        except _broken() as error:
            self._file.close()
            raise UsageError(f"{error}{_hint(error, file)}", file=file) from None
        except ImportError as error:  # of what its chunks are compressed by
            self._file.close()
            raise UsageError(str(error), file=file) from None

    @property
    def connections(self) -> list[Connection]:
        """The connections (`rosbag_storage.Connection`), as they came."""
        return list(self._bag.contents.connections.values())

    @property
    def start_ns(self) -> int | None:
        """Time of the first message; None when there is none."""
        return min((chunk.start for chunk in self._bag.contents.chunks), default=None)

    @property
    def length_ns(self) -> int:
        """Time from the first message to the last."""
        chunks = self._bag.contents.chunks
        return max((chunk.end for chunk in chunks), default=0) - min((chunk.start for chunk in chunks), default=0)

    def messages(self, patterns: Sequence[str] = ()) -> Iterator[TopicMessage]:
        """The messages by time, `at_ns` since the first one of the bag; see `TopicWatch` for the patterns.

        Raises:
            UsageError: the bag is broken.
        """
        contents = self._bag.contents
        start_ns = min((chunk.start for chunk in contents.chunks), default=0)
        chosen = [each for each in self.connections if matches(each.topic, patterns)]
        for entry in contents.entries(chosen):
            connection, time, data = self._read(entry)
            yield TopicMessage(connection.topic, header_of(connection), data, time - start_ns, time)

    def _read(self, entry: Entry) -> tuple[Connection, int, bytes]:
        try:
            return self._bag.read(entry)
        except _broken() as error:
            raise UsageError(f"is broken: {described(error)}", file=self._file.name) from None

    def __enter__(self) -> BagReader:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self._file.close()


def header_of(connection: Connection) -> dict[str, str]:
    """What a bag tells of a connection: type, md5sum, message_definition, callerid, ..."""
    header = connection.header.items()
    return {name: value if isinstance(value, str) else value.decode(errors="replace") for name, value in header}


def _hint(error: Exception, file: str) -> str:
    """What to do about a file that cannot be read."""
    if isinstance(error, storage().ROSBagUnindexedException):
        return f"; rosbag reindex makes an index, cfepy bag recover {file} saves the readable messages"
    return f"; cfepy bag recover {file} saves the readable messages" if is_bag(file) else ""


def is_bag(file: str) -> bool:
    """Whether a file is a bag or an MCAP file, by its first bytes."""
    return beginning_of(file, 8).startswith((b"#ROSBAG", b"\x89MCAP0\r\n"))


def _broken() -> tuple[type[Exception], ...]:
    """What reading bytes that are no bag, or no longer one, raises."""
    return (storage().ROSBagException, ValueError, LookupError, OSError, EOFError, struct.error)


def storage() -> ModuleType:
    """The library `rosbag_storage`, which knows the format. Nodes import it, too: by that name, as type checkers do."""
    return importlib.import_module("ros_libraries.rosbag_storage")
