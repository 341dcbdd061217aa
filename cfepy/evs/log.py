"""The event log: the last or the first events, kept until a command writes them to a file (EVS_Log_t)."""

from __future__ import annotations

OVERWRITE, DISCARD = 0, 1
"""The treatment of events when the log is full (CFE_EVS_LogMode_Enum_t)."""


class EventLog:
    """A ring of long event packets.

    Args:
        size: number of packets that it holds.
        mode: OVERWRITE or DISCARD.

    Attributes:
        overflow: number of events that arrived when it was full; telemetry has its lower 16 bits.
    """

    __slots__ = ("_entries", "_next", "_size", "mode", "overflow")

    def __init__(self, size: int, mode: int) -> None:
        self._size = size
        self._entries: list[bytes] = []
        self._next = 0
        self.mode = mode
        self.overflow = 0

    @property
    def is_full(self) -> bool:
        """Whether the next event overwrites an event or is lost."""
        return len(self._entries) == self._size

    def add(self, packet: bytes) -> None:
        """Add an event according to the mode (EVS_AddLog)."""
        if not self.is_full:
            self._entries.append(packet)
        else:
            self.overflow += 1
            if self.mode == DISCARD:
                return
            self._entries[self._next] = packet
        self._next = (self._next + 1) % self._size

    def clear(self) -> None:
        """Remove all events; the mode stays (EVS_ClearLog)."""
        self._entries.clear()
        self._next = self.overflow = 0

    def entries(self) -> list[bytes]:
        """Return the packets, the oldest first."""
        if self.is_full:
            return self._entries[self._next :] + self._entries[: self._next]
        return self._entries[:]

    def summary(self) -> str:
        """Return next slot, count, full flag, mode and overflows as the system log shows them."""
        return f"n={self._next}, c={len(self._entries)}, f={int(self.is_full)}, m={self.mode}, o={self.overflow}"
