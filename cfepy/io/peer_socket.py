"""A non-blocking TCP connection with a program on this computer.

Output that cannot be sent waits in a queue with a limit; beyond it the oldest message is dropped and counted, as in ROS
publishers. Input is passed on when the host polls.
"""

from __future__ import annotations

import socket
from collections import deque
from collections.abc import Callable
from selectors import EVENT_READ, EVENT_WRITE, BaseSelector
from typing import Any

CHUNK = 1 << 16
# maximum number of bytes received between two parts of a run; the rest waits in the other program
MOST_AT_ONCE = 1 << 20
MOST_WAITING = 1000  # messages
ENDED = "the peer closed the connection"
MOST_BYTES = 1 << 26  # maximum number of waiting bytes; one message may be longer


class PeerSocket:
    """A connection.

    Args:
        selector: selector of the host; its entries' data are functions that take the events.
        connected: the socket.
        take: receives bytes; may close the channel.
        lost: called once with the reason, if the other side has closed or its data could not be read.
    """

    def __init__(
        self,
        selector: BaseSelector,
        connected: socket.socket,
        take: Callable[[bytes], object],
        lost: Callable[[str], object],
    ) -> None:
        self.socket = connected
        self.dropped = 0
        self.is_open = True
        self._selector = selector
        self._take = take
        self._lost = lost
        self._waiting: deque[bytes] = deque()
        self._size = 0
        self._under_way = b""  # rest of a partly sent message
        self._ends_when_sent = self._is_paused = False
        self._watched = 0  # events, as in the selector
        connected.setblocking(False)
        if connected.family in (socket.AF_INET, socket.AF_INET6):
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._watch()

    @property
    def is_full(self) -> bool:
        """Whether a message would have to wait for the other side."""
        return bool(self._under_way or self._waiting)

    @property
    def waiting(self) -> int:
        """Number of messages that have not been started."""
        return len(self._waiting)

    def send(self, data: bytes) -> None:
        """Send a message, at once or as soon as there is room."""
        if not self.is_open:
            return
        if self._under_way or self._waiting:
            self._queue(data)
            return
        try:
            sent = self.socket.send(data)
        except BlockingIOError:
            sent = 0
        except OSError:  # the other side has closed, which reading will show
            self.resume()
            return
        if sent < len(data):
            self._under_way = data[sent:]
            self._watch()

    def _queue(self, data: bytes) -> None:
        waiting = self._waiting
        waiting.append(data)
        self._size += len(data)
        while len(waiting) > MOST_WAITING or (self._size > MOST_BYTES and len(waiting) > 1):
            self._size -= len(waiting.popleft())
            self.dropped += 1

    def flush(self) -> None:
        """Send as much waiting data as possible."""
        while self.is_open and (self._under_way or self._waiting):
            if not self._under_way:
                self._under_way = self._waiting.popleft()
                self._size -= len(self._under_way)
            try:
                sent = self.socket.send(self._under_way)
            except BlockingIOError:
                return
            except OSError:
                self._under_way = b""
                self._waiting.clear()
                break
            self._under_way = self._under_way[sent:]
        if self._ends_when_sent:
            self.close()
        else:
            self._watch()

    def pause(self) -> None:
        """Stop receiving for now. Data stays in the other program until then."""
        self._is_paused = True
        self._watch()

    def resume(self) -> None:
        """Resume receiving."""
        self._is_paused = False
        self._watch()

    def finish(self) -> None:
        """Close it as soon as everything is sent."""
        if self._under_way or self._waiting:
            self._ends_when_sent = True
        else:
            self.close()

    def close(self) -> None:
        """Close it; `lost` is not called."""
        if self.is_open:
            self.is_open = False
            self._watch()
            self.socket.close()
            self._waiting.clear()

    def handle(self, events: int) -> None:
        """Handle a socket that is ready."""
        if events & EVENT_WRITE:
            self.flush()
        if events & EVENT_READ and self.is_open:
            self._read()

    def _read(self) -> None:
        left = MOST_AT_ONCE
        while self.is_open and left > 0 and not self._is_paused:
            try:
                data = self.socket.recv(CHUNK)
            except BlockingIOError:
                return
            except OSError as error:
                self.fail(error.strerror or str(error))
                return
            if not data:
                self.fail(ENDED)
                return
            left -= len(data)
            try:
                self._take(data)
            except Exception as error:  # an error caused by received bytes ends only this connection
                self.fail(f"{error}")
                return
            if len(data) < CHUNK:
                return

    def fail(self, why: str) -> None:
        """Close the connection after an error."""
        if self.is_open:
            self.close()
            self._lost(why)

    def _watch(self) -> None:
        """Update the events for which the selector watches the socket."""
        reads = 0 if self._is_paused else EVENT_READ
        writes = EVENT_WRITE if self._under_way or self._waiting else 0
        wanted, watched = reads | writes if self.is_open else 0, self._watched
        self._watched = wanted
        if wanted == watched:
            return
        if not watched:
            self._selector.register(self.socket, wanted, self.handle)
        elif not wanted:
            self._selector.unregister(self.socket)
        else:
            self._selector.modify(self.socket, wanted, self.handle)


class Listening:
    """A socket that takes connections.

    Args:
        selector: of the host.
        opened: the socket, bound and listening.
        accept: takes each connected socket.
    """

    def __init__(
        self, selector: BaseSelector, opened: socket.socket, accept: Callable[[socket.socket], object]
    ) -> None:
        self._selector = selector
        self._socket = opened
        self._accept = accept
        place = opened.getsockname()
        self.port = 0 if isinstance(place, str) else int(place[1])  # a socket in the file system has no port
        opened.setblocking(False)
        selector.register(opened, EVENT_READ, self._handle)

    def _handle(self, events: Any) -> None:
        try:
            connected, _ = self._socket.accept()
        except OSError:  # it has closed again, or this process has too many open files
            return
        self._accept(connected)

    def close(self) -> None:
        """Stop accepting connections."""
        self._selector.unregister(self._socket)
        self._socket.close()


def listening_socket(address: str, port: int = 0) -> socket.socket:
    """Return a socket that listens.

    Args:
        address: address of this computer, IPv6 if it has colons; "" for all of IPv4.
        port: 0 for any free one.

    Raises:
        OSError: if the port is taken.
    """
    opened = socket.socket(socket.AF_INET6 if ":" in address else socket.AF_INET, socket.SOCK_STREAM)
    try:
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        opened.bind((address, port))
        opened.listen(128)
    except OSError:
        opened.close()
        raise
    return opened
