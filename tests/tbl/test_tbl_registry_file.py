"""The registry file of a mission with NASA's lab applications, against NASA cFE's own."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from cfepy.mission import Mission
from cfepy.tbl import packets as pk
from cfepy.writing.console import Console
from tests.layouts import DATA
from tests.mission.flights import write_mission

STARTUP = """\
CFE_APP, sample_app,  SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;
CFE_APP, to_lab,  TO_LAB_AppMain,  TO_LAB,     70, 16384, 0x0, 0;
CFE_APP, sch_lab, SCH_LAB_AppMain, SCH_LAB,    80, 16384, 0x0, 0;
CFE_APP, hk,      HK_AppMain,      HK,         90, 16384, 0x0, 0;
!
"""
RECORDED_WITH = 'cfe_version: "7.0.0"'
GOLDEN = (DATA / "cfe_tbl_reg.log").read_bytes()
SIZE = pk.REGISTRY_RECORD.size
OTHER_BYTES = {"HK.CopyTable": {"Crc"}}  # NASA's copies spare bytes; see docs/reference/differences.md


def test_records_are_packed_to_the_byte() -> None:
    for at in range(64, len(GOLDEN), SIZE):
        assert pk.REGISTRY_RECORD.pack(pk.REGISTRY_RECORD.unpack(GOLDEN, at)) == GOLDEN[at : at + SIZE]


def test_registry_file_matches_nasas(tmp_path: Path) -> None:
    with Mission(write_mission(tmp_path, STARTUP, mission_yaml=RECORDED_WITH), console=Console(quiet=True)) as mission:
        mission.run_for(3)
        packet = pk.DUMP_REGISTRY.packet()
        mission.kernel.spawn("ground", partial(mission.cfe.sb.transmit_msg, packet, False), 10)
        mission.run_for(3)
        data = mission.files.read_file("/ram/cfe_tbl_reg.log")
    assert (len(data), data[:24], data[32:64]) == (len(GOLDEN), GOLDEN[:24], GOLDEN[32:64])
    for at in range(64, len(GOLDEN), SIZE):
        ours, theirs = pk.REGISTRY_RECORD.unpack(data, at), pk.REGISTRY_RECORD.unpack(GOLDEN, at)
        different = {name for name in ours if ours[name] != theirs[name]} - {"TimeOfLastUpdate"}
        assert different == OTHER_BYTES.get(theirs["Name"], set()), theirs["Name"]
