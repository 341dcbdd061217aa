"""An XML-RPC server over HTTP that answers between two steps of a run (xmlrpc.com/spec, RFC 9112).

It supports the part of HTTP that the clients of ROS in Python and C++ use: POST with a Content-Length, and persistent
connections. A page in a browser is not a client of ROS, so its request is refused before the body is read. So is a
request that is too large.
"""

from __future__ import annotations

import socket
from collections import deque
from collections.abc import Callable, Sequence
from selectors import BaseSelector
from typing import Any, NamedTuple
from xmlrpc.client import Fault, dumps

from cfepy.extra.ros_host.rpc_body import RpcError, read_body
from cfepy.io import InputRoom, InputTurn, Listening, OwnNames, PeerPlaces, PeerSocket, listening_socket
from cfepy.reading.input_limits import RPC_ANSWER_BYTES, RPC_BYTES, RPC_CALLS

LONGEST_HEAD = 1 << 14  # bytes
MULTICALL = "system.multicall"
BROWSER_FIELDS = ("origin", "sec-fetch-site")
"""Fields that browsers add to the requests of pages, and that a page cannot leave out (RFC 6454, W3C Fetch
Metadata).
"""
ONE_ONLY = ("host", "content-length", "content-type", "transfer-encoding")
VERSIONS = ("HTTP/1.0", "HTTP/1.1")
MEDIA_TYPE = "text/xml"

Answering = Callable[[str, Sequence[Any], bytes], Any]
"""Takes method, arguments and the whole request, and returns the value of the answer."""


class ServerBounds(NamedTuple):
    """Limits and state that the servers of one host share.

    Attributes:
        names: names of this computer that clients use.
        places: limits the number of connections.
        room: limits the size of incomplete requests.
        turn: limits the time for requests between two steps of a run.
        late: clients whose requests wait for the next turn.
        nudge: called when requests wait for the next turn.
        now_s: returns wall time in s since an arbitrary instant.
    """

    names: OwnNames
    places: PeerPlaces
    room: InputRoom
    turn: InputTurn
    late: deque[_Connection]
    nudge: Callable[[], object]
    now_s: Callable[[], float]


class XmlRpcServer:
    """Answers requests at a port.

    Args:
        selector: selector of the host.
        address: address of the interface; "" for all.
        answering: computes the answer; an exception becomes a fault.
        bounds: shared with other servers.
        port: 0 takes any free one.

    Attributes:
        port: the port that it listens at.

    Raises:
        OSError: the port is taken.
    """

    def __init__(
        self, selector: BaseSelector, address: str, answering: Answering, bounds: ServerBounds, port: int = 0
    ) -> None:
        self._selector = selector
        self._answering = answering
        self._bounds = bounds
        self._listening = Listening(selector, listening_socket(address, port), self._accept)
        self._connections: dict[_Connection, None] = {}
        self.port = self._listening.port

    def _accept(self, connected: socket.socket) -> None:
        connection = _Connection(self._selector, connected, self._answer, self._forget, self._bounds)
        self._connections[connection] = None
        self._bounds.places.take(connection, self._bounds.now_s())

    def _forget(self, connection: _Connection) -> None:
        self._connections.pop(connection, None)

    def _answer(self, body: bytes) -> bytes:
        try:
            arguments, method = read_body(body)
            if method is None:
                raise RpcError("not a request: the method is missing")
            value = self._calls(arguments) if method == MULTICALL else self._answering(method, arguments, body)
            return dumps((value,), methodresponse=True).encode(errors="replace")
        except Exception as error:  # as in Python's own server, the client receives the fault
            return dumps(_fault(error), methodresponse=True).encode(errors="replace")

    def _calls(self, arguments: Sequence[Any]) -> list[Any]:
        """Answer several requests in one, as rospy sends them to unregister."""
        if len(arguments) != 1 or not isinstance(arguments[0], list):
            raise RpcError(f"{MULTICALL} requires a list of calls")
        if len(arguments[0]) > RPC_CALLS:
            raise RpcError(f"{MULTICALL} of {len(arguments[0]):,} calls; the limit is {RPC_CALLS:,}")
        found, size = [], 0
        for each in arguments[0]:
            found.append(self._one_of_many(each))
            size += _size_of(found[-1])
            if size > RPC_ANSWER_BYTES:
                raise RpcError(f"the answer to {MULTICALL} has more than {RPC_ANSWER_BYTES:,} bytes; make fewer calls")
        return found

    def _one_of_many(self, request: dict[str, Any]) -> Any:
        try:
            method, arguments = str(request["methodName"]), tuple(request["params"])
            return [self._answering(method, arguments, dumps(arguments, method).encode())]
        except Exception as error:
            fault = _fault(error)
            return {"faultCode": fault.faultCode, "faultString": fault.faultString}

    def close(self) -> None:
        """Stop taking requests."""
        self._listening.close()
        for each in list(self._connections):
            each.close()


