"""What passed between the mission and each outside peer, and what was lost on the way: rows of the run's report."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

MOST_ROWS = 200  # peers that are told apart; tools with a new name for each start would make more and more
OTHERS = "(others)"
INTO, OUT_OF = "in", "out"


@dataclass(slots=True)
class PeerCount:
    """One peer at one topic or service.

    Attributes:
        name: of the topic or service.
        peer: name of the outside node, or its URI as long as nothing else is known.
        direction: "in" or "out", of messages; of a service that of the requests.
        messages, size: that passed, and their bytes.
        dropped: messages that did not pass: the peer was too slow, or the bus did not take them.
        connections: how often they were connected.
        ended: connections that the other side has ended, or that broke.
        refused: connections that could not be, such as for another md5sum.
        why: what went wrong last.
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
        """The count of a peer; those beyond a bound share one."""
        key = (name, peer, direction)
        found = self._counts.get(key)
        if found is None:
            if len(self._counts) >= MOST_ROWS:
                key = (OTHERS, OTHERS, direction)
            found = self._counts.setdefault(key, PeerCount(*key))
        return found

    def rows(self) -> list[dict[str, Any]]:
        """A row for each peer, by topic or service."""
        return [asdict(self._counts[key]) for key in sorted(self._counts)]
