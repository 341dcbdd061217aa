"""The mission's connections to external peers: a publisher that its nodes subscribe to, a service that they call."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from cfepy.extra.ros_host.errands import ask, connect
from cfepy.extra.ros_host.joint import Joint
from cfepy.extra.ros_host.tcpros import LONGEST_FRAME, TcprosFrames, frame, pack_header, parse_header
from cfepy.io import INTO, PeerSocket

FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.5, 2.0  # wall time between two attempts to connect; each is twice the last
MOST_PATIENCE_S = 1.0  # wall time for which the mission may be full, before messages are lost
ANY = "*"


class OutsidePublisher:
    """An outside publisher of a topic to which nodes of the mission subscribe.

    Args:
        host: knows the mission.
        topic: the topic.
        uri: URI of the publisher's slave API.
    """

    def __init__(self, host: Joint, topic: str, uri: str) -> None:
        self.topic = topic
        self.uri = uri
        self.is_wanted = True
        self._host = host
        self._socket: PeerSocket | None = None
        self._frames = TcprosFrames()
        self._name = ""  # known when it is connected
        self._pause_s = FIRST_PAUSE_S
        self._again_at = 0.0
        self._is_busy = False
        self._coming: deque[bytes] = deque()  # messages that wait for room
        self._full_since_s: float | None = None

    def look(self, now_s: float) -> None:
        """Connect, if it is time to."""
        if self.is_wanted and self._socket is None and not self._is_busy and now_s >= self._again_at:
            fields = self._host.subscription(self.topic)
            if fields is None:
                return
            self._is_busy = True
            line, uri, topic = f"{self.uri} {self.topic}", self.uri, self.topic

            def errand() -> Any:
                protocol = ask(uri, "requestTopic", fields["callerid"], topic, [["TCPROS"]])
                if protocol[:1] != ["TCPROS"]:
                    raise ValueError("the publisher does not support TCPROS")
                return connect(f"rosrpc://{protocol[1]}:{protocol[2]}")

            self._host.errands.run(line, errand, lambda made, error: self._connected(fields, made, error))

    def close(self) -> None:
        """Disconnect from a publisher that is no longer needed."""
        self.is_wanted = False
        self._leave()

    def _connected(self, fields: dict[str, str], made: Any, error: Exception | None) -> None:
        self._is_busy = False
        if error is not None:
            self._retry(f"{error}", refused=True)
        elif not self.is_wanted:
            made.close()
        else:
            self._frames = TcprosFrames()
            self._socket = PeerSocket(self._host.selector, made, self._take, self._lost)
            self._socket.send(pack_header({**fields, "tcp_nodelay": "1"}))

    def _take(self, data: bytes) -> None:
        self._frames.add(data)
        for each in self._frames.take():
            if not self._name:
                self._frames.longest = LONGEST_FRAME
                self._begin(parse_header(each))
            else:
                self._coming.append(each)
        self.enter()
        if self._socket is not None:
            self._host.bounds.room.hold(self, len(self._frames) + sum(map(len, self._coming)))

    def fail(self, why: str) -> None:
        if self._socket is not None:
            self._socket.fail(why)

    def _begin(self, header: dict[str, str]) -> None:
        if "error" in header:
            raise ConnectionRefusedError(header["error"])
        host = self._host
        name = header.get("callerid") or host.name_at(self.uri) or self.uri
        error = host.act(
            "publish",
            self.topic,
            name,
            self.uri,
            header.get("type", ANY),
            header.get("md5sum", ANY),
            header.get("message_definition", ""),
            header.get("latching") == "1",
        )
        if error:
            raise ConnectionRefusedError(f"topic {self.topic}: {error}")
        self._name = name
        self._pause_s = FIRST_PAUSE_S
        self._count = host.counts.of(self.topic, name, INTO)
        self._count.connections += 1

    def enter(self) -> None:
        """Enter waiting messages while the mission has room; otherwise they wait, and reading from the sender stops."""
        host, coming = self._host, self._coming
        while coming:
            if not host.has_room(self.topic, self._name, coming[0]):
                now_s = host.now_s()
                self._full_since_s = now_s if self._full_since_s is None else self._full_since_s
                if now_s - self._full_since_s < MOST_PATIENCE_S:
                    host.stalled.add(self)
                    if self._socket is not None:
                        self._socket.pause()
                    return
            self._full_since_s = None
            self._message(coming.popleft())
        host.stalled.discard(self)
        if self._socket is not None:
            self._socket.resume()

    def _message(self, payload: bytes) -> None:
        count = self._count
        count.messages += 1
        count.size += len(payload)
        if not self._host.act("message", self.topic, self._name, payload):
            count.dropped += 1
            count.why = "the Software Bus did not take it"

    def _lost(self, why: str) -> None:
        was_there = bool(self._name)
        if was_there and self.is_wanted:
            self._count.ended += 1
            self._count.why = why
        self._socket = None
        self._leave()
        self._retry(why, refused=not was_there)

    def _leave(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None
        self._coming.clear()
        self._frames.clear()
        self._host.stalled.discard(self)
        self._host.bounds.room.release(self)
        if self._name:
            self._host.act("publish no more", self.topic, self._name)
            self._name = ""

    def _retry(self, why: str, refused: bool) -> None:
        if refused:
            count = self._host.counts.of(self.topic, self._host.name_at(self.uri) or self.uri, INTO)
            count.refused += 1
            count.why = why
        self._again_at = self._host.now_s() + self._pause_s
        self._pause_s = min(2 * self._pause_s, LONGEST_PAUSE_S)


class OutsideCall:
    """A call of an outside service.

    Args:
        host: knows the mission.
        service: its name.
        uri: its URI, rosrpc://HOST:PORT.
        header: connection header; with `probe` the service is not called.
        body: the serialised request.
        over: receives the header of the service, True for success, and the answer or the error.
    """

    def __init__(
        self,
        host: Joint,
        service: str,
        uri: str,
        header: dict[str, str],
        body: bytes,
        over: Callable[[dict[str, str], bool, bytes], object],
    ) -> None:
        self._host = host
        self._fields = header
        self._body = body
        self._over = over
        self._frames = TcprosFrames()
        self._header: dict[str, str] | None = None
        self._socket: PeerSocket | None = None
        host.errands.run(f"{uri} {service} {id(self)}", lambda: connect(uri), self._connected)

    def _connected(self, made: Any, error: Exception | None) -> None:
        if error is not None:
            self._end(False, f"unable to connect to service: {error}".encode())
            return
        self._socket = PeerSocket(self._host.selector, made, self._take, self._lost)
        self._socket.send(pack_header(self._fields))

    def _take(self, data: bytes) -> None:
        self._frames.add(data)
        for each in self._frames.take():
            if self._header is None:
                self._begin(parse_header(each))
            else:
                self._end(each[:1] == b"\x01", each[1:])
                return

    def _begin(self, header: dict[str, str]) -> None:
        if "error" in header:
            raise ConnectionRefusedError(f"unable to connect to service: remote error reported: {header['error']}")
        self._header = header
        if self._fields.get("probe"):
            self._end(True, b"")
            return
        self._frames.longest = LONGEST_FRAME
        self._frames.has_status = True
        if self._socket is not None:
            self._socket.send(frame(self._body))

    def _lost(self, why: str) -> None:
        self._end(False, f"transport error completing service call: {why}".encode())

    def _end(self, good: bool, body: bytes) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None
        over, self._over = self._over, lambda header, good, body: None
        over(self._header or {}, good, body)