def _fault(error: Exception) -> Fault:
    return Fault(1, f"{type(error)}:{error}"[:2000])


def _size_of(value: Any) -> int:
    """Estimate the bytes of a value in an answer."""
    if isinstance(value, str | bytes):
        return 16 + len(value)
    if isinstance(value, dict):
        return sum(16 + len(name) + _size_of(each) for name, each in value.items())
    return 16 + sum(map(_size_of, value)) if isinstance(value, list | tuple) else 16


class _Refused(Exception):  # reported to the client; not an error of the server
    """A request that is not read: the HTTP status, and the reason."""

    def __init__(self, status: str, why: str, unread: int = 0) -> None:
        super().__init__(why)
        self.status = status
        self.unread = unread  # bytes that the client sends before it reads the answer


class _Head(NamedTuple):
    """The part of a request before its body."""

    version: str
    fields: dict[str, str]
    length: int

    @property
    def stays(self) -> bool:
        """True if the connection stays open for further requests."""
        default = "keep-alive" if self.version == "HTTP/1.1" else "close"
        return self.fields.get("connection", default).lower() != "close"


class _Connection:
    """The connection of a client."""

    def __init__(
        self,
        selector: BaseSelector,
        connected: socket.socket,
        answer: Callable[[bytes], bytes],
        forget: Callable[[_Connection], object],
        bounds: ServerBounds,
    ) -> None:
        self._data = bytearray()
        self._head: _Head | None = None
        self._answer = answer
        self._forget = forget
        self._is_late = False
        self._unread = 0  # bytes of a request that was refused
        self._bounds = bounds
        self._here = str(connected.getsockname()[0])
        self._socket = PeerSocket(selector, connected, self._take, lambda why: self._gone())

    def close(self) -> None:
        """Close it."""
        self._socket.close()
        self._gone()

    def fail(self, why: str) -> None:
        self.close()

    def go_on(self) -> None:
        """Go on when another turn has begun."""
        self._is_late = False
        if self._socket.is_open:
            self._socket.resume()
            self._work()

    def _gone(self) -> None:
        self._data.clear()
        self._bounds.places.leave(self)
        self._bounds.room.release(self)
        self._forget(self)

    def _take(self, data: bytes) -> None:
        self._data += data
        if self._unread:
            self._skip()
        else:
            self._work()

    def _skip(self) -> None:
        """Discard the body of a refused request: a client reads the answer after it has sent all of it."""
        self._unread -= len(self._data)
        self._data.clear()
        if self._unread <= 0:
            self._finish()

    def _work(self) -> None:
        """Answer requests that are complete, until this turn is over."""
        while not self._is_late and self._socket.is_open and self._is_whole():
            if self._bounds.turn.is_over:
                self._is_late = True
                self._bounds.late.append(self)
                self._socket.pause()
                self._bounds.nudge()
            else:
                self._request()
        if self._socket.is_open:
            self._bounds.room.hold(self, len(self._data))

    def _is_whole(self) -> bool:
        """Return True if a whole request has arrived. A request is refused as soon as its head has arrived."""
        try:
            self._head = self._head or self._parsed()
        except _Refused as refused:
            self._reply("HTTP/1.1", refused.status, f"{refused}\n".encode(), "text/plain; charset=utf-8")
            self._unread = refused.unread
            self._skip()
            return False
        return self._head is not None and len(self._data) >= self._head.length

    def _parsed(self) -> _Head | None:
        """Return the head of a request and remove it from the data, or None if it is incomplete.

        Raises:
            _Refused: the body will not be read.
        """
        end = self._data.find(b"\r\n\r\n", 0, LONGEST_HEAD + 4)
        if end < 0:
            if len(self._data) > LONGEST_HEAD:
                raise _Refused("431 Request Header Fields Too Large", "the head of the request is too long")
            return None
        head = bytes(self._data[:end])
        del self._data[: end + 4]
        found = _head_of(head, self._bounds.names, self._here)
        if found.fields.get("expect", "").lower() == "100-continue" and len(self._data) < found.length:
            self._socket.send(b"HTTP/1.1 100 Continue\r\n\r\n")
        return found

    def _request(self) -> None:
        assert self._head is not None
        head, self._head = self._head, None
        body = bytes(self._data[: head.length])
        del self._data[: head.length]
        self._bounds.places.rest(self)
        self._reply(head.version, "200 OK", self._answer(body), MEDIA_TYPE)
        if not head.stays:
            self._finish()

    def _reply(self, version: str, status: str, body: bytes, kind: str) -> None:
        head = f"{version} {status}\r\nServer: cfepy\r\nContent-Type: {kind}\r\nContent-Length: {len(body)}\r\n\r\n"
        self._socket.send(head.encode() + body)

    def _finish(self) -> None:
        self._socket.finish()
        self._gone()


