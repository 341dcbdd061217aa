"""Publishes serialised messages unchanged. Imports rospy and genpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import genpy
import rospy

if TYPE_CHECKING:
    from rosbag_storage import Connection


class RawMessage(genpy.Message):  # type: ignore[misc]  # it is made for each node
    """A message that is serialised already.

    Args:
        data: its bytes.
    """

    __slots__ = ["data"]
    _slot_types: ClassVar[list[str]] = []
    _has_header = False  # the bytes are left unchanged

    def __init__(self, data: bytes = b"") -> None:
        self.data = data

    def serialize(self, buff: Any) -> None:
        """Write the bytes."""
        buff.write(self.data)

    def deserialize(self, str: bytes) -> RawMessage:
        """Take the bytes."""
        self.data = str
        return self


def publisher_of(topic: str, connection: Connection, queue_size: int) -> Any:
    """Return a publisher for the messages of a bag's connection. It latches if the recorded one did."""
    about = {"_type": connection.datatype, "_md5sum": connection.md5sum, "_full_text": connection.msg_def}
    kind = type("RawMessage", (RawMessage,), {"__slots__": [], **about})
    is_latching = connection.header.get("latching") in (b"1", "1")
    return rospy.Publisher(topic, kind, queue_size=queue_size, latch=is_latching)
