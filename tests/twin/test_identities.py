"""Spacecraft and processor ids compared with NASA's executable, which has `--scid` and `--cpuid` for them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest

from cfepy.config.platform import IDENTITIES
from cfepy.mission import Mission
from cfepy.pilot import RunPlan
from cfepy.writing.console import Console
from dev.twin.real import VARIABLE, RealCfe, installed
from tests.mission.flights import write_mission

NO_GROUND = (7000, 7001)  # CI_LAB of processor 2 has the port of telemetry
STARTUP = "CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;\n!\n"
SAID = re.compile(r"^CFE_PSP: .*ID.*$|CI_LAB listening on UDP port: \d+$| \d+/\d+/CI_LAB 3: ", re.MULTILINE)


@pytest.mark.slow
@pytest.mark.skipif(installed() is None, reason=f"{VARIABLE} does not name a folder with NASA's core-cpu1")
@pytest.mark.parametrize(
    "ids",
    [
        {},
        {"spacecraft_id": 67},
        {"processor_id": 2, "spacecraft_id": 67},
        {"processor_id": 70_000},
        {"processor_id": 0, "spacecraft_id": 0},
    ],
    ids=str,
)
def test_ids_are_printed_as_by_nasas_executable(ids: Mapping[str, int], tmp_path: Path) -> None:
    built = installed()
    assert built is not None
    words = [word for name, number in ids.items() for word in (IDENTITIES[name], str(number))]
    files = {"/cf/cfe_es_startup.scr": STARTUP.encode()}
    with RealCfe(built, tmp_path / "cfe", files, NO_GROUND, words) as real:
        theirs = SAID.findall(real.console().decode(errors="replace"))
    plan = RunPlan((write_mission(tmp_path, STARTUP),), **ids)  # type: ignore[arg-type]  # ids are all integers
    with Mission(plan.spec(), console=Console(quiet=True)) as mission:
        mission.run_for(1)
        ours = SAID.findall("\n".join(mission.console.lines))
    assert [line for line in theirs if "module" not in line] == [line for line in ours if "module" not in line]
