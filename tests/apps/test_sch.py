"""SCH in a mission: slots in time, commands, groups, tables from the ground."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from apps.sch import packets as pk
from apps.sch.definition import activity, message_image, schedule_image
from cfepy.mission import Mission
from cfepy.msg import command
from cfepy.tbl import build
from cfepy.tbl import packets as tbl
from cfepy.writing.console import Console
from tests.apps.sch_flight import DEBUG_ON, FIRST, MESSAGES, SECOND, THIRD, Flight, write_mission

COARSE = "13: OS Timer Accuracy (10000 > reqd 101 usec) requires Minor Frame MET sync"
"""What OSAL for Linux says of its timers."""


@pytest.fixture
def flight(tmp_path: Path) -> Iterator[Flight]:
    flight = Flight(write_mission(tmp_path))
    with flight.mission:
        flight.run_to(1)
        yield flight


def test_messages_are_sent_in_their_slots_over_many_seconds(flight: Flight) -> None:
    flight.run_to(40.6)
    seconds = len(flight.times(FIRST))
    assert seconds >= 39
    assert flight.times(FIRST) == [second * 1000.0 for second in range(seconds)]
    odd = [(second * 1000.0 + 250) for second in range(1, seconds, 2)]
    assert flight.times(SECOND) == odd
    assert flight.times(THIRD) == []
    assert flight.events() == [COARSE]


def test_housekeeping(flight: Flight) -> None:
    flight.run_to(10.6)
    values = flight.housekeeping()
    seconds = len(flight.times(pk.HK_TLM_MID))
    assert values["SlotsProcessedCount"] == seconds * 100 - 1  # the last slot is being done
    assert values["ValidMajorFrameCount"] == seconds
    assert (values["MissedMajorFrameCount"], values["UnexpectedMajorFrameCount"]) == (0, 0)
    assert (values["SyncToMET"], values["MajorFrameSource"]) == (1, 1)
    assert (values["TableVerifySuccessCount"], values["TableVerifyFailureCount"]) == (2, 0)
    assert (values["MinorFramesSinceTone"], values["NextSlotNumber"], values["TablePassCount"]) == (99, 99, seconds - 1)
    assert values["ScheduleActivitySuccessCount"] == 2 * seconds + seconds // 2
    assert values["SkippedSlotsCount"] == values["MultipleSlotsCount"] == values["SameSlotCount"] == 0


def test_entries_are_enabled_and_disabled(flight: Flight) -> None:
    entry = partial(pk.ENABLE.packet, SlotNumber=25)
    flight.run_to(3.1)
    flight.send(DEBUG_ON, entry(EntryNumber=1), pk.DISABLE.packet(SlotNumber=0, EntryNumber=0))
    flight.run_to(6.6)
    assert flight.times(THIRD) == [2250.0, 3250.0, 4250.0]  # commands wait for the end of the table
    assert flight.times(FIRST) == [0.0, 1000.0]
    assert flight.seen[-1].msg_id in (pk.HK_TLM_MID, THIRD)
    assert [line for line in flight.events() if line[0] == "4"] == [
        "42: ENABLE command: slot = 25, entry = 1",
        "43: DISABLE command: slot = 0, entry = 0",
    ]
    assert flight.housekeeping()["CmdCounter"] == 2


def test_message_is_sent_unchanged_from_the_table(flight: Flight) -> None:
    flight.send(pk.ENABLE.packet(SlotNumber=25, EntryNumber=1))
    flight.run_to(4.6)
    sent = [seen.packet for seen in flight.seen if seen.msg_id == THIRD]
    assert [(packet[6] & 0x7F, packet[8:]) for packet in sent] == [(5, b"\1\2")] * len(sent)
    assert len(sent) >= 2


@pytest.mark.parametrize(
    ("groups", "found"), [(0x02000000, 2), (0x00000002, 1), (0x00000003, 2), (0x09000001, 1), (0x02FF0000, 2)]
)
def test_groups(flight: Flight, groups: int, found: int) -> None:
    flight.send(DEBUG_ON)
    flight.run_to(2.1)
    flight.send(pk.DISABLE_GROUP.packet(GroupData=groups), pk.ENABLE_GROUP.packet(GroupData=groups))
    flight.run_to(4.6)
    assert f"45: DISABLE GROUP command: match count = {found}" in flight.events()
    assert f"44: ENABLE GROUP command: match count = {found}" in flight.events()


def test_disabled_group_sends_nothing(flight: Flight) -> None:
    flight.send(pk.DISABLE_GROUP.packet(GroupData=0x02000000))
    flight.run_to(6)
    assert flight.times(SECOND) == flight.times(THIRD) == []
    assert len(flight.times(FIRST)) >= 4


def test_diagnostics(flight: Flight) -> None:
    flight.send(pk.SEND_DIAG_TLM.packet())
    flight.run_to(3)
    (packet,) = [seen.packet for seen in flight.seen if seen.msg_id == pk.DIAG_TLM_MID]
    values = pk.DIAG_TLM.read(packet)
    states = "".join(f"{word:016b}" for word in values["EntryStates"])
    used = {
        number: states[2 * number : 2 * number + 2]
        for number in range(500)
        if states[2 * number : 2 * number + 2] != "00"
    }
    assert used == {0: "01", 125: "01", 126: "10", 495: "01"}
    assert {at: msg_id for at, msg_id in enumerate(values["MsgIDs"]) if msg_id} == {
        0: FIRST,
        125: SECOND,
        126: THIRD,
        495: pk.SEND_HK_MID,
    }


def test_invalid_commands_are_counted(flight: Flight) -> None:
    flight.run_to(2.6)
    flight.send(
        pk.NOOP.packet(),
        pk.ENABLE.packet(SlotNumber=100),
        pk.DISABLE.packet(EntryNumber=5),
        pk.ENABLE.packet(SlotNumber=1),
    )
    flight.run_to(3.6)
    flight.send(
        pk.DISABLE.packet(SlotNumber=0, EntryNumber=1),
        pk.ENABLE_GROUP.packet(),
        pk.DISABLE_GROUP.packet(),
        pk.ENABLE_GROUP.packet(GroupData=0x07000010),
    )
    flight.run_to(4.6)
    flight.send(pk.DISABLE_GROUP.packet(GroupData=0x00000010))
    flight.send(command(pk.CMD_MID, 9), command(pk.CMD_MID, 0, b"x"), command(pk.SEND_HK_MID, 0, b"x"))
    flight.run_to(6.6)
    assert flight.events() == [
        COARSE,
        "40: NO-op command. Version 2.2.1.0",
        "50: ENABLE cmd: invalid argument, slot=100 (<100), entry=0 (<5)",
        "52: DISABLE cmd: invalid argument, slot=0 (<100), entry=5 (<5)",
        "51: ENABLE command: invalid state = 0, slot = 1, entry = 0",
        "53: DISABLE command: invalid state = 0, slot = 0, entry = 1",
        "54: ENABLE GROUP command: invalid argument, no groups selected",
        "56: DISABLE GROUP command: invalid argument, no groups selected",
        "55: ENABLE GROUP command: Neither Group 7 nor Multi-Group 0x000010 found",
        "57: DISABLE GROUP command: Neither Group 0 nor Multi-Group 0x000010 found",
        "58: Invalid command code: ID = 0x1895, CC = 9",
        "60: Cmd Msg with Bad length Rcvd: ID = 0x1895, CC = 0, Exp Len = 8, Len = 9",
        "60: Cmd Msg with Bad length Rcvd: ID = 0x1896, CC = 0, Exp Len = 8, Len = 9",
    ]
    values = flight.housekeeping()
    assert (values["CmdCounter"], values["ErrCounter"]) == (1, 10)


def test_counters_are_reset_but_not_the_passes(flight: Flight) -> None:
    flight.run_to(4.6)
    flight.send(DEBUG_ON, pk.RESET.packet())
    flight.run_to(5.6)
    values = flight.housekeeping()
    assert "41: RESET command" in flight.events()
    assert values["TablePassCount"] == 2
    assert (values["SlotsProcessedCount"], values["ValidMajorFrameCount"], values["TableVerifySuccessCount"]) == (
        0,
        0,
        0,
    )


def test_invalid_schedule_from_the_ground_is_refused(flight: Flight) -> None:
    bad = schedule_image({7: [activity(1, 1, 1)]})
    flight.mission.files.write_file("/ram/bad.tbl", build(bad))
    flight.mission.files.write_file("/ram/good.tbl", build(schedule_image({50: [activity(1)], 99: [activity(4)]})))
    validate = tbl.VALIDATE.packet(TableName="SCH.SCHED_DEF")
    flight.run_to(2.6)
    flight.send(tbl.LOAD.packet(LoadFilename="/ram/bad.tbl"), validate)
    flight.run_to(4.6)
    text = "idx[35] ena[1] typ[1] fre[1] rem[1] msg[1] grp[0x00000000]"
    assert flight.events() == [COARSE, f"30: Schedule tbl verify error - {text}"]
    assert flight.housekeeping()["TableVerifyFailureCount"] == 1
    flight.send(tbl.ABORT_LOAD.packet(TableName="SCH.SCHED_DEF"))
    flight.send(tbl.LOAD.packet(LoadFilename="/ram/good.tbl"), validate)
    flight.run_to(6.6)
    flight.send(tbl.ACTIVATE.packet(TableName="SCH.SCHED_DEF"))
    flight.run_to(9.6)
    assert flight.times(FIRST)[-2:] == [500.0 + 1000 * (len(flight.times(FIRST)) - number) for number in (2, 1)]


def test_corrupt_entries_are_disabled(flight: Flight) -> None:
    flight.run_to(2.6)
    registry = flight.mission.cfe.tbl.registry
    active = registry.active(registry.by_name("SCH.SCHED_DEF"))
    assert active is not None
    active.data[2:4] = b"\0\0"  # no frequency in the entry of slot 0
    flight.run_to(5.6)
    assert flight.events() == [
        COARSE,
        "19: Corrupt data error (1): slot = 0, entry = 0",
        "19: Corrupt data error (2): msg = 1, freq = 0, type = 1, rem = 0",
    ]
    assert flight.housekeeping()["BadTableDataCount"] == 1


def test_a_message_that_the_bus_refuses(tmp_path: Path) -> None:
    folder = write_mission(tmp_path)
    (folder / "sch_def_msgtbl.tbl").write_bytes(
        build(message_image({**MESSAGES, 1: bytes.fromhex("0000c0000001") + bytes(2)}))
    )
    flight = Flight(folder)
    with flight.mission:
        flight.run_to(3.995)
    assert flight.events() == [COARSE, *["20: Activity error: slot = 0, entry = 0, err = 0xCA000003"] * 2]
    assert flight.housekeeping()["ScheduleActivityFailureCount"] == 2


def test_threads_and_greenlets_give_one_trace(tmp_path: Path) -> None:
    write_mission(tmp_path)
    digests = set()
    for tasks in ("thread", "greenlet"):
        with Mission(str(tmp_path), tasks=tasks, console=Console(quiet=True)) as mission:
            mission.run_for(5)
            digests.add(mission.trace.digest())
    assert len(digests) == 1
