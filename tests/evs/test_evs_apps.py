"""The flood brake, the filters and the event log alone, against their promises for any sequence of events."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from cfepy.evs.apps import Filters, Squelch
from cfepy.evs.log import DISCARD, OVERWRITE, EventLog

BURST, PER_SECOND = 32, 15
MS = 1_000_000


@given(st.lists(st.integers(0, 500), max_size=300))
def test_the_brake_lets_a_burst_and_the_rate_through_and_no_more(pauses_ms: list[int]) -> None:
    brake = Squelch(BURST, PER_SECOND)
    now = admitted = announced = 0
    for pause in pauses_ms:
        now += pause * MS
        passed, tells = brake.admit(now)
        admitted += passed
        announced += tells
        assert not (passed and tells)
        assert -BURST * 1000 <= brake.tokens <= BURST * 1000
    assert admitted <= BURST + now * PER_SECOND // (1000 * MS) + 1
    assert admitted + brake.dropped == len(pauses_ms) or brake.dropped == 255
    assert announced <= brake.dropped


@given(st.lists(st.integers(67, 500), max_size=100))
def test_the_brake_never_stops_events_that_keep_to_the_rate(pauses_ms: list[int]) -> None:
    brake = Squelch(BURST, PER_SECOND)
    now = 0
    for pause in pauses_ms:
        now += pause * MS
        assert brake.admit(now) == (True, False)


@given(st.lists(st.tuples(st.sampled_from("+-"), st.integers(0, 12)), max_size=60))
def test_filter_is_found_until_it_is_deleted(steps: list[tuple[str, int]]) -> None:
    filters, model = Filters(8), set[int]()
    for step, event_id in steps:
        slot = filters.find(event_id)
        assert (slot is not None) == (event_id in model)
        if step == "-" and slot is not None:
            filters.remove(slot)
            model.discard(event_id)
        elif step == "+" and slot is None:
            assert filters.add(event_id, 1) == (len(model) < 8)
            model |= {event_id} if len(model) < 8 else set()
    assert {slot.event_id for slot in filters.slots} - {0xFFFF} == model


def test_of_two_filters_for_an_event_the_first_counts() -> None:
    found = Filters(8, [(5, 1), (5, 2)]).find(5)
    assert found is not None
    assert found.mask == 1


@given(st.integers(0, 70), st.sampled_from([OVERWRITE, DISCARD]))
def test_full_log_keeps_the_first_or_the_last_events(events: int, mode: int) -> None:
    log = EventLog(20, mode)
    packets = [bytes([number]) for number in range(events)]
    for packet in packets:
        log.add(packet)
    assert log.entries() == (packets[:20] if mode == DISCARD else packets[-20:])
    assert log.overflow == max(0, events - 20)
    assert log.is_full == (events >= 20)
