"""Errands: what must wait for another program, done in threads of the host while the run goes on.

Such are calls of a master or a node that may be slow or gone, and connecting. An errand is a function; what came of it
is handed over when the host looks, between two pieces of the run. Those of one line are done one after the other.
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
MOST_WAITING = 200  # errands of a line; beyond that the oldest is left out
MOST_LINES = 2000  # in which one waits; a new one is left out
MOST_THREADS = 16
MOST_HEAD = 1 << 16  # bytes of an answer's fields of HTTP

Done = Callable[[Any, Exception | None], object]
"""Takes the result, or what went wrong."""


class Errands:
    """Does errands.

    Args:
        tell: gets a line about a result that could not be used.

    Attributes:
        left_out: errands that were given up because too many waited.
    """

    def __init__(self, tell: Callable[[str], object] = lambda line: None) -> None:
        self.left_out = 0
        self._tell = tell
        self._near, self._far = socket.socketpair()
        self._near.setblocking(False)
        self._far.setblocking(False)
        self._lines: dict[str, deque[tuple[Callable[[], Any], Done]]] = {}
        self._ready: deque[str] = deque()  # lines whose first errand no thread does yet
        self._threads = 0
        self._results: deque[tuple[Done, Any, Exception | None]] = deque()
        self._guard = threading.Lock()
        self._is_closed = False

    def fileno(self) -> int:
        """What can be read when something is done."""
        return self._near.fileno()

    def run(self, line: str, errand: Callable[[], Any], done: Done) -> None:
        """Have an errand done.

        Args:
            line: what it must wait for is done before it.
            errand: called in another thread.
            done: gets the result; the error when it was left out.
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
        except RuntimeError:  # this computer has no more threads now; another one of these does it, or the next
            with self._guard:
                self._threads -= 1

    def _leave_out(self, done: Done) -> None:
        self.left_out += 1
        self._results.append((done, None, RosError("too many requests to other programs are pending")))
        self.nudge()

    def ask(self, uri: str, method: str, arguments: tuple[Any, ...], done: Done) -> None:
        """Call a method over XML-RPC; what came of it is the value of the answer."""
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
            except Exception as problem:  # what goes wrong is told to whom it concerns
                result, error = None, problem
            self._results.append((done, result, error))
            with self._guard:
                if self._lines[line]:
                    self._ready.append(line)
                else:
                    del self._lines[line]
            self.nudge()

    def nudge(self) -> None:
        """There is something to do between two pieces of the run: it is not to sleep after the next one."""
        try:
            self._far.send(b"!")
        except OSError:
            pass  # there are enough marks already, or nobody looks any more

    def deliver(self) -> None:
        """Hand over what was done."""
        try:
            while self._near.recv(4096):
                pass
        except OSError:
            pass
        while self._results:
            done, result, error = self._results.popleft()
            try:
                done(result, error)
            except Exception as problem:  # another program's answer was not what it should be
                self._tell(f"invalid answer of another program: {type(problem).__name__}: {problem}")

    def close(self) -> None:
        """What is under way is left behind."""
        with self._guard:
            self._is_closed = True
        self._near.close()
        self._far.close()


class _BoundedSocket(socket.socket):
    """A connected socket that reads for a time, and so many bytes, and then fails."""

    def __init__(self, connected: socket.socket) -> None:
        super().__init__(connected.family, connected.type, connected.proto, fileno=connected.detach())
        self.settimeout(PATIENCE_S)
        self._end_s = time.monotonic() + PATIENCE_S
        self._left = RPC_BYTES + MOST_HEAD

    def recv_into(self, *arguments: Any) -> int:
        """As `socket.recv_into`.

        Raises:
            OSError: timeout while waiting for the answer, or is too large.
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
    """A connection whose answers come in time, and are not too large."""

    def connect(self) -> None:
        super().connect()
        self.sock = _BoundedSocket(self.sock)


class _Patient(Transport):
    """XML-RPC over HTTP with an end to waiting, and bounds for what comes."""

    accept_gzip_encoding = False  # what is packed may be of any size

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        """A connection that gives up after some time; each is for one request."""
        address, self._extra_headers, _ = self.get_host_info(host)
        connection = _BoundedConnection(address, timeout=PATIENCE_S)
        self._connection = host, connection
        return connection

    def parse_response(self, response: Any) -> Any:
        """The values of an answer."""
        if response.getheader("Content-Encoding", "identity").lower() != "identity":
            raise RosError("the answer is compressed, which the request did not allow")
        return read_body(response.read())[0]


def ask(uri: str, method: str, *arguments: Any) -> Any:
    """Call a method of ROS's master or slave API and wait for the answer.

    Returns:
        Its value.

    Raises:
        RosError: the answer says that it failed, or there was none that can be read.
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
    """The other side has answered that something failed."""


def connect(uri: str) -> socket.socket:
    """Connect with the program at a URI, whose host and port count.

    Raises:
        OSError, ValueError: there is none.
    """
    parts = urlsplit(uri)
    if parts.scheme != "rosrpc":
        raise ValueError(f"invalid service URI {uri!r:.200}; expected rosrpc://HOST:PORT")
    return socket.create_connection((parts.hostname or "", parts.port or 0), PATIENCE_S)
