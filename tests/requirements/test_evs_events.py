"""Event Services, requirement by requirement: from an application's call to the packet (cEVS3100 to 3107, 3220)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy.evs import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.evs import packets as pk
from cfepy.status import CFE_EVS_APP_NOT_REGISTERED, CFE_EVS_APP_SQUELCHED, CFE_SUCCESS, CfeError
from tests.requirements.covers import covers
from tests.requirements.flight import Flight
from tests.requirements.test_evs import NAME, Fly, housekeeping, of_app, register, say

CREDIT_S = 3.0
"""Long enough for the flood brake to fill its bucket of 32 events again, at 15 a second."""


@pytest.fixture
def flight(fly: Fly) -> Flight:
    return fly(pk.HK_TLM_MID)


@covers("cEVS3100", "cEVS3100.1", "cEVS3100.2", "cEVS3100.3")
def test_cEVS3100_registration(flight: Flight) -> None:
    say(flight)
    flight.send(pk.DISABLE_APP_EVENTS, **NAME)
    flight.send(pk.ENABLE_APP_EVENT_TYPE, BitMask=0x0F, **NAME)
    register(flight, (5, 0xFFFE), (6, 0x0001))
    row = of_app(flight)
    assert (row["AppEnableStatus"], row["AppMessageSentCounter"]) == (1, 0)
    assert [len(say(flight, event_id=5)) for _ in range(4)] == [1, 1, 0, 0]
    assert [len(say(flight, event_id=6)) for _ in range(4)] == [1, 0, 1, 0]
    assert (len(say(flight, DEBUG, 7)), len(say(flight, ERROR, 7))) == (0, 1)
    flight.send(pk.WRITE_APP_DATA_FILE)
    record = pk.APP_DATA_RECORD.unpack(flight.mission.files.read_file("/ram/cfe_evs_app.dat"), 64 + 5 * 92)
    slots = [(slot["EventID"], slot["Mask"]) for slot in record["Filters"][:3]]
    assert slots == [(5, 0xFFFE), (6, 0x0001), (0xFFFF, 0)]


def test_cEVS3103_three_conditions(flight: Flight) -> None:
    register(flight, (5, 0xFFFF))
    assert len(say(flight)) == 1
    assert say(flight) == []  # the filter
    assert len(say(flight, event_id=6)) == 1
    flight.send(pk.DISABLE_APP_EVENT_TYPE, BitMask=0x02, **NAME)
    assert say(flight, event_id=6) == []  # the type
    assert len(say(flight, ERROR, 6)) == 1
    flight.send(pk.DISABLE_APP_EVENTS, **NAME)
    assert say(flight, ERROR, 6) == []  # all of the application


def test_cEVS3103_1_unregistered_application(flight: Flight) -> None:
    for _ in range(2):
        with pytest.raises(CfeError) as caught:
            flight.call(lambda: flight.cfe.evs.send_info(1, "x"), app="MUTE")
        assert caught.value.status == CFE_EVS_APP_NOT_REGISTERED
    assert flight.events() == []  # event 41 has the event types of its sender, which has none, as in NASA's code
    assert housekeeping(flight)["UnregisteredAppCounter"] == 1


def test_cEVS3103_2_data_types(flight: Flight) -> None:
    values = (-128, 255, -32768, 65535, -(2**31), 2**32 - 1)
    flight.call(lambda: flight.cfe.evs.send(1, INFORMATION, "%d %u %hd %hu %ld %lu", *values))
    assert flight.events()[0].text == "-128 255 -32768 65535 -2147483648 4294967295"


@covers("cEVS3103.3", "cEVS3103.3.1")
def test_cEVS3103_3_filter_counter(flight: Flight) -> None:
    register(flight, (5, 0x0001))

    def counted() -> int:
        flight.send(pk.WRITE_APP_DATA_FILE)
        data = flight.mission.files.read_file("/ram/cfe_evs_app.dat")
        count: int = pk.APP_DATA_RECORD.unpack(data, 64 + 5 * 92)["Filters"][0]["Count"]
        return count

    say(flight)
    say(flight)
    assert counted() == 2
    flight.send(pk.SET_FILTER, EventID=5, Mask=0xFFFF, **NAME)
    flight.packets.clear()
    flight.call(lambda: [flight.cfe.evs.send_info(5, "again") for _ in range(65533)])
    locked = "Max filter count reached, AppName = PROBE, EventID = 0x00000005: Filter locked until reset"
    assert flight.events() == [("CFE_EVS", 42, INFORMATION, locked)]
    assert counted() == 65535
    say(flight)
    assert counted() == 65535


def test_cEVS3103_4_long_format(flight: Flight) -> None:
    flight.send(pk.CLEAR_LOG)
    assert say(flight, CRITICAL, 77, "what happened") == [("PROBE", 77, CRITICAL, "what happened")]
    (fields,) = flight.all(pk.LONG_EVENT_MSG)
    assert (fields["PacketID"]["SpacecraftID"], fields["PacketID"]["ProcessorID"]) == (66, 1)
    packet = flight.packets[0]
    assert len(packet) == 172
    assert int.from_bytes(packet[6:10], "big") == flight.cfe.time.get_time().seconds
    flight.send(pk.WRITE_LOG_DATA_FILE)
    logged = flight.mission.files.read_file("/ram/cfe_evs.log")[64:]
    assert (len(logged), logged[6:10], logged[12:]) == (172, packet[6:10], packet[12:])


def test_cEVS3103_4_1_truncation(flight: Flight) -> None:
    (event,) = say(flight, text="x" * 122)
    assert event.text == "x" * 120 + "$"
    assert flight.packets[0][48 + 121] == 0
    assert housekeeping(flight)["MessageTruncCounter"] == 1


def test_cEVS3103_6_event_is_sent_in_the_name_of_another_application(flight: Flight) -> None:
    tbl = flight.cfe.es.get_app_id_by_name("CFE_TBL")
    flight.call(lambda: flight.cfe.evs.send_event_with_app_id(3, ERROR, tbl, "for TBL"))
    assert flight.events() == [("CFE_TBL", 3, ERROR, "for TBL")]


def test_cEVS3103_7_with_another_time(flight: Flight) -> None:
    flight.send(pk.CLEAR_LOG)
    flight.call(lambda: flight.cfe.evs.send_timed_event((1000, 0x40000000), 3, ERROR, "long ago"))
    assert flight.mission.console.lines[-1] == "EVS Port1 1980-001-00:16:40.25000 66/1/PROBE 3: long ago"
    flight.send(pk.WRITE_LOG_DATA_FILE)
    assert flight.mission.files.read_file("/ram/cfe_evs.log")[70:76].hex() == "000003e84000"


@covers("cEVS3104", "cEVS3105")
def test_cEVS3104_sent_counters(flight: Flight) -> None:
    flight.send(pk.RESET_COUNTERS)
    say(flight)
    say(flight, DEBUG)
    say(flight, ERROR)
    assert of_app(flight)["AppMessageSentCounter"] == 2
    flight.send(pk.NOOP)
    assert housekeeping(flight)["MessageSendCounter"] == 3


@pytest.mark.slow
@covers("cEVS3104.1", "cEVS3105.1")
def test_cEVS3104_1_sent_counters_stay_at_their_maximum(fly: Fly) -> None:
    flight = fly(pk.HK_TLM_MID, evs_max_app_event_burst=100_000)
    flight.send(pk.DISABLE_PORTS, BitMask=0x0F)
    flight.send(pk.RESET_COUNTERS)
    sending = flight.call(lambda: {flight.cfe.evs.send_info(5, "again") for _ in range(65534)})
    assert sending == {CFE_SUCCESS}
    assert (of_app(flight)["AppMessageSentCounter"], housekeeping(flight)["MessageSendCounter"]) == (65534, 65534)
    for _ in range(3):
        say(flight)
    assert (of_app(flight)["AppMessageSentCounter"], housekeeping(flight)["MessageSendCounter"]) == (65535, 65535)


@pytest.mark.parametrize(
    ("reset", "passed"), [(lambda evs: evs.reset_filter(5), (1, 0)), (lambda evs: evs.reset_all_filters(), (1, 1))]
)
@covers("cEVS3106", "cEVS3107")
def test_cEVS3106_an_application_resets_its_filters(
    flight: Flight, reset: Callable[[object], object], passed: tuple[int, int]
) -> None:
    register(flight, (5, 0xFFFF), (6, 0xFFFF))
    for event_id in (5, 6):
        assert [len(say(flight, event_id=event_id)) for _ in range(2)] == [1, 0]
    flight.call(lambda: reset(flight.cfe.evs))
    assert (len(say(flight, event_id=5)), len(say(flight, event_id=6))) == passed


def test_cEVS3109_events_are_text_on_every_port_that_is_enabled(flight: Flight) -> None:
    flight.send(pk.ENABLE_PORTS, BitMask=0x0F)
    say(flight, ERROR, 9, "to all")
    time = flight.cfe.time.text()[:17]
    lines = flight.mission.console.lines[-4:]
    assert [line[:27] for line in lines] == [f"EVS Port{port} {time}" for port in (1, 2, 3, 4)]
    assert {line.partition(" 66/1/")[2] for line in lines} == {"PROBE 9: to all"}


# -- floods --------------------------------------------------------------------------------------------------------


def flood(flight: Flight, count: int) -> list[int]:
    """Let PROBE send events at once. Returns the results of the calls."""
    flight.packets.clear()
    return flight.call(lambda: [flight.cfe.evs.send_info(5, "again") for _ in range(count)])


@covers("cEVS3220", "cEVS3220.1", "cEVS3220.5")
def test_cEVS3220_floods_are_cut_after_a_burst(flight: Flight) -> None:
    flight.run_for(CREDIT_S)
    assert flood(flight, 100) == [CFE_SUCCESS] * 32 + [CFE_EVS_APP_SQUELCHED] * 68
    events = flight.events()
    assert len(events) == 33
    assert events[-1] == ("CFE_EVS", 44, ERROR, "Events squelched, AppName = PROBE")


def test_cEVS3220_2_events_are_sent_again_after_the_flood(flight: Flight) -> None:
    flood(flight, 100)
    flight.run_for(2 * CREDIT_S)
    assert flood(flight, 10) == [CFE_SUCCESS] * 10


@covers("cEVS3220.3", "cEVS3220.4")
def test_cEVS3220_3_squelched_events_are_counted_up_to_255(flight: Flight) -> None:
    flight.run_for(CREDIT_S)
    flood(flight, 42)
    assert of_app(flight)["AppMessageSquelchedCounter"] == 10
    flood(flight, 300)
    assert of_app(flight)["AppMessageSquelchedCounter"] == 255
    flight.send(pk.RESET_APP_COUNTER, **NAME)
    assert of_app(flight)["AppMessageSquelchedCounter"] == 0
