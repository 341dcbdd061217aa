"""Messages between the mission and each outside peer, and losses: rows of the run's report."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

# maximum number of peers counted separately; tools with a new name at each start would add more and more
MOST_ROWS = 200
OTHERS = "(others)"
INTO, OUT_OF = "in", "out"


@dataclass(slots=True)
class PeerCount:
    """One peer at one topic or service.

    Attributes:
        name: name of the topic or service.
        peer: name of the outside node, or its URI if the name is not known yet.
        direction: "in" or "out", of messages or of a service's requests.
        messages: number of messages that passed.
        size: total size of these messages, in bytes.
        dropped: messages lost because the peer was too slow, or the bus did not take them.
        connections: number of connections.
        ended: connections that the other side ended, or that broke.
        refused: refused connections, such as for another md5sum.
        why: last error.
    """

    name: str
    peer: str
    direction: str
    messages: int = 0
    size: int = 0
    dropped: int = 0
    connections: int = 0
    ended: int = 0
    refused: int = 0
    why: str = ""


class PeerCounts:
    """The counts of a run."""

    def __init__(self) -> None:
        self._counts: dict[tuple[str, str, str], PeerCount] = {}

    def of(self, name: str, peer: str, direction: str) -> PeerCount:
        """Return the count of a peer; those beyond a limit share one."""
        key = (name, peer, direction)
        found = self._counts.get(key)
        if found is None:
            if len(self._counts) >= MOST_ROWS:
                key = (OTHERS, OTHERS, direction)
            found = self._counts.setdefault(key, PeerCount(*key))
        return found

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each peer, by topic or service."""
        return [asdict(self._counts[key]) for key in sorted(self._counts)]
