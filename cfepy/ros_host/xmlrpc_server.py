"""An XML-RPC server over HTTP that answers between two pieces of a run (xmlrpc.com/spec, RFC 9112).

It reads as much of HTTP as the clients of ROS in Python and C++ send: POST with a Content-Length, and
connections that stay.
"""

from __future__ import annotations

import socket
from collections.abc import Callable, Sequence
from selectors import BaseSelector
from typing import Any
from xmlrpc.client import Fault, dumps, loads

from cfepy.io import Listening, PeerSocket, listening_socket

LONGEST_HEAD = 1 << 14  # bytes
LONGEST_BODY = 1 << 26
MOST_CONNECTIONS = 256  # of one server; the oldest goes when another comes
MULTICALL = "system.multicall"

Answering = Callable[[str, Sequence[Any], bytes], Any]
"""Takes method, arguments and the whole request, and gives the value to answer."""


class XmlRpcServer:
    """Answers requests at a port.

    Args:
        selector: of the host.
        address: of the interface; "" for all.
        answering: answers; an exception is a fault.
        port: 0 takes any free one.

    Attributes:
        port: where it listens.

    Raises:
        OSError: the port is taken.
    """

    def __init__(self, selector: BaseSelector, address: str, answering: Answering, port: int = 0) -> None:
        self._selector = selector
        self._answering = answering
        self._listening = Listening(selector, listening_socket(address, port), self._accept)
        self._connections: dict[_Connection, None] = {}
        self.port = self._listening.port

    def _accept(self, connected: socket.socket) -> None:
        while len(self._connections) >= MOST_CONNECTIONS:
            next(iter(self._connections)).close()
        self._connections[_Connection(self._selector, connected, self._answer, self._forget)] = None

    def _forget(self, connection: _Connection) -> None:
        self._connections.pop(connection, None)

    def _answer(self, body: bytes) -> bytes:
        try:
            arguments: Any
            arguments, method = loads(body, use_builtin_types=True)
            if method == MULTICALL:
                value: Any = [self._one_of_many(each) for each in arguments[0]]
            else:
                value = self._answering(str(method), arguments, body)
            return dumps((value,), methodresponse=True).encode()
        except Exception as error:  # as Python's own server: a fault is the client's to look at
            return dumps(_fault(error), methodresponse=True).encode()

    def _one_of_many(self, request: dict[str, Any]) -> Any:
        """A request of several that come at once, as rospy takes back what it has registered."""
        try:
            method, arguments = str(request["methodName"]), tuple(request["params"])
            return [self._answering(method, arguments, dumps(arguments, method).encode())]
        except Exception as error:
            fault = _fault(error)
            return {"faultCode": fault.faultCode, "faultString": fault.faultString}

    def close(self) -> None:
        """No more requests."""
        self._listening.close()
        for each in list(self._connections):
            each.close()


def _fault(error: Exception) -> Fault:
    return Fault(1, f"{type(error)}:{error}")


class _Connection:
    """A client."""

    def __init__(
        self,
        selector: BaseSelector,
        connected: socket.socket,
        answer: Callable[[bytes], bytes],
        forget: Callable[[_Connection], object],
    ) -> None:
        self._data = bytearray()
        self._answer = answer
        self._forget = forget
        self._socket = PeerSocket(selector, connected, self._take, lambda why: forget(self))

    def close(self) -> None:
        self._socket.close()
        self._forget(self)

    def _take(self, data: bytes) -> None:
        self._data += data
        while self._request():
            pass

    def _request(self) -> bool:
        """Answer one request, if it is complete."""
        head, mark, _ = bytes(self._data[: LONGEST_HEAD + 4]).partition(b"\r\n\r\n")
        if not mark:
            if len(self._data) > LONGEST_HEAD:
                raise ValueError("the head of a request is too long")
            return False
        first, *lines = head.decode("latin-1").split("\r\n")
        fields = {name.strip().lower(): value.strip() for name, _, value in (line.partition(":") for line in lines)}
        method, version = first.split(" ")[0], first.rpartition(" ")[2]
        length = fields.get("content-length", "")
        if method != "POST" or not length.isdecimal() or int(length) > LONGEST_BODY:
            self._reply(version, "501 Not Implemented" if method != "POST" else "411 Length Required", b"")
            self._finish()
            return False
        start = len(head) + 4
        if len(self._data) < start + int(length):
            if fields.get("expect", "").lower() == "100-continue" and len(self._data) == start:
                self._socket.send(f"{version} 100 Continue\r\n\r\n".encode())
            return False
        body = bytes(self._data[start : start + int(length)])
        del self._data[: start + int(length)]
        self._reply(version, "200 OK", self._answer(body))
        stays = fields.get("connection", "keep-alive" if version == "HTTP/1.1" else "close").lower()
        if stays == "close":
            self._finish()
            return False
        return self._socket.is_open

    def _reply(self, version: str, status: str, body: bytes) -> None:
        head = f"{version} {status}\r\nServer: cfepy\r\nContent-Type: text/xml\r\nContent-Length: {len(body)}\r\n\r\n"
        self._socket.send(head.encode() + body)

    def _finish(self) -> None:
        self._socket.finish()
        self._forget(self)