def _head_of(data: bytes, names: OwnNames, here: str) -> _Head:
    """Parse the head of a request, and check that a client of ROS may have sent it.

    Args:
        data: the data up to the empty line.
        names: names of this computer.
        here: the address of this computer that the client has connected to.

    Returns:
        The head.

    Raises:
        _Refused: such a client does not send it, or its body is too large.
    """
    first, *lines = data.decode("latin-1").split("\r\n")
    method, _, rest = first.partition(" ")
    version = rest.rpartition(" ")[2]
    if version not in VERSIONS:
        raise _Refused("400 Bad Request", "not an HTTP/1.1 request")
    fields: dict[str, str] = {}
    for line in lines:
        name, _, value = line.partition(":")
        name = name.strip().lower()
        if name in fields and name in ONE_ONLY:
            raise _Refused("400 Bad Request", f"the field {name} is given twice")
        fields[name] = value.strip()
    _check_sender(fields, names, here, version)
    if method != "POST":
        raise _Refused("501 Not Implemented", "XML-RPC requires POST")
    if fields.get("content-type", "").partition(";")[0].strip().lower() != MEDIA_TYPE:
        raise _Refused("415 Unsupported Media Type", f"XML-RPC requires {MEDIA_TYPE}")
    length = fields.get("content-length", "")
    if "transfer-encoding" in fields or not length.isdecimal() or len(length) > 19:
        raise _Refused("411 Length Required", "the field Content-Length is missing")
    if int(length) > RPC_BYTES:
        raise _Refused("413 Content Too Large", f"a request must have at most {RPC_BYTES:,} bytes", int(length))
    return _Head(version, fields, int(length))


def _check_sender(fields: dict[str, str], names: OwnNames, here: str, version: str) -> None:
    """Refuse requests of a page in a browser.

    Raises:
        _Refused: it is such a request.
    """
    browser = next((each for each in BROWSER_FIELDS if each in fields), "")
    if browser:
        raise _Refused("403 Forbidden", f"requests from a page in a browser are refused ({browser})")
    host = fields.get("host")
    if host is None and version == "HTTP/1.1":
        raise _Refused("400 Bad Request", "the field Host is missing")
    if host is not None and not names.has(host, here):
        why = f"{host!r:.100} is not a name of this computer; if it is, set ROS_HOSTNAME to it"
        raise _Refused("421 Misdirected Request", why)
