"""The mission `sched`: SCH's schedule keeps HK and SAMPLE_APP going, and the ground changes it."""

from __future__ import annotations

import importlib
import sys

import pytest

from apps.sch import packets as sch
from cfepy.cli.main import main
from cfepy.mission import Mission
from cfepy.mission.packet_watch import PacketWatch, Seen
from cfepy.reading.resources import shipped
from cfepy.tbl import build
from cfepy.units import NS_PER_S
from cfepy.writing.console import Console

FOLDER = shipped("missions") / "sched"
COMBINED, SAMPLE_HK = 0x089C, 0x0883


@pytest.mark.parametrize("table", ["sch_def_msgtbl", "sch_def_schtbl"])
def test_table_files_match_their_definitions(table: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(FOLDER))
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    for name in ("sch_def_msgtbl", "sch_def_schtbl"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    assert (FOLDER / f"{table}.tbl").read_bytes() == build(importlib.import_module(table).image())


def test_shipped_tables_are_valid(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tbl", "verify", *(str(path) for path in sorted(FOLDER.glob("*.tbl")))]) == 0
    assert capsys.readouterr().out.count(", good\n") == 2


def test_housekeeping_is_collected_slot_by_slot() -> None:
    seen: list[Seen] = []
    watch = PacketWatch(seen.append, lambda msg_id: msg_id in (COMBINED, SAMPLE_HK))
    with Mission("sched", console=Console(quiet=True), attachments=[watch]) as mission:
        mission.run_for(20)
        assert mission.cfe.evs.errors_by_app == {}
    for msg_id, slot in ((COMBINED, 75), (SAMPLE_HK, 45)):
        times = [each.at_ns for each in seen if each.msg_id == msg_id]
        assert len(times) >= 18
        assert {time % NS_PER_S for time in times} == {slot * NS_PER_S // 100}
    assert all(any(each.packet[16:]) for each in seen if each.msg_id == COMBINED)


def test_group_is_disabled_from_the_ground() -> None:
    seen: list[Seen] = []
    watch = PacketWatch(seen.append, lambda msg_id: msg_id == SAMPLE_HK)
    with Mission("sched", console=Console(quiet=True), attachments=[watch]) as mission:
        mission.run_for(4.5)
        mission.cfe.sb.transmit_msg(sch.DISABLE_GROUP.packet(GroupData=0x10))
        mission.run_for(5)
    assert max(each.at_ns for each in seen) < 5 * NS_PER_S
