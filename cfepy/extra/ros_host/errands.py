"""Background requests that wait for another program, done in threads of the host while the run goes on.

Examples are connecting, and calls of a master or a node that may be slow or gone. An errand is a function. Its result
is delivered when the host asks for it, between two steps of the run. Errands of one line run one after the other.
"""

from __future__ import annotations

import http.client
import socket
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit
from xmlrpc.client import Error as RpcFault
from xmlrpc.client import ServerProxy, Transport

from cfepy.extra.ros_host.rpc_body import read_body
from cfepy.reading.input_limits import RPC_BYTES
from cfepy.status import UsageError

PATIENCE_S = 5.0  # wall time for an answer
MOST_WAITING = 200  # errands of a line; beyond that the oldest is dropped
MOST_LINES = 2000  # lines with waiting errands; a new line is dropped
MOST_THREADS = 16
MOST_HEAD = 1 << 16  # bytes of an answer's HTTP header

Done = Callable[[Any, Exception | None], object]
"""Receives the result, or the error."""


class Errands:
    """Runs errands.

    Args:
        tell: receives a message about a result that could not be used.

    Attributes:
        left_out: number of errands that were dropped because too many waited.
    """

    def __init__(self, tell: Callable[[str], object] = lambda line: None) -> None:
        self.left_out = 0
        self._tell = tell
        self._near, self._far = socket.socketpair()
        self._near.setblocking(False)
        self._far.setblocking(False)
        self._lines: dict[str, deque[tuple[Callable[[], Any], Done]]] = {}
        self._ready: deque[str] = deque()  # lines whose first errand no thread has taken yet
        self._threads = 0
        self._results: deque[tuple[Done, Any, Exception | None]] = deque()
        self._guard = threading.Lock()
        self._is_closed = False

    def fileno(self) -> int:
        """Return the descriptor that becomes readable when an errand is done."""
        return self._near.fileno()

    def run(self, line: str, errand: Callable[[], Any], done: Done) -> None:
        """Run an errand in the background.

        Args:
            line: name of a line; errands of the same line run in order.
            errand: called in another thread.
            done: receives the result, or an error if the errand was dropped.
        """
        with self._guard:
            waiting = self._lines.get(line)
            if waiting is not None:
                waiting.append((errand, done))
                if len(waiting) > MOST_WAITING:
                    self._leave_out(waiting.popleft()[1])
                return
            if len(self._lines) >= MOST_LINES:
                self._leave_out(done)
                return
            self._lines[line] = deque([(errand, done)])
            self._ready.append(line)
            if self._threads >= MOST_THREADS:
                return
            self._threads += 1
        try:
            threading.Thread(target=self._work, name="errands", daemon=True).start()
        except RuntimeError:  # no more threads now; a running one takes it, or the next call starts one
            with self._guard:
                self._threads -= 1

    def _leave_out(self, done: Done) -> None:
        self.left_out += 1
        self._results.append((done, None, RosError("too many requests to other programs are pending")))
        self.nudge()

    def ask(self, uri: str, method: str, arguments: tuple[Any, ...], done: Done) -> None:
        """Call a method over XML-RPC; `done` receives the value of the answer."""
        self.run(uri, lambda: ask(uri, method, *arguments), done)

    def _work(self) -> None:
        while True:
            with self._guard:
                if not self._ready or self._is_closed:
                    self._threads -= 1
                    return
                line = self._ready.popleft()
                errand, done = self._lines[line].popleft()
            try:
                result: Any = errand()
                error = None
            except Exception as problem:  # the caller receives the error
                result, error = None, problem
            self._results.append((done, result, error))
            with self._guard:
                if self._lines[line]:
                    self._ready.append(line)
                else:
                    del self._lines[line]
            self.nudge()

    def nudge(self) -> None:
        """Wake the host: it must not sleep after the next step of the run, because a result waits."""
        try:
            self._far.send(b"!")
        except OSError:
            pass  # enough marks wait already, or the host has closed its end

    def deliver(self) -> None:
        """Deliver the results."""
        try:
            while self._near.recv(4096):
                pass
        except OSError:
            pass
        while self._results:
            done, result, error = self._results.popleft()
            try:
                done(result, error)
            except Exception as problem:  # the answer of the other program was not as expected
                self._tell(f"invalid answer of another program: {type(problem).__name__}: {problem}")

    def close(self) -> None:
        """Close; running errands are abandoned."""
        with self._guard:
            self._is_closed = True
        self._near.close()
        self._far.close()


class _BoundedSocket(socket.socket):
    """A connected socket that fails after a time limit or a number of bytes."""

    def __init__(self, connected: socket.socket) -> None:
        super().__init__(connected.family, connected.type, connected.proto, fileno=connected.detach())
        self.settimeout(PATIENCE_S)
        self._end_s = time.monotonic() + PATIENCE_S
        self._left = RPC_BYTES + MOST_HEAD

    def recv_into(self, *arguments: Any) -> int:
        """Receive as `socket.recv_into` does.

        Raises:
            OSError: timeout while waiting for the answer, or the answer is too large.
        """
        left_s = self._end_s - time.monotonic()
        if left_s <= 0:
            raise TimeoutError("timeout while waiting for the answer")
        self.settimeout(left_s)
        size = super().recv_into(*arguments)
        self._left -= size
        if self._left < 0:
            raise OSError(f"the answer has more than {RPC_BYTES:,} bytes")
        return size


class _BoundedConnection(http.client.HTTPConnection):
    """A connection whose answers have a time limit and a size limit."""

    def connect(self) -> None:
        super().connect()
        self.sock = _BoundedSocket(self.sock)


class _Patient(Transport):
    """XML-RPC over HTTP with a timeout, and limits for the answer."""

    accept_gzip_encoding = False  # compressed data may expand to any size

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        """Make a connection with a timeout; each is for one request."""
        address, self._extra_headers, _ = self.get_host_info(host)
        connection = _BoundedConnection(address, timeout=PATIENCE_S)
        self._connection = host, connection
        return connection

    def parse_response(self, response: Any) -> Any:
        """Return the values of an answer."""
        if response.getheader("Content-Encoding", "identity").lower() != "identity":
            raise RosError("the answer is compressed, which the request did not allow")
        return read_body(response.read())[0]


def ask(uri: str, method: str, *arguments: Any) -> Any:
    """Call a method of ROS's master or slave API and wait for the answer.

    Returns:
        Its value.

    Raises:
        RosError: the answer reports a failure, or cannot be read.
        OSError: there was no answer.
    """
    try:
        with ServerProxy(uri, transport=_Patient(use_builtin_types=True), allow_none=False) as server:
            answer: Any = getattr(server, method)(*arguments)
    except (RpcFault, UsageError, http.client.HTTPException, ValueError, RecursionError) as error:
        raise RosError(f"{type(error).__name__}: {error}") from None
    if not isinstance(answer, list | tuple) or len(answer) != 3 or type(answer[0]) is not int:
        raise RosError(f"invalid answer to {method}; expected code, text and value")
    code, text, value = answer
    if code != 1:
        raise RosError(str(text) or f"{method} failed")
    return value


class RosError(Exception):
    """The other side has answered that a request failed."""


def connect(uri: str) -> socket.socket:
    """Connect to the program at a URI; only host and port of the URI are used.

    Raises:
        OSError, ValueError: there is no such program.
    """
    parts = urlsplit(uri)
    if parts.scheme != "rosrpc":
        raise ValueError(f"invalid service URI {uri!r:.200}; expected rosrpc://HOST:PORT")
    return socket.create_connection((parts.hostname or "", parts.port or 0), PATIENCE_S)
