"""Generic counters (CFE_ES_*GenCount*): numbers of 32 bits that any application may make, find by name and count up.

Imports only cfepy.ids, cfepy.osal, cfepy.status and its neighbours here.
"""

from __future__ import annotations

from cfepy.es.records import GenCounter
from cfepy.es.tables import EsCore
from cfepy.ids import ES_COUNTID_BASE, name_size, to_index
from cfepy.osal.limits import OS_MAX_API_NAME
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_DUPLICATE_NAME,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CfeError,
)

_WORD = 0xFFFFFFFF


class CounterApi(EsCore):
    """The generic counters of Executive Services; they belong to nobody and stay until they are deleted."""

    def register_gen_counter(self, name: str) -> int:
        """Make a counter that stands at 0 (CFE_ES_RegisterGenCounter).

        Args:
            name: unique, at most 19 characters.

        Returns:
            The CounterId.

        Raises:
            CfeError: CFE_ES_BAD_ARGUMENT, CFE_ES_ERR_DUPLICATE_NAME, CFE_ES_NO_RESOURCE_IDS_AVAILABLE.
        """
        if name_size(name) >= OS_MAX_API_NAME:
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"counter name {name!r} has more than {OS_MAX_API_NAME - 1} characters")
        if any(counter.name == name for counter in self.counters):
            self.write_to_sys_log(f"CFE_ES_RegisterGenCounter: Duplicate Counter name '{name}'")
            raise CfeError(CFE_ES_ERR_DUPLICATE_NAME, f"there is a counter {name!r} already")
        if len(self.counters) >= self.counters.capacity:
            self.write_to_sys_log("CFE_ES_RegisterGenCounter: No free Counter slots available")
            text = f"there are {self.counters.capacity} counters already"
            raise CfeError(CFE_ES_NO_RESOURCE_IDS_AVAILABLE, text)
        return self.counters.create(GenCounter(name))

    def delete_gen_counter(self, counter_id: int) -> None:
        """Delete a counter, or CFE_ES_BAD_ARGUMENT (CFE_ES_DeleteGenCounter)."""
        self._counter(counter_id)
        self.counters.delete(counter_id)

    def increment_gen_counter(self, counter_id: int) -> None:
        """Count up by one, or CFE_ES_BAD_ARGUMENT (CFE_ES_IncrementGenCounter)."""
        counter = self._counter(counter_id)
        counter.count = counter.count + 1 & _WORD

    def set_gen_count(self, counter_id: int, count: int) -> None:
        """Set a counter to a number of 32 bits, or CFE_ES_BAD_ARGUMENT (CFE_ES_SetGenCount)."""
        self._counter(counter_id).count = count & _WORD

    def get_gen_count(self, counter_id: int) -> int:
        """What a counter stands at, or CFE_ES_BAD_ARGUMENT (CFE_ES_GetGenCount)."""
        return self._counter(counter_id).count

    def get_gen_counter_id_by_name(self, name: str) -> int:
        """CounterId of a named counter, or CFE_ES_ERR_NAME_NOT_FOUND (CFE_ES_GetGenCounterIDByName)."""
        for counter_id, counter in self.counters.items():
            if counter.name == name:
                return counter_id
        raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, f"no counter is called {name!r}")

    def get_gen_counter_name(self, counter_id: int) -> str:
        """Name of a counter, or CFE_ES_ERR_RESOURCEID_NOT_VALID (CFE_ES_GetGenCounterName)."""
        return self.counters.get(counter_id).name

    def counter_id_to_index(self, counter_id: int) -> int:
        """The slot of a CounterId, or CFE_ES_ERR_RESOURCEID_NOT_VALID (CFE_ES_CounterID_ToIndex)."""
        return to_index(counter_id, ES_COUNTID_BASE, self.counters.capacity)

    def _counter(self, counter_id: int) -> GenCounter:
        """A counter; for an id that is none cFE has another status here than elsewhere."""
        counter = self.counters.find(counter_id)
        if counter is None:
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"no counter has the id 0x{counter_id:x}")
        return counter
