"""Errands: what must wait for another program, done in threads of the host while the run goes on.

Such are calls of a master or a node that may be slow or gone, and connecting. An errand is a function; what came of it
is handed over when the host looks, between two pieces of the run. Those of one line are done one after the other.
"""

from __future__ import annotations

import http.client
import socket
import threading
from collections import deque
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit
from xmlrpc.client import ServerProxy, Transport

PATIENCE_S = 5.0  # wall time for an answer
MOST_WAITING = 200  # errands of a line; beyond that the oldest is left out

Done = Callable[[Any, Exception | None], object]
"""Takes the result, or what went wrong."""


class Errands:
    """Does errands.

    Attributes:
        left_out: errands that were given up because too many waited in their line.
    """

    def __init__(self) -> None:
        self.left_out = 0
        self._near, self._far = socket.socketpair()
        self._near.setblocking(False)
        self._far.setblocking(False)
        self._lines: dict[str, deque[tuple[Callable[[], Any], Done]]] = {}
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
            done: gets what came of it.
        """
        with self._guard:
            waiting = self._lines.get(line)
            if waiting is not None:
                waiting.append((errand, done))
                if len(waiting) > MOST_WAITING:
                    waiting.popleft()
                    self.left_out += 1
                return
            self._lines[line] = deque([(errand, done)])
        threading.Thread(target=self._work, args=(line,), name=f"errands {line}", daemon=True).start()

    def ask(self, uri: str, method: str, arguments: tuple[Any, ...], done: Done) -> None:
        """Call a method over XML-RPC; what came of it is the value of the answer."""
        self.run(uri, lambda: ask(uri, method, *arguments), done)

    def _work(self, line: str) -> None:
        while True:
            with self._guard:
                waiting = self._lines[line]
                if not waiting or self._is_closed:
                    del self._lines[line]
                    return
                errand, done = waiting.popleft()
            try:
                result: Any = errand()
                error = None
            except Exception as problem:  # what goes wrong is told to whom it concerns
                result, error = None, problem
            self._results.append((done, result, error))
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
            done(result, error)

    def close(self) -> None:
        """What is under way is left behind."""
        with self._guard:
            self._is_closed = True
        self._near.close()
        self._far.close()


class _Patient(Transport):
    """XML-RPC over HTTP with an end to waiting."""

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        """A connection that gives up after some time."""
        connection = super().make_connection(host)
        connection.timeout = PATIENCE_S
        return connection


def ask(uri: str, method: str, *arguments: Any) -> Any:
    """Call a method of ROS's master or slave API and wait for the answer.

    Returns:
        Its value.

    Raises:
        RosError: the answer says that it failed.
        OSError, xmlrpc.client.Error: there was no answer.
    """
    with ServerProxy(uri, transport=_Patient(use_builtin_types=True), allow_none=False) as server:
        answer: Any = getattr(server, method)(*arguments)
    code, text, value = answer
    if code != 1:
        raise RosError(text or f"{method} failed")
    return value


class RosError(Exception):
    """The other side has answered that something failed."""


def connect(uri: str) -> socket.socket:
    """Connect with the program at a URI, whose host and port count.

    Raises:
        OSError, ValueError: there is none.
    """
    parts = urlsplit(uri)
    return socket.create_connection((parts.hostname or "", parts.port or 0), PATIENCE_S)
