"""Limits for all connections of a server together: number, memory, and time between two parts of a run.

A client that opens connections and leaves them, or starts large messages and never completes them, does not affect the
others: a connection that has not stated its purpose is closed for a new one, and the connection with the largest
incomplete message is closed.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Protocol

from cfepy.reading.input_limits import PEER_CONNECTIONS, UNFINISHED_BYTES

HEAD_S = 10.0  # wall time within which a connection must state its purpose
TURN_S = 0.05  # wall time for requests between two parts of a run; the others wait for the next
TOO_MUCH = f"incomplete messages have more than {UNFINISHED_BYTES:,} bytes, and this one is the largest"


class Guarded(Protocol):
    """A connection, as seen by these limits."""

    def fail(self, why: str) -> None:
        """Close it, with a reason for its owner."""


class PeerPlaces:
    """Limit of the number of connections.

    Args:
        most: maximum number.
    """

    def __init__(self, most: int = PEER_CONNECTIONS) -> None:
        self._most = min(most, _files_allowed() // 4)
        self._new: dict[Guarded, float] = {}  # with the wall time of their start
        self._idle: dict[Guarded, None] = {}  # longest idle first
        self._kept: set[Guarded] = set()

    def __len__(self) -> int:
        return len(self._new) + len(self._idle) + len(self._kept)

    def take(self, peer: Guarded, now_s: float) -> None:
        """Add a connection. If the limit is reached, close the oldest connection that may be closed.

        If none may be closed, close the new connection.
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
        """Keep a connection that has stated its purpose."""
        if self._is_there(peer):
            self.leave(peer)
            self._kept.add(peer)

    def rest(self, peer: Guarded) -> None:
        """Keep a connection that has got its answer, as long as there is room."""
        if self._is_there(peer):
            self.leave(peer)
            self._idle[peer] = None

    def leave(self, peer: Guarded) -> None:
        """Remove a closed connection."""
        self._new.pop(peer, None)
        self._idle.pop(peer, None)
        self._kept.discard(peer)

    def look(self, now_s: float) -> None:
        """Close connections that have not stated their purpose in time."""
        for peer in [each for each, since_s in self._new.items() if now_s - since_s > HEAD_S]:
            self.leave(peer)
            peer.fail("no request was received")

    def _is_there(self, peer: Guarded) -> bool:
        return peer in self._new or peer in self._idle or peer in self._kept


class InputRoom:
    """Limit of the memory for messages that are incomplete, or wait to be taken.

    Args:
        most: number of bytes.
    """

    def __init__(self, most: int = UNFINISHED_BYTES) -> None:
        self._most = most
        self._held: dict[Guarded, int] = {}
        self.size = 0

    def hold(self, peer: Guarded, size: int) -> None:
        """Set the bytes of a connection; if all together have too many, the one with the most is closed."""
        self.release(peer)
        if size:
            self._held[peer] = size
            self.size += size
        while self.size > self._most:
            largest = max(self._held, key=self._held.__getitem__)
            self.release(largest)
            largest.fail(TOO_MUCH)

    def release(self, peer: Guarded) -> None:
        """Remove a connection that is closed or has no bytes."""
        self.size -= self._held.pop(peer, 0)


class InputTurn:
    """Limit of the wall time for clients' requests between two parts of a run.

    Args:
        seconds: length of a turn.
        clock: returns wall time in s.
    """

    def __init__(self, seconds: float = TURN_S, clock: Callable[[], float] = time.monotonic) -> None:
        self._seconds = seconds
        self._clock = clock
        self._until_s = clock() + seconds

    def begin(self) -> None:
        """Start the next turn, after a part of the run."""
        self._until_s = self._clock() + self._seconds

    @property
    def is_over(self) -> bool:
        """Whether the rest must wait for the next turn."""
        return self._clock() >= self._until_s


def _files_allowed() -> int:
    """Return the maximum number of open files of this process."""
    try:
        import resource
    except ImportError:  # not a POSIX system
        return 2048
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return soft if soft != resource.RLIM_INFINITY else 1 << 20
