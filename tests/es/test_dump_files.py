"""The files of Executive Services equal those of NASA's build (tests/data/cfe_*.log)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.es import packets as pk
from cfepy.fs import HEADER_SIZE, read_header
from cfepy.msg import Command, Layout
from tests.es.harness import Lab
from tests.layouts import DATA

RECORDS = [
    ("cfe_es_app_info.log", pk.APP_INFO, pk.QUERY_ALL),
    ("cfe_es_taskinfo.log", pk.TASK_INFO, pk.QUERY_ALL_TASKS),
    ("cfe_erlog.log", pk.ER_LOG_FILE_ENTRY, pk.WRITE_ER_LOG),
    ("cfe_cds_reg.log", pk.CDS_REG_DUMP_RECORD, pk.DUMP_CDS_REGISTRY),
]


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[Lab]:
    lab = Lab(tmp_path)
    yield lab
    lab.mission.close()


def records(data: bytes, layout: Layout) -> list[dict[str, Any]]:
    assert (len(data) - HEADER_SIZE) % layout.size == 0
    return [layout.unpack(data, at) for at in range(HEADER_SIZE, len(data), layout.size)]


def ours(lab: Lab, command: Command, name: str) -> bytes:
    lab.cfe.sb.transmit_msg(command.packet())
    lab.mission.run_for(3)
    return lab.mission.files.read_file(f"/ram/{name}")


@pytest.mark.parametrize(("name", "layout", "command"), RECORDS)
def test_nasas_records_are_unpacked_and_packed_again(name: str, layout: Layout, command: Command) -> None:
    data = (DATA / name).read_bytes()
    found = records(data, layout)
    assert found
    assert b"".join(layout.pack(record) for record in found) == data[HEADER_SIZE:]


@pytest.mark.parametrize(
    ("name", "command"), [*((name, command) for name, _, command in RECORDS), ("cfe_es_syslog.log", pk.WRITE_SYS_LOG)]
)
def test_headers_match_nasas(lab: Lab, name: str, command: Command) -> None:
    theirs, mine = read_header((DATA / name).read_bytes()), read_header(ours(lab, command, name))
    assert (mine.description, mine.subtype, mine.length) == (theirs.description, theirs.subtype, theirs.length)
    assert (mine.spacecraft_id, mine.processor_id) == (theirs.spacecraft_id, theirs.processor_id)
    assert mine.application_id == theirs.application_id  # CFE_ES


def test_records_of_core_applications_match_nasas(lab: Lab) -> None:
    name, layout, command = RECORDS[0]
    theirs = records((DATA / name).read_bytes(), layout)[:5]
    mine = records(ours(lab, command, name), layout)
    for record in (*theirs, *mine):
        record["ExecutionCounter"] = 0
    assert [_without_ids(record) for record in mine] == [_without_ids(record) for record in theirs]


def test_records_of_core_tasks_match_nasas(lab: Lab) -> None:
    name, layout, command = RECORDS[1]
    core = {"CFE_EVS", "CFE_SB", "CFE_ES", "CFE_TIME", "CFE_TBL"}
    theirs = [each for each in records((DATA / name).read_bytes(), layout) if each["AppName"] in core]
    mine = records(ours(lab, command, name), layout)
    for record in (*theirs, *mine):
        record["ExecutionCounter"] = 0
    assert [_without_ids(record) for record in mine] == [_without_ids(record) for record in theirs]


def _without_ids(record: dict[str, Any]) -> dict[str, Any]:
    return {field: value for field, value in record.items() if not field.endswith("Id")}


def test_record_of_the_power_on_matches_nasas(lab: Lab) -> None:
    name, layout, command = RECORDS[2]
    theirs, mine = records((DATA / name).read_bytes(), layout), records(ours(lab, command, name), layout)
    for record in (theirs[0], mine[0]):
        del record["BaseInfo"]["TimeCode"]
    assert mine == theirs
    assert len(mine) == 20


def test_system_log_begins_like_nasas(lab: Lab) -> None:
    theirs = (DATA / "cfe_es_syslog.log").read_bytes()[HEADER_SIZE:].splitlines()
    mine = ours(lab, pk.WRITE_SYS_LOG, "cfe_es_syslog.log")[HEADER_SIZE:].splitlines()
    assert [line[24:] for line in mine[:6]] == [line[24:] for line in theirs[:6]]
