"""SCH's tables: the shipped ones, how to make them, and when they are refused."""

from __future__ import annotations

import pytest

from apps.sch import TABLES, packets
from apps.sch.definition import activity, message_image, schedule_image
from apps.sch.state import judge_messages, judge_schedule
from apps.sch.tables import sch_def_msgtbl, sch_def_schtbl
from cfepy.msg import get_msg_id, init
from cfepy.status import UsageError
from cfepy.tbl import build
from tests.apps.conftest import APPS


@pytest.mark.parametrize("module", [sch_def_schtbl, sch_def_msgtbl], ids=["schedule", "messages"])
def test_shipped_tables_match_their_definitions(module: object) -> None:
    name = str(module.__name__).rpartition(".")[2]  # type: ignore[attr-defined]
    assert (APPS / f"sch/tables/{name}.tbl").read_bytes() == build(module.image())  # type: ignore[attr-defined]


def test_sizes_are_nasas() -> None:
    assert [(kind.name, kind.size) for kind in TABLES] == [("SCH.SCHED_DEF", 6000), ("SCH.MSG_DEFS", 16384)]
    assert packets.SCHEDULE_ENTRY.size == 12
    assert (packets.HOUSEKEEPING.size, packets.DIAGNOSTICS.offsets["MsgIDs"]) == (52, 128)


def test_default_tables_are_good() -> None:
    schedule, messages = judge_schedule(sch_def_schtbl.image().data), judge_messages(sch_def_msgtbl.image().data)
    assert (schedule.status, schedule.counts) == (0, "good[6] bad[0] unused[494]")
    assert (messages.status, messages.counts) == (0, "good[6] bad[0] unused[122]")


def test_default_schedule_asks_for_housekeeping_of_the_core() -> None:
    messages = packets.MESSAGE_TABLE.unpack(sch_def_msgtbl.image().data)
    slots = packets.SCHEDULE_TABLE.unpack(sch_def_schtbl.image().data)
    asked = {
        number: get_msg_id(bytes(messages[slot["Entries"][0]["MessageIndex"]]["MessageBuffer"]))
        for number, slot in enumerate(slots)
        if slot["Entries"][0]["EnableState"]
    }
    assert asked == {3: 0x1809, 13: 0x180B, 23: 0x180D, 33: 0x180C, 43: 0x1808, 49: 0x1896}


@pytest.mark.parametrize(
    ("changes", "status", "fault"),
    [
        ({"EnableState": 0}, -1, "ena[0] typ[1] fre[4] rem[1] msg[3] grp[0x01000021]"),
        ({"Frequency": 0}, -2, "ena[1] typ[1] fre[0] rem[1] msg[3] grp[0x01000021]"),
        ({"Remainder": 4}, -3, "ena[1] typ[1] fre[4] rem[4] msg[3] grp[0x01000021]"),
        ({"Type": 2}, -4, "ena[1] typ[2] fre[4] rem[1] msg[3] grp[0x01000021]"),
        ({"MessageIndex": 0}, -5, "ena[1] typ[1] fre[4] rem[1] msg[0] grp[0x01000021]"),
        ({"MessageIndex": 128}, -5, "ena[1] typ[1] fre[4] rem[1] msg[128] grp[0x01000021]"),
        ({"EnableState": 3}, -6, "ena[3] typ[1] fre[4] rem[1] msg[3] grp[0x01000021]"),
    ],
)
def test_bad_schedule_entries(changes: dict[str, int], status: int, fault: str) -> None:
    good = activity(3, 4, 1, 0x01000021)
    verdict = judge_schedule(schedule_image({1: [good, {**good, **changes}], 2: [{**good, "Type": 9}]}).data)
    assert (verdict.status, verdict.fault) == (status, f"idx[6] {fault}")
    assert (verdict.good, verdict.bad, verdict.unused) == (1, 2, 497)


def changed_message(at: int, value: int) -> bytes:
    message = bytearray(init(0x1808, 10))
    message[at] = value
    return bytes(message)


@pytest.mark.parametrize(
    ("message", "status", "fault"),
    [
        (changed_message(5, 4), -2, "mid[0x1808] len[11] buf[0]"),
        (changed_message(5, 122), -2, "mid[0x1808] len[129] buf[0]"),
        (changed_message(4, 1), -2, "mid[0x1808] len[266] buf[0]"),
        (changed_message(5, 0), -2, "mid[0x1808] len[7] buf[0]"),
        (changed_message(0, 0x20), -3, "mid[0x2008] len[10] buf[0]"),
        (bytes(init(0x1897, 10)) + b"\1", -1, "mid[0x1897] len[10] buf[0]"),
    ],
)
def test_bad_messages(message: bytes, status: int, fault: str) -> None:
    verdict = judge_messages(message_image({2: init(0x1808, 8), 9: message, 10: changed_message(5, 0)}).data)
    assert (verdict.status, verdict.fault) == (status, f"idx[9] {fault}")
    assert (verdict.good, verdict.bad, verdict.unused) == (1, 2, 125)


def test_the_longest_message_is_good() -> None:
    assert judge_messages(message_image({1: init(0x1808, 128)}).data).status == 0


def test_invalid_table_definitions_are_refused() -> None:
    with pytest.raises(UsageError, match="100"):
        schedule_image({100: [activity(1)]})
    with pytest.raises(UsageError, match="at most 5 items"):
        schedule_image({0: [activity(1)] * 6})
    with pytest.raises(UsageError, match="begin with 1"):
        message_image({0: init(0x1808, 8)})
    with pytest.raises(UsageError, match="unknown message 128"):
        message_image({128: init(0x1808, 8)})
    with pytest.raises(UsageError, match="at most 128 items"):
        message_image({1: bytes(129)})
