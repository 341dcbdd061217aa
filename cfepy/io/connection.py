"""One TCP connection of this computer, joined to a connection of the virtual network. May import cfepy.mission."""

from __future__ import annotations

import socket

from cfepy.mission.outside import OutsideStream

CHUNK = 65_536


class Connection:
    """Moves bytes both ways; each side holds the other back when it does not read.

    Args:
        host: the real socket, connected.
        stream: the end of the virtual connection that stands for it.

    Attributes:
        host: the real socket.
    """

    def __init__(self, host: socket.socket, stream: OutsideStream) -> None:
        self.host = host
        self._stream = stream
        self._pending = b""  # left the virtual side, not yet taken by the real one
        self._host_ended = self._stream_ended = False
        host.setblocking(False)

    @property
    def wants_to_read(self) -> bool:
        """Whether bytes of the real side would find room."""
        return not self._host_ended and self._stream.room > 0

    @property
    def wants_to_write(self) -> bool:
        """Whether there are bytes that the real side did not take yet."""
        return bool(self._pending)

    def move(self) -> bool:
        """Move what can be moved; False when the connection is over and closed."""
        try:
            self._bring_in()
            self._send_out()
        except BlockingIOError:
            return True
        except OSError:  # the other program is gone
            self.close()
            return False
        if self._stream_ended and (self._host_ended or self._stream.alone):
            self.close()
            return False
        return True

    def close(self) -> None:
        """End both sides."""
        self._stream.close()
        self.host.close()

    def _bring_in(self) -> None:
        while self.wants_to_read:
            try:
                data = self.host.recv(min(CHUNK, self._stream.room))
            except BlockingIOError:
                return
            if not data:
                self._host_ended = True
                self._stream.end()
                return
            self._stream.write(data)

    def _send_out(self) -> None:
        while self._pending or self._stream.readable:
            self._pending = self._pending or self._stream.read(CHUNK)
            if not self._pending:
                break
            self._pending = self._pending[self.host.send(self._pending) :]
        if self._stream.ended and not self._stream_ended:
            self._stream_ended = True
            self.host.shutdown(socket.SHUT_WR)
