"""Spacecraft and processor ids given to a run, in place of the mission's own."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import cfepy
from apps.to_lab.packets import OUTPUT_ENABLE
from cfepy.cli.main import main
from cfepy.es.packets import RESTART
from cfepy.evs.packets import LONG_EVENT_MSG
from cfepy.ground.link import GroundLink
from cfepy.journal import record
from cfepy.mission import Mission
from cfepy.pilot import RunPlan
from cfepy.status import UsageError
from cfepy.writing.console import Console
from tests.journal.replays import assert_replays
from tests.mission.flights import write_mission

LAB = """
    CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;
    CFE_APP, to_lab, TO_LAB_AppMain, TO_LAB, 70, 16384, 0x0, 0;
    !
"""
REAL_LINES = """\
CFE_PSP: CPU ID: 2
CFE_PSP: Spacecraft ID: 67
CFE_PSP: Default Reset SubType = 1
CFE_PSP: Default CPU Name: cpu1
"""
"""What NASA's core-cpu1 (7.0.0) prints first with `--cpuid 2 --scid 67`."""


def booted(folder: Path, mission_file: str = "", **ids: int) -> Mission:
    (folder / "mission.yaml").write_text(mission_file, encoding="utf-8")
    spec = RunPlan((str(write_mission(folder, LAB)),), **ids).spec()  # type: ignore[arg-type]  # ids are all integers
    mission = Mission(spec, console=Console(quiet=True))
    mission.run_for(1)
    return mission


def test_psp_prints_given_ids_as_nasas_psp(tmp_path: Path) -> None:
    with booted(tmp_path, spacecraft_id=67, processor_id=2) as mission:
        assert "\n".join(mission.console.lines).startswith(REAL_LINES)
        psp, os = mission.cfe.psp, mission.cfe.os
        assert (psp.get_spacecraft_id(), psp.get_processor_id(), os.network_get_id()) == (67, 2, 2)
        assert os.bsp_get_argv() == ("core-cpu1", "--cpuid", "2", "--scid", "67")


def test_events_have_the_given_ids_and_ci_lab_its_own_port(tmp_path: Path) -> None:
    with booted(tmp_path, spacecraft_id=67, processor_id=3) as mission, GroundLink(mission) as ground:
        assert any(line.endswith("CI_LAB listening on UDP port: 1236") for line in mission.console.lines)
        assert any(" 67/3/CI_LAB 3: " in line for line in mission.console.lines)
        assert ground.send(OUTPUT_ENABLE.packet(dest_IP="127.0.0.1"), 1236)
        mission.run_for(2)
        event = next(packet for _, packet in ground.received() if packet.startswith(b"\x08\x08"))
        source = LONG_EVENT_MSG.read(event)["PacketID"]
        assert (source["SpacecraftID"], source["ProcessorID"]) == (67, 3)


def test_port_of_ci_lab_has_16_bits(tmp_path: Path) -> None:
    with booted(tmp_path, processor_id=70_000) as mission:
        assert any(line.endswith(f"CI_LAB listening on UDP port: {71_233 - 65_536}") for line in mission.console.lines)


def test_mission_file_sets_the_default_ids(tmp_path: Path) -> None:
    limits = "limits: {spacecraft_id: 70, processor_id: 2, processor_name: cpu2}"
    with booted(tmp_path, limits, processor_id=4) as mission:
        lines = mission.console.lines
        assert lines[:4] == [
            "CFE_PSP: CPU ID: 4",
            "CFE_PSP: Default Reset SubType = 1",
            "CFE_PSP: Default Spacecraft ID = 70",
            "CFE_PSP: Default CPU Name: cpu2",
        ]


def test_id_is_not_limited_by_a_board(tmp_path: Path) -> None:
    (tmp_path / "numbered.yaml").write_text(
        "name: numbered\nlimits: {spacecraft_id: 5, processor_id: 7}\n", encoding="utf-8"
    )
    said = "board: numbered.yaml\nlimits: {spacecraft_id: 4294967295, processor_id: 0}\n"
    with booted(tmp_path, said) as mission:
        assert (mission.config.spacecraft_id, mission.config.processor_id) == (0xFFFF_FFFF, 0)


def test_given_ids_survive_a_reset(tmp_path: Path) -> None:
    with booted(tmp_path, spacecraft_id=67) as mission:
        before = len(mission.console.lines)
        mission.cfe.sb.transmit_msg(RESTART.packet(RestartType=1), is_origination=False)
        mission.run_for(2)
        assert any(" 67/1/CI_LAB 3: " in line for line in mission.console.lines[before:])


@pytest.mark.slow
def test_given_ids_are_part_of_the_plan_and_the_journal(tmp_path: Path) -> None:
    plan = RunPlan(("lab",), seconds=1, spacecraft_id=67, processor_id=2)
    assert plan.command_line() == "cfepy run --for 1 --processor-id 2 --spacecraft-id 67 lab"
    flown = assert_replays(plan, tmp_path)
    assert flown.trace != record(RunPlan(("lab",), seconds=1), tmp_path / "own.cfepy").trace


@pytest.mark.parametrize("number", [-1, 1 << 32, "67"])
def test_an_id_has_32_bits(number: object) -> None:
    with pytest.raises(UsageError, match=r"--spacecraft-id: must be a number from 0 to 4294967295, not "):
        cfepy.boot("lab", spacecraft_id=number)  # type: ignore[arg-type]  # it is to be refused


def test_given_ids_are_options_of_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "lab", "--for", "1", "--spacecraft-id", "0x43"]) == 0
    assert re.search(r"^EVS Port1 \S+ 67/1/TO_LAB 1: ", capsys.readouterr().out, re.MULTILINE)
    assert main(["run", "lab", "--spacecraft-id", "-1"]) == 2
    assert "--spacecraft-id: must be a number from 0 to 4294967295, not -1" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["run", "lab", "--processor-id", "two"])
    assert "--processor-id: invalid number 'two'; expected a whole number such as 67 or 0x43" in capsys.readouterr().err


def test_two_spacecraft_in_one_process_are_independent() -> None:
    """Each with a clock and a network of its own, and the trace that it has alone."""
    with cfepy.boot("lab", spacecraft_id=66) as first, cfepy.boot("lab", spacecraft_id=67) as second:
        for _ in range(4):
            first.run_for(0.5)
            second.run_for(0.5)
        second.send("SAMPLE_APP_NOOP")
        second.expect_event("SAMPLE_APP", 3)
        first.expect_no_event("SAMPLE_APP", 3, within=1)
        assert any(" 67/1/SAMPLE_APP 3: " in line for line in second.mission.console.lines)
        assert not any(" 67/1/" in line for line in first.mission.console.lines)
