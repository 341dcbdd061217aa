"""The numbers of processes: each node of a mission has one of its own, which is also the port in its URIs."""

from __future__ import annotations

from collections.abc import Collection


class ProcessNumbers:
    """The numbers that are taken.

    Args:
        taken: ports that are no node's.
    """

    def __init__(self, taken: Collection[int] = ()) -> None:
        self._taken = set(taken)

    def take(self, wanted: int) -> int:
        """The next number from one on that no other node has.

        Args:
            wanted: see `cfepy.nodes.process_number`.
        """
        while wanted in self._taken:
            wanted += 1
        self._taken.add(wanted)
        return wanted

    def give(self, number: int) -> None:
        """A node has ended: another may have its number."""
        self._taken.remove(number)
