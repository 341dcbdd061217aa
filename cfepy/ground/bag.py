"""Bags on the host: recording a run's ROS topics like `rosbag record -a`, and reading bags and MCAP files.

Recording observes the bus (`cfepy.mission.topic_watch`), so it does not change the run.
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
        take: receives each message.
        file: the file; it is overwritten.
        patterns: see `TopicWatch`.

    Raises:
        UsageError: if the file cannot be written.

    Attributes:
        count: number of messages so far.
    """

    def __init__(self, take: Callable[[TopicMessage], None], file: str, patterns: Sequence[str]) -> None:
        super().__init__(take, patterns)
        self.count = 0
        # the run continues without the file; the sender of the message is not responsible
        self._failed: OSError | None = None
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
        """Write the index at the end of the run.

        Raises:
            UsageError: if the disk is full.
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
        file: the bag; it is overwritten.
        patterns: see `TopicWatch`.

    Raises:
        UsageError: if the file cannot be written.
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
            return  # rosbag, too, starts once there is a time
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
    """Return the error of a recording that cannot be written."""
    return UsageError(f"could not be written: {error.strerror}", file=file, field="--bag")


class BagReader:
    """A bag for reading, or the ROS 1 topics of an MCAP file; use as a context manager.

    Args:
        file: the bag.

    Raises:
        UsageError: if it does not exist, or is damaged.
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
            self._bag.contents.sort()
        except _broken() as error:
            self._file.close()
            raise UsageError(f"{error}{_hint(error, file)}", file=file) from None
        except ImportError as error:  # missing support for the compression of its chunks
            self._file.close()
            raise UsageError(str(error), file=file) from None

    @property
    def connections(self) -> list[Connection]:
        """The connections (`rosbag_storage.Connection`), in order of appearance."""
        return list(self._bag.contents.connections.values())

    @property
    def start_ns(self) -> int | None:
        """Time of the first message; None if there is none."""
        return min((chunk.start for chunk in self._bag.contents.chunks), default=None)

    @property
    def length_ns(self) -> int:
        """Time from the first message to the last."""
        chunks = self._bag.contents.chunks
        return max((chunk.end for chunk in chunks), default=0) - min((chunk.start for chunk in chunks), default=0)

    def messages(self, patterns: Sequence[str] = ()) -> Iterator[TopicMessage]:
        """Yield the messages by time, `at_ns` since the first one of the bag; see `TopicWatch` for the patterns.

        Raises:
            UsageError: if the bag is damaged.
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
    """Return the header of a connection: type, md5sum, message_definition, callerid, ..."""
    header = connection.header.items()
    return {name: value if isinstance(value, str) else value.decode(errors="replace") for name, value in header}


def _hint(error: Exception, file: str) -> str:
    """Return advice about a file that cannot be read."""
    if isinstance(error, storage().ROSBagUnindexedException):
        return f"; rosbag reindex makes an index, cfepy rosbag recover {file} saves the readable messages"
    return f"; cfepy rosbag recover {file} saves the readable messages" if is_bag(file) else ""


def is_bag(file: str) -> bool:
    """Return whether a file is a bag or an MCAP file, by its first bytes."""
    return beginning_of(file, 8).startswith((b"#ROSBAG", b"\x89MCAP0\r\n"))


def _broken() -> tuple[type[Exception], ...]:
    """Return the exceptions raised by bytes that are not a valid bag."""
    return (storage().ROSBagException, ValueError, LookupError, OSError, EOFError, struct.error)


def storage() -> ModuleType:
    """Return the library `rosbag_storage`, which knows the format. Nodes load it too, under the name that type checkers
    know.
    """
    return importlib.import_module("ros_libraries.rosbag_storage")
