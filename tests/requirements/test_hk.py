"""HK, requirement by requirement: commands, collecting, combined packets, housekeeping (HK1000 to HK4000)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from apps.hk import packets as hk
from apps.sch_lab import schedule
from cfepy.evs import DEBUG, ERROR, INFORMATION
from cfepy.evs import packets as evs
from cfepy.msg import TLM_HEADER_SIZE, Command, get_msg_id, telemetry
from cfepy.tbl import build
from cfepy.tbl import packets as tbl
from tests.requirements.covers import covers
from tests.requirements.flight import POWERON_RESET, PROCESSOR_RESET, Event, Flight

Fly = Callable[..., Flight]
APP = "CFE_APP, {0}, HK_AppMain, HK, 65, 16384, 0x0, 0;\n"
SCHEDULER = "CFE_APP, sch_lab, SCH_LAB_AppMain, SCH_LAB, 80, 16384, 0x0, 0;\n"
DISCARDING = """
    from cfepy.apps import hk

    def HK_AppMain(cfe):
        hk.run(cfe, discard_incomplete=True)
"""
FIRST, SECOND, COMBINED, OTHER = 0x0890, 0x0891, 0x089C, 0x089D
ROWS = [(FIRST, 16, COMBINED, 16, 2), (SECOND, 18, COMBINED, 20, 4), (FIRST, 17, OTHER, 16, 1)]
"""(input, its offset, output, its offset, bytes): two packets, with a gap in the first."""


def rows(*entries: tuple[int, int, int, int, int]) -> list[dict[str, int]]:
    return [dict(zip(hk.COPY_TABLE_ENTRY.fields, entry, strict=True)) for entry in entries]


def start(
    fly: Fly,
    module: str = "hk",
    entries: list[tuple[int, int, int, int, int]] = ROWS,
    schedule: bytes | None = None,
    **sources: str,
) -> Flight:
    """Start a mission with HK, whose copy table is the test's, and SCH_LAB, if there is a schedule.

    DEBUG events of HK are received, too.
    """
    tables = {"hk_cpy_tbl.tbl": build(hk.COPY_TABLE.image(rows(*entries)))}
    startup = APP.format(module)
    if schedule is not None:
        tables["sch_lab_table.tbl"] = schedule
        startup += SCHEDULER
    flight = fly(hk.HK_TLM_MID, COMBINED, OTHER, startup=startup, sources=sources, tables=tables, cfe_version="7.0.1")
    flight.send(evs.ENABLE_APP_EVENT_TYPE, AppName="HK", BitMask=0x0F)
    return flight


@pytest.fixture
def flight(fly: Fly) -> Flight:
    return start(fly)


def housekeeping(flight: Flight) -> dict[str, Any]:
    return flight.ask(hk.SEND_HK, hk.HK_TLM)


def feed(flight: Flight, msg_id: int, data: bytes) -> list[Event]:
    """Send telemetry of an application. Returns the resulting events."""
    flight.packets.clear()
    flight.transmit(bytes(telemetry(msg_id, data)))
    return flight.events()


def combined(flight: Flight, msg_id: int = COMBINED) -> tuple[list[bytes], list[Event]]:
    """Request a combined packet. Returns the received payloads, and the events."""
    events = flight.send(hk.SEND_COMBINED_PKT, OutMsgToSend=msg_id)
    return [packet[TLM_HEADER_SIZE:] for packet in flight.packets if get_msg_id(packet) == msg_id], events


def missing(msg_id: int) -> list[Event]:
    text = f"Combined Packet 0x0000089C missing data from Input Pkt 0x{msg_id:08X}"
    return [Event("HK", 12, DEBUG, text)]


COUNTERS = ("CmdCounter", "ErrCounter", "CombinedPacketsSent", "MissingDataCtr")


@covers("HK1000", "HK1003")
def test_HK1000_noop(flight: Flight) -> None:
    assert flight.send(hk.NOOP) == [("HK", 4, INFORMATION, "HK No-op command, Version 7.0.0.0")]
    assert housekeeping(flight)["CmdCounter"] == 1


@covers("HK1001", "HK1003")
def test_HK1001_reset(flight: Flight) -> None:
    flight.send(hk.NOOP)
    flight.send(Command("unknown", hk.CMD_MID, 99))
    combined(flight)
    assert [housekeeping(flight)[name] for name in COUNTERS] == [1, 1, 1, 1]
    assert flight.send(hk.RESET_COUNTERS) == [("HK", 5, INFORMATION, "HK Reset Counters command received")]
    assert [housekeeping(flight)[name] for name in COUNTERS] == [0, 0, 0, 0]


@covers("HK1002", "HK1004")
def test_HK1002_commands_are_rejected(flight: Flight) -> None:
    for code in (hk.NOOP.code, hk.RESET_COUNTERS.code):
        text = f"Cmd Msg with Bad length Rcvd: ID = 0x0000189A, CC = {code}, Exp Len = 8, Len = 12"
        too_long = Command("too long", hk.CMD_MID, code, hk.SEND_COMBINED_PKT_PAYLOAD)
        assert flight.send(too_long) == [("HK", 3, ERROR, text)]
    text = "Cmd Msg with Invalid command code Rcvd -- ID = 0x0000189A, CC = 9"
    assert flight.send(Command("unknown", hk.CMD_MID, 9)) == [("HK", 2, ERROR, text)]
    text = "Msg with Bad length Rcvd: ID = 0x0000189C, Exp Len = 12, Len = 8"
    assert flight.send(Command("too short", hk.SEND_COMBINED_PKT_MID)) == [("HK", 28, ERROR, text)]
    text = "Msg with Bad length Rcvd: ID = 0x0000189B, Exp Len = 8, Len = 12"
    too_long = Command("too long", hk.SEND_HK_MID, 0, hk.SEND_COMBINED_PKT_PAYLOAD)
    assert flight.send(too_long) == [("HK", 28, ERROR, text)]
    assert flight.all(hk.HK_TLM) == []
    values = housekeeping(flight)
    assert (values["CmdCounter"], values["ErrCounter"], values["CombinedPacketsSent"]) == (0, 3, 0)


@covers("HK2000", "HK2001")
def test_HK2000_input_is_collected_and_combined(flight: Flight) -> None:
    assert feed(flight, FIRST, b"ab") == []
    assert feed(flight, SECOND, b"..CDEF") == []
    assert combined(flight) == ([b"ab\0\0CDEF"], [])
    assert combined(flight, OTHER) == ([b"b"], [])
    feed(flight, FIRST, b"xy")
    assert combined(flight) == ([b"xy\0\0CDEF"], missing(SECOND))


def test_HK2001_at_the_scheduled_rate(fly: Fly) -> None:
    """SCH_LAB asks for one packet each second, for the other every two."""
    wishes = [
        (hk.SEND_COMBINED_PKT_MID, period, 0, hk.SEND_COMBINED_PKT_PAYLOAD.pack(OutMsgToSend=msg_id))
        for msg_id, period in ((COMBINED, 1), (OTHER, 2))
    ]
    flight = start(fly, schedule=build(schedule.image(1, wishes)))
    feed(flight, FIRST, b"ab")
    flight.packets.clear()
    flight.run_for(8)
    assert [[get_msg_id(packet) for packet in flight.packets].count(msg_id) for msg_id in (COMBINED, OTHER)] == [8, 4]
    assert {packet[TLM_HEADER_SIZE:] for packet in flight.packets if get_msg_id(packet) == OTHER} == {b"b"}


@pytest.mark.parametrize(
    ("entry", "fault"),
    [
        ((FIRST, 16, COMBINED, 1499, 2), "Invalid output offset+size: 1501 > 1500, mid 0x89c"),
        ((FIRST, 1498, COMBINED, 16, 3), "Invalid input offset+size: 1501 > 1500, mid 0x890"),
        ((0, 16, COMBINED, 16, 1), "Invalid Input MID: 0x0"),
        ((FIRST, 16, 0, 16, 1), "Invalid Output MID: 0x0"),
    ],
)
def test_HK2000_1_an_invalid_copy_table_is_refused(fly: Fly, entry: tuple[int, int, int, int, int], fault: str) -> None:
    """At the start of HK, which then ends, and later, when the table before it stays in use."""
    text = f"HK Validate: {fault} at entry index 1\n"
    begun = start(fly, entries=[ROWS[0], entry])
    assert f"HK 36: {text}" in "\n".join(begun.mission.console.lines) + "\n"
    assert begun.send(hk.NOOP) == []
    flight = start(fly)
    assert ("HK", 36, ERROR, text) in validate_new_table(flight, ROWS[0], entry)
    (refusal,) = flight.send(tbl.ACTIVATE, TableName="HK.CopyTable")
    assert (refusal.app, refusal.event_id, refusal.event_type) == ("CFE_TBL", 81, ERROR)
    flight.run_for(2)
    feed(flight, FIRST, b"ab")
    assert combined(flight, OTHER) == ([b"b"], [])


def validate_new_table(flight: Flight, *entries: tuple[int, int, int, int, int]) -> list[Event]:
    """Load another copy table and let HK validate it. Returns the events."""
    flight.mission.files.write_file("/ram/new.tbl", build(hk.COPY_TABLE.image(rows(*entries))))
    flight.send(tbl.LOAD, LoadFilename="/ram/new.tbl")
    flight.send(tbl.VALIDATE, ActiveTableFlag=0, TableName="HK.CopyTable")
    flight.run_for(2)
    return flight.events()


def test_HK2001_1_a_new_table_changes_the_packets(flight: Flight) -> None:
    feed(flight, FIRST, b"ab")
    validate_new_table(flight, (SECOND, 16, OTHER, 18, 1))
    flight.send(tbl.ACTIVATE, TableName="HK.CopyTable")
    flight.run_for(2)
    assert feed(flight, FIRST, b"ab") == []
    feed(flight, SECOND, b"z")
    assert combined(flight, OTHER) == ([b"\0\0z"], [])
    text = "Combined HK Packet 0x0000089C is not found in current HK Copy Table"
    assert combined(flight) == ([], [("HK", 11, INFORMATION, text)])


@covers("HK2001.2", "HK2001.3")
def test_HK2001_2_old_data_is_sent_again_and_reported(flight: Flight) -> None:
    feed(flight, FIRST, b"ab")
    feed(flight, SECOND, b"..CDEF")
    combined(flight)
    feed(flight, SECOND, b"..GHIJ")
    assert combined(flight) == ([b"ab\0\0GHIJ"], missing(FIRST))
    assert housekeeping(flight)["MissingDataCtr"] == 1


def test_HK2001_5_too_short_input_is_not_used(flight: Flight) -> None:
    feed(flight, FIRST, b"ab")
    feed(flight, SECOND, b"..CDEF")
    assert combined(flight) == ([b"ab\0\0CDEF"], [])
    text = "HK table definition exceeds packet length. MID:0x00000890, Length:16, Count:2"
    assert feed(flight, FIRST, b"") == [("HK", 6, ERROR, text)]
    feed(flight, SECOND, b"..GHIJ")
    assert combined(flight) == ([b"ab\0\0GHIJ"], missing(FIRST))


@pytest.mark.parametrize("late", [b"", b"x"])
@covers("HK2001.6", "HK2001.7")
def test_HK2001_6_incomplete_packets_may_be_discarded(fly: Fly, late: bytes) -> None:
    """Data that is missing, or that is in a packet which is too short."""
    flight = start(fly, "my_hk", my_hk=DISCARDING)
    feed(flight, SECOND, b"..CDEF")
    if late:
        assert len(feed(flight, FIRST, late)) == 1
    assert combined(flight) == ([], missing(FIRST))
    feed(flight, FIRST, b"ab")
    feed(flight, SECOND, b"..CDEF")
    assert combined(flight) == ([b"ab\0\0CDEF"], [])
    values = housekeeping(flight)
    assert (values["CombinedPacketsSent"], values["MissingDataCtr"]) == (1, 1)


@covers("HK3000", "HK4000")
def test_HK3000_housekeeping(flight: Flight) -> None:
    values = housekeeping(flight)
    assert values.pop("MemPoolHandle") >> 16 == 0x14
    assert set(values.values()) == {0}
    assert len(flight.packets[0]) == 28
    flight.send(hk.NOOP)
    flight.send(Command("unknown", hk.CMD_MID, 99))
    feed(flight, FIRST, b"ab")
    combined(flight, OTHER)
    combined(flight)
    values = housekeeping(flight)
    assert (values["CmdCounter"], values["ErrCounter"]) == (1, 1)
    assert (values["CombinedPacketsSent"], values["MissingDataCtr"]) == (2, 1)


@pytest.mark.parametrize("kind", [POWERON_RESET, PROCESSOR_RESET])
def test_HK4000_all_counters_are_zero_after_any_reset(flight: Flight, kind: bytes) -> None:
    flight.send(hk.NOOP)
    flight.send(Command("unknown", hk.CMD_MID, 99))
    combined(flight)
    assert [housekeeping(flight)[name] for name in COUNTERS] == [1, 1, 1, 1]
    flight.reset(kind)
    assert [housekeeping(flight)[name] for name in COUNTERS] == [0, 0, 0, 0]
