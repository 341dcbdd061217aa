"""The event data of an application: its filters, enabled event types, counters and flood limit.

It replaces EVS_AppData_t, EVS_IsFiltered and EVS_CheckAndIncrementSquelchTokens. It sends no events itself.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from cfepy.config.platform import PlatformConfig
from cfepy.units import NS_PER_MS

ALL_TYPES = 0x0F
"""A bit for each event type: DEBUG 1, INFORMATION 2, ERROR 4, CRITICAL 8."""

FREE_SLOT = 0xFFFF
MAX_FILTER_COUNT = 0xFFFF
MAX_SQUELCHED = 255

EVENT_COST = 1000


@dataclass(slots=True)
class BinFilter:
    """A filter that passes an event if its count and the mask have no bit in common (EVS_BinFilter_t)."""

    event_id: int = FREE_SLOT
    mask: int = 0
    count: int = 0


class Filters:
    """The filter slots of an application.

    Args:
        size: number of slots.
        wanted: (event id, mask) pairs; pairs that do not fit are dropped.
    """

    __slots__ = ("_by_id", "slots")

    def __init__(self, size: int, wanted: Iterable[tuple[int, int]] = ()) -> None:
        self.slots = [BinFilter() for _ in range(size)]
        for slot, (event_id, mask) in zip(self.slots, wanted, strict=False):
            slot.event_id, slot.mask = event_id, mask
        self._index()

    def _index(self) -> None:
        self._by_id = {slot.event_id: slot for slot in reversed(self.slots)}

    def find(self, event_id: int) -> BinFilter | None:
        """Return the filter of an event, the first one if there are two; FREE_SLOT finds a free slot
        (EVS_FindEventID).
        """
        return self._by_id.get(event_id)

    def add(self, event_id: int, mask: int) -> bool:
        """Use a free slot; return False if there is none."""
        slot = self._by_id.get(FREE_SLOT)
        if slot is None:
            return False
        slot.event_id, slot.mask, slot.count = event_id, mask, 0
        self._index()
        return True

    def remove(self, slot: BinFilter) -> None:
        """Free a slot."""
        slot.event_id, slot.mask, slot.count = FREE_SLOT, 0, 0
        self._index()

    def reset(self) -> None:
        """Set all counts to 0."""
        for slot in self.slots:
            slot.count = 0


@dataclass(slots=True)
class Squelch:
    """The flood limit: a bucket of tokens that events empty and time refills.

    A token is a thousandth of an event, so integers suffice. The bucket can be as far below zero as it can be above. So
    after a flood, there is a pause before events pass again.

    Args:
        burst: number of events that a full bucket passes; 0 switches the limit off.
        per_second: number of events that a second refills.
    """

    burst: int
    per_second: int
    tokens: int = field(init=False)
    dropped: int = 0
    _credited_at: int = 0

    def __post_init__(self) -> None:
        self.refill()

    def refill(self) -> None:
        """Fill the bucket."""
        self.tokens = self.burst * EVENT_COST

    def admit(self, now: int) -> tuple[bool, bool]:
        """Return whether an event may pass at a time in ns, and whether to announce that events are being dropped."""
        if not self.burst:
            return True, False
        full = self.burst * EVENT_COST
        credit = (now - self._credited_at) // NS_PER_MS * self.per_second
        if credit >= EVENT_COST:
            self._credited_at = now
            self.tokens = min(full, self.tokens + credit)
        admitted = self.tokens > 0
        announce = not admitted and self.tokens > -EVENT_COST and credit < EVENT_COST
        if not admitted:
            self.dropped = min(MAX_SQUELCHED, self.dropped + 1)
        self.tokens = max(-full, self.tokens - EVENT_COST)
        return admitted, announce


class AppEvents:
    """An application registered for events.

    Args:
        app_id: its AppId.
        name: its name in events.
        config: limits and defaults.
        wanted: its (event id, mask) filters.

    Attributes:
        active: whether its events are enabled at all.
        types: enabled event types, one bit each.
        sent: number of events sent, at most 65535.
    """

    __slots__ = ("active", "app_id", "filters", "name", "sent", "squelch", "types")

    def __init__(self, app_id: int, name: str, config: PlatformConfig, wanted: Iterable[tuple[int, int]] = ()) -> None:
        self.app_id = app_id
        self.name = name
        self.active = True
        self.types = config.evs_default_type_flag
        self.sent = 0
        self.filters = Filters(config.evs_max_event_filters, wanted)
        self.squelch = Squelch(config.evs_max_app_event_burst, config.evs_app_events_per_sec)

    def set_types(self, mask: int, enabled: bool) -> None:
        """Switch event types on or off, and reset the flood limit (CFE_EVS_SetTypeEnable)."""
        self.types = self.types | mask if enabled else self.types & ~mask
        self.squelch.refill()

    def judge(self, event_id: int, event_type: int, types: int) -> tuple[bool, bool]:
        """Apply the filters to an event.

        Args:
            event_id: id of the event.
            event_type: type of the event.
            types: the event types enabled for the application whose task sends the event.

        Returns:
            Whether the event is filtered out, and whether this event locked its filter.
        """
        if not self.active or not 0 < event_type < 5 or not types >> event_type - 1 & 1:
            return True, False
        slot = self.filters.find(event_id)
        if slot is None:
            return False, False
        is_filtered = slot.mask & slot.count != 0
        if slot.count < MAX_FILTER_COUNT:
            slot.count += 1
            return is_filtered, slot.count == MAX_FILTER_COUNT
        return is_filtered, False
