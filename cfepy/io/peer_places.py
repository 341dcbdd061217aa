"""Bounds for what all connections of a server take together: places, memory, and time between two pieces of a run.

A client that opens connections and leaves them, or begins large messages and never ends them, takes nothing from the
others: a connection that has not said yet what it is for gives way to a new one, and the largest unfinished message
ends its connection.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Protocol

from cfepy.reading.input_limits import PEER_CONNECTIONS, UNFINISHED_BYTES

HEAD_S = 10.0  # wall time in which a connection has to say what it is for
TURN_S = 0.05  # wall time for requests between two pieces of a run; the others wait for the next
TOO_MUCH = f"incomplete messages have more than {UNFINISHED_BYTES:,} bytes, and this one is the largest"


class Guarded(Protocol):
    """A connection, as these bounds see it."""

    def fail(self, why: str) -> None:
        """End it, and say why to its owner."""


class PeerPlaces:
    """The places for connections.

    Args:
        most: how many there are.
    """

    def __init__(self, most: int = PEER_CONNECTIONS) -> None:
        self._most = min(most, _files_allowed() // 4)
        self._new: dict[Guarded, float] = {}  # with the wall time of their beginning
        self._idle: dict[Guarded, None] = {}  # the longest first
        self._kept: set[Guarded] = set()

    def __len__(self) -> int:
        return len(self._new) + len(self._idle) + len(self._kept)

    def take(self, peer: Guarded, now_s: float) -> None:
        """A new connection. When all places are taken, the oldest of those that may give way ends.

        It is the new one itself if none may.
        """
        while len(self) >= self._most:
            other = next(iter(self._new), None) or next(iter(self._idle), None)
            if other is None:
                peer.fail("too many connections")
                return
            self.leave(other)
            other.fail("closed to make room for another connection")
        self._new[peer] = now_s

    def keep(self, peer: Guarded) -> None:
        """A connection has said what it is for, and stays."""
        if self._is_there(peer):
            self.leave(peer)
            self._kept.add(peer)

    def rest(self, peer: Guarded) -> None:
        """A connection has got its answer, and stays as long as there are places enough."""
        if self._is_there(peer):
            self.leave(peer)
            self._idle[peer] = None

    def leave(self, peer: Guarded) -> None:
        """A connection is over."""
        self._new.pop(peer, None)
        self._idle.pop(peer, None)
        self._kept.discard(peer)

    def look(self, now_s: float) -> None:
        """End connections that have not said what they are for in time."""
        for peer in [each for each, since_s in self._new.items() if now_s - since_s > HEAD_S]:
            self.leave(peer)
            peer.fail("no request was received")

    def _is_there(self, peer: Guarded) -> bool:
        return peer in self._new or peer in self._idle or peer in self._kept


class InputRoom:
    """The memory for messages that are not whole, or wait to be taken.

    Args:
        most: bytes.
    """

    def __init__(self, most: int = UNFINISHED_BYTES) -> None:
        self._most = most
        self._held: dict[Guarded, int] = {}
        self.size = 0

    def hold(self, peer: Guarded, size: int) -> None:
        """A connection holds so many bytes now; if all hold too many, the one that holds most ends."""
        self.release(peer)
        if size:
            self._held[peer] = size
            self.size += size
        while self.size > self._most:
            largest = max(self._held, key=self._held.__getitem__)
            self.release(largest)
            largest.fail(TOO_MUCH)

    def release(self, peer: Guarded) -> None:
        """A connection is over, or holds nothing."""
        self.size -= self._held.pop(peer, 0)


class InputTurn:
    """The wall time for what clients ask for between two pieces of a run.

    Args:
        seconds: of a turn.
        clock: gives wall time in s.
    """

    def __init__(self, seconds: float = TURN_S, clock: Callable[[], float] = time.monotonic) -> None:
        self._seconds = seconds
        self._clock = clock
        self._until_s = clock() + seconds

    def begin(self) -> None:
        """A piece of the run is over: the next turn."""
        self._until_s = self._clock() + self._seconds

    @property
    def is_over(self) -> bool:
        """Whether the rest has to wait for the next turn."""
        return self._clock() >= self._until_s


def _files_allowed() -> int:
    """How many files this process may have open."""
    try:
        import resource
    except ImportError:  # no POSIX system
        return 2048
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return soft if soft != resource.RLIM_INFINITY else 1 << 20
