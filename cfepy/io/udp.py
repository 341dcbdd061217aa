"""UDP datagrams to and from a flight computer, through the host's sockets."""

from __future__ import annotations

import errno
import socket
from types import TracebackType

from cfepy.status import UsageError

LARGEST = 65535
REFUSAL_S = 0.02  # time within which a nearby computer reports that there is no listener


def send(host: str, port: int, data: bytes) -> bool:
    """Send a datagram.

    Args:
        host: name or address.
        port: 1 to 65535.
        data: its bytes.

    Returns:
        False if the host answers that there is no listener at the port. True does not mean that the datagram arrived.

    Raises:
        UsageError: if there is no such host, or no way to it.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as plug:
        try:
            plug.connect((host, port))
            plug.send(data)
            plug.settimeout(REFUSAL_S)
            plug.recv(1)
            return True
        except TimeoutError:
            return True
        except ConnectionRefusedError:
            return False
        except OSError as error:
            raise UsageError(f"cannot be reached: {error.strerror or error}", file=f"{host}:{port}") from None


def own_address(host: str) -> str:
    """Return the address of this computer as seen by a host.

    Raises:
        UsageError: if there is no such host, or no route to it.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as plug:
        try:
            plug.connect((host, 1))  # sends nothing, but finds the route
        except OSError as error:
            raise UsageError(f"has no route: {error.strerror or error}", file=host) from None
        address: str = plug.getsockname()[0]
        return address


class UdpListener:
    """A port that receives datagrams; use as a context manager.

    Args:
        host: address of this computer to listen at, "0.0.0.0" for any.
        port: 1 to 65535, or 0 for a free one.

    Attributes:
        port: the port.

    Raises:
        UsageError: if the port is taken, or the address is not one of this computer's.
    """

    def __init__(self, host: str, port: int) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind((host, port))
        except OSError as error:
            self._socket.close()
            taken = "; give another port" if error.errno == errno.EADDRINUSE else ""
            text = f"cannot listen there: {error.strerror or error}{taken}"
            raise UsageError(text, file=f"{host}:{port}") from None
        self.port: int = self._socket.getsockname()[1]

    def receive(self, timeout_s: float | None = None) -> bytes | None:
        """Return the next datagram; None if none came in time.

        Args:
            timeout_s: longest time to wait in wall-clock s; None for no limit.
        """
        self._socket.settimeout(timeout_s)
        try:
            return self._socket.recv(LARGEST)
        except TimeoutError:
            return None

    def __enter__(self) -> UdpListener:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self._socket.close()
