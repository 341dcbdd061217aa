"""A WebSocket connection with a client, on a non-blocking socket (RFC 6455).

The protocol itself comes from the package websockets, without its servers: bytes go in, frames come out. Input is taken
between two steps of a run.
"""

from __future__ import annotations

import socket
from collections.abc import Callable, Sequence
from http import HTTPStatus
from selectors import BaseSelector
from typing import TYPE_CHECKING, Any

from cfepy.io import PeerSocket

if TYPE_CHECKING:
    from websockets.frames import Frame
    from websockets.http11 import Request, Response

LONGEST_MESSAGE = 1 << 25  # bytes; a longer one ends a connection
MOST_PARTS = 10_000  # frames of a message
BAD_TEXT, TOO_BIG, TRY_LATER = 1007, 1009, 1013  # RFC 6455, 7.4.1, and IANA's registry of it
OPEN = "OPEN"


def protocols() -> Any:
    """Return the module `websockets.server`; raises ImportError without the package websockets."""
    from websockets import server

    return server


class WebSocket:
    """A connection.

    Args:
        selector: selector of the server.
        connected: the socket.
        refusal: returns the HTTP status and the reason for a refused request, or None to accept it.
        began: called once, when messages may be sent.
        take: receives each message, a text or bytes.
        gone: called once with the reason, when the connection is over.
        subprotocols: the request must name one of them, the best first; empty if it need not.
        was_read: called after received bytes have been processed.

    Attributes:
        is_open: True if messages may be sent.
        has_pinged: True if a ping waits for its pong.
    """

    def __init__(
        self,
        selector: BaseSelector,
        connected: socket.socket,
        refusal: Callable[[Request], tuple[HTTPStatus, str] | None],
        began: Callable[[], object],
        take: Callable[[str | bytes], object],
        gone: Callable[[str], object],
        subprotocols: Sequence[str] = (),
        was_read: Callable[[], object] = lambda: None,
    ) -> None:
        self._protocol = protocols().ServerProtocol(subprotocols=list(subprotocols) or None, max_size=LONGEST_MESSAGE)
        self._refusal = refusal
        self._began = began
        self._take = take
        self._gone = gone
        self._parts: list[bytes] = []  # of a message that comes in more than one frame
        self._unfinished = 0  # bytes of an incomplete frame, or a few more
        self._is_text = True
        self.is_open = self.has_pinged = False
        self._was_read = was_read
        self._is_over = False
        self._socket = PeerSocket(selector, connected, self._read, self._lost)

    @property
    def unfinished(self) -> int:
        """Approximate number of received bytes of an incomplete message."""
        return self._unfinished + sum(map(len, self._parts))

    def ping(self) -> None:
        """Send a ping, to which the client must reply (RFC 6455, 5.5.2)."""
        if self.is_open and self._protocol.state.name == OPEN:
            self.has_pinged = True
            self._protocol.send_ping(b"")
            self._flush()

    def fail(self, why: str) -> None:
        self.close(TRY_LATER, why)

    @property
    def dropped(self) -> int:
        """Messages dropped because the client was too slow."""
        return self._socket.dropped

    @property
    def is_slow(self) -> bool:
        """True if messages wait for the client to read."""
        return self._socket.is_full

    @property
    def unread(self) -> int:
        """Messages that wait for the client to read, besides one that is on its way."""
        return self._socket.waiting

    def send(self, message: str | bytes) -> None:
        """Send a message, now or as soon as there is room."""
        if not self.is_open or self._protocol.state.name != OPEN:
            return
        if isinstance(message, str):
            self._protocol.send_text(message.encode(errors="replace"))
        else:
            self._protocol.send_binary(message)
        self._flush()

    def flush(self) -> None:
        """Try again to send waiting messages."""
        self._socket.flush()

    def pause(self) -> None:
        """Stop reading from the client, for now."""
        self._socket.pause()

    def resume(self) -> None:
        """Read from the client again."""
        self._socket.resume()

    def close(self, code: int, why: str) -> None:
        """End the connection with a code and a reason (RFC 6455, 7.4); the client may still read earlier messages."""
        if self.is_open and self._protocol.state.name == OPEN:
            self._protocol.send_close(code, why)
            self._flush()
        self._end(why)

    def abort(self) -> None:
        """End the connection at once."""
        self._socket.close()
        self._end("")

    @property
    def has_ended(self) -> bool:
        """True if the socket is closed, too."""
        return not self._socket.is_open

    def _end(self, why: str) -> None:
        self.is_open = False
        self._parts.clear()
        self._protocol.reader.discard()  # the received part of an incomplete message
        self._socket.finish()
        if not self._is_over:
            self._is_over = True
            self._gone(why)

    def _lost(self, why: str) -> None:
        self._end(why)

    def _read(self, data: bytes) -> None:
        if self._is_over:
            return
        protocol = self._protocol
        protocol.receive_data(data)
        events = protocol.events_received()
        self._unfinished = len(data) if events else self._unfinished + len(data)
        for event in events:
            if self._is_over:
                return
            if protocol.handshake_exc is None and not self.is_open:
                self._begin(event)
            else:
                self._frame(event)
        self._flush()
        if protocol.parser_exc is not None or protocol.handshake_exc is not None or protocol.close_expected():
            self._end(_why(protocol))
        self._was_read()

    def _begin(self, request: Request) -> None:
        protocol = self._protocol
        refused = self._refusal(request)
        response: Response = protocol.accept(request) if refused is None else protocol.reject(*refused)
        protocol.send_response(response)
        if response.status_code == HTTPStatus.SWITCHING_PROTOCOLS:
            self.is_open = True
            self._began()
        else:
            self._flush()
            self._end(response.body.decode(errors="replace").strip() if response.body else response.reason_phrase)

    def _frame(self, frame: Frame) -> None:
        opcode = frame.opcode.name
        if opcode in ("TEXT", "BINARY"):
            self._is_text = opcode == "TEXT"
            self._parts = [bytes(frame.data)]
        elif opcode == "CONT":
            self._parts.append(bytes(frame.data))
        else:
            self.has_pinged = self.has_pinged and opcode != "PONG"
            return  # the protocol has answered it
        if len(self._parts) > MOST_PARTS:
            self.close(TOO_BIG, "a message has too many frames")
        elif frame.fin:
            data, self._parts = b"".join(self._parts), []
            self._message(data)

    def _message(self, data: bytes) -> None:
        try:
            message = data.decode() if self._is_text else data
        except UnicodeDecodeError:
            self.close(BAD_TEXT, "a text is not in UTF-8")
            return
        self._take(message)

    def _flush(self) -> None:
        data = b"".join(self._protocol.data_to_send())
        if data:
            self._socket.send(data)


def _why(protocol: Any) -> str:
    error = protocol.parser_exc or protocol.handshake_exc
    return str(error) if error is not None else ""
