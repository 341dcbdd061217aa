"""What viewers want, on its way from the server's threads to the run, which takes it when it stands still."""

from __future__ import annotations

import socket
import threading
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

MOST_ENTRIES = 10_000
MOST_BYTES = 1 << 26


class Subscribed(NamedTuple):
    """A viewer has subscribed to a channel."""

    client: int
    channel: int


class Advertised(NamedTuple):
    """A viewer wants to publish; `schema` is the definition, if it gave one."""

    client: int
    number: int
    topic: str
    encoding: str
    kind: str
    schema: str


class Unadvertised(NamedTuple):
    """It will not any more, or is gone."""

    client: int
    number: int


class Published(NamedTuple):
    """A viewer's message."""

    client: int
    number: int
    data: bytes


class ParametersSet(NamedTuple):
    """A viewer sets parameters; None deletes one."""

    client: int
    values: dict[str, Any]


@dataclass(eq=False, slots=True)
class Called:
    """A viewer calls a service; a thread of the server waits for `over`.

    Attributes:
        error: what went wrong; "" when `answer` is the response.
    """

    client: int
    service: str
    request: bytes
    answer: bytes = b""
    error: str = ""
    over: threading.Event = field(default_factory=threading.Event)

    def end(self, answer: bytes, error: str = "") -> None:
        """It is answered."""
        self.answer, self.error = answer, error
        self.over.set()


Entry = Subscribed | Advertised | Unadvertised | Published | ParametersSet | Called


class ViewerInbox:
    """Takes entries of any thread. Beyond a bound they are lost and counted; that somebody leaves is not.

    Attributes:
        lost: entries that found no room.
    """

    def __init__(self) -> None:
        self.lost = 0
        self._entries: deque[Entry] = deque()
        self._size = 0
        self._guard = threading.Lock()
        self._near, self._far = socket.socketpair()
        self._near.setblocking(False)
        self._far.setblocking(False)

    def fileno(self) -> int:
        """What can be read when something came."""
        return self._near.fileno()

    def put(self, entry: Entry) -> bool:
        """Leave an entry; False when it found no room."""
        size = len(entry.data) if isinstance(entry, Published) else 0
        with self._guard:
            is_full = len(self._entries) >= MOST_ENTRIES or self._size + size > MOST_BYTES
            if is_full and not isinstance(entry, Unadvertised):
                self.lost += 1
                return False
            self._size += size
            self._entries.append(entry)
        try:
            self._far.send(b"!")
        except OSError:
            pass  # there are enough marks already, or nobody looks any more
        return True

    def take(self) -> Iterator[Entry]:
        """What is there now."""
        try:
            while self._near.recv(4096):
                pass
        except OSError:
            pass
        with self._guard:
            entries, self._entries, self._size = self._entries, deque(), 0
        yield from entries

    def close(self) -> None:
        """Nobody looks any more."""
        self._near.close()
        self._far.close()
