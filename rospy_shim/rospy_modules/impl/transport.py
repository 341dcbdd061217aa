"""rospy.impl.transport: the base classes of connections and protocols; the bus itself has no connections."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from typing import Any

INBOUND = "i"
OUTBOUND = "o"
BIDIRECTIONAL = "b"

_numbers = count()


class Transport:
    """A connection.

    Args:
        direction: INBOUND, OUTBOUND or BIDIRECTIONAL.
        name: for reports.
    """

    transport_type = "UNKNOWN"

    def __init__(self, direction: str, name: str = "unnamed") -> None:
        self.name = name
        self.direction = direction
        self.done = False
        self.cleanup_cb: Callable[[Transport], object] | None = None
        self.endpoint_id = ""
        self.stat_bytes = 0
        self.stat_num_msg = 0
        self.id = next(_numbers)

    def fileno(self) -> int:
        """Return a file number for select.

        Raises:
            NotImplementedError: if a derived class does not define the method.
        """
        raise NotImplementedError

    def close(self) -> None:
        """Close it, and call the cleanup function."""
        self.done = True
        if self.cleanup_cb is not None:
            self.cleanup_cb(self)

    def set_cleanup_callback(self, cleanup_callback: Callable[[Transport], object]) -> None:
        """Set the function that is called when the connection is closed."""
        self.cleanup_cb = cleanup_callback

    def write_data(self, data: bytes) -> None:
        """Send bytes.

        Raises:
            NotImplementedError: if a derived class does not define the method.
        """
        raise NotImplementedError("must implement")

    def get_transport_info(self) -> str:
        """Return a description for reports.

        Raises:
            NotImplementedError: if a derived class does not define the method.
        """
        raise NotImplementedError


class DeadTransport(Transport):
    """The record of a connection that is closed.

    Args:
        transport: the connection.
    """

    def __init__(self, transport: Transport) -> None:
        super().__init__(transport.direction, transport.name)
        self.transport_type = transport.transport_type
        self.endpoint_id = transport.endpoint_id
        self.stat_bytes = transport.stat_bytes
        self.stat_num_msg = transport.stat_num_msg
        self.done = True


class ProtocolHandler:
    """Makes the connections of a protocol; this class supports none."""

    def shutdown(self) -> None:
        """Do nothing: there is nothing to close."""

    def create_transport(self, topic: str, pub_uri: str, protocol_params: list[Any]) -> tuple[int, str, int]:
        """Connect to a publisher.

        Raises:
            NotImplementedError: if a derived class does not define the method.
        """
        raise NotImplementedError(f"cannot connect to {pub_uri} for topic {topic}")

    def supports(self, protocol: str) -> bool:
        """Return True if a protocol is supported."""
        return False

    def get_supported(self) -> list[list[str]]:
        """Return the supported protocols."""
        return []

    def init_publisher(self, topic: str, protocol: list[str]) -> tuple[int, str, list[Any]]:
        """Prepare for a subscriber.

        Raises:
            NotImplementedError: if a derived class does not define the method.
        """
        raise NotImplementedError(f"cannot publish {topic} with {protocol}")
