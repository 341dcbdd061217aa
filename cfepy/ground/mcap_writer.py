"""Writing MCAP files with the library mcap, which is used only here (`pip install 'cfepy[mcap]'`).

The same messages give the same file, because no clock time and no name of this computer is written to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType
from typing import TYPE_CHECKING, Any, BinaryIO

from cfepy.status import UsageError

if TYPE_CHECKING:
    from rosbag_storage import McapSchema, RecordedChannel

CHUNK_BYTES = 768 * 1024
COMPRESSIONS = ("none", "lz4", "zstd")
LIBRARY = "cfepy"


class McapWriter:
    """Writes one MCAP file.

    Args:
        file: opened for writing.
        compression: compression of its chunks, one of `COMPRESSIONS`.

    Raises:
        UsageError: if the library mcap or that for compression is not installed.
        OSError: if the file cannot be written.
    """

    def __init__(self, file: BinaryIO, compression: str = "none") -> None:
        library = mcap_library()
        kind = library.CompressionType[compression.upper()]
        try:
            self._writer: Any = library.Writer(file, CHUNK_BYTES, kind)
        except Exception as error:  # the library's own exception, of which only the text is useful
            raise UsageError(f"{compression}: {error}", field="--compression") from None
        self._schemas: dict[McapSchema, int] = {}
        self._writer.start("ros1", LIBRARY)

    def channel(self, channel: RecordedChannel) -> int:
        """Add a channel; returns the number under which its messages are written."""
        schema = channel.schema
        if schema not in self._schemas:
            known = 0 if not schema.encoding else self._writer.register_schema(*schema)
            self._schemas[schema] = known
        return int(
            self._writer.register_channel(
                channel.topic, channel.encoding, self._schemas[schema], dict(channel.metadata)
            )
        )

    def write(self, channel: int, time: int, data: bytes, publish_time: int | None = None, sequence: int = 0) -> None:
        """Write a message.

        Args:
            channel: its number.
            time: in ns.
            data: the message.
            publish_time: in ns; None for `time`.
            sequence: its number from the sender; 0 for none.

        Raises:
            OSError: if the file cannot be written.
        """
        self._writer.add_message(channel, time, data, time if publish_time is None else publish_time, sequence)

    def metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Write metadata of the whole file."""
        self._writer.add_metadata(name, dict(values))

    def attachment(self, log_time: int, create_time: int, name: str, media_type: str, data: bytes) -> None:
        """Write an attachment: a file that accompanies the messages. Times are in ns."""
        self._writer.add_attachment(create_time, log_time, name, media_type, data)

    def flush(self) -> None:
        """End the chunk: everything so far can then be read even if nothing more follows."""
        self._writer.flush()

    def finish(self) -> None:
        """Write the index, which completes the file."""
        self._writer.finish()


def mcap_library() -> ModuleType:
    """Return the library that writes MCAP files.

    Raises:
        UsageError: it is not installed.
    """
    try:
        from mcap import writer
    except ImportError:
        raise UsageError("MCAP files require the library mcap: pip install 'cfepy[mcap]'") from None
    return writer
