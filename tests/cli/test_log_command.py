"""`cfepy log`: its output for files of cFE, and for other files."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.evs.packets import LONG_EVENT
from cfepy.fs import HEADER_SIZE
from cfepy.msg import TLM_HEADER_SIZE
from tests.ground.test_dump_files import EXIT_BIT, perf_file

DATA = Path(__file__).parents[1] / "data"


def test_text(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["log", str(DATA / "cfe_cds_reg.log"), str(DATA / "cfe_es_syslog.log")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == f"{DATA / 'cfe_cds_reg.log'}: critical data store, 'CDS_Registry'"
    assert lines[1] == "  written 1980-012-14:03:46.83914 on 66/1 by 0x00110003"
    assert lines[5].split() == ["0x00150001", "4096", "yes", "CFE_TBL.CritReg"]
    assert lines[8].startswith("1980-001-00:47:57.97927 CFE_ES_SetupResetVariables")


def test_empty_records_are_left_out(capsys: pytest.CaptureFixture[str]) -> None:
    main(["log", str(DATA / "cfe_erlog.log")])
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1] == "  19 empty ones are left out"
    assert len(lines) == 7


def test_json(capsys: pytest.CaptureFixture[str]) -> None:
    names = ["cfe_evs.log", "cfe_es_syslog.log", "cfe_erlog.log"]
    assert main(["log", "--json", "-", *(str(DATA / name) for name in names)]) == 0
    events, log, resets = json.loads(capsys.readouterr().out)
    assert events["kind"] == "event log"
    assert events["header"]["processor_id"] == 1
    assert events["records"][0]["PacketID"]["AppName"] == "CFE_EVS"
    assert len(log["lines"]) == 28
    assert len(resets["records"][0]["Context"]) == 256


def test_performance_data(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "perf.dat"
    path.write_bytes(perf_file((5, 0, 10), (5 | EXIT_BIT, 0, 12), (5, 0, 20), (5 | EXIT_BIT, 0, 24), (6, 0, 30)))
    assert main(["log", str(path)]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["10000.0", "8000.0", "5", "entered"] in rows
    assert ["5", "2", "2000.0", "3000.0", "4000.0", "6000.0", "0", "0"] in rows
    assert ["6", "0", "-", "-", "-", "-", "1", "0"] in rows


def test_performance_data_as_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = tmp_path / "perf.dat", tmp_path / "perf.json"
    inside = ((1, 0, 10), (91, 0, 10), (91 | EXIT_BIT, 0, 10), (1 | EXIT_BIT, 0, 12))
    path.write_bytes(perf_file((7 | EXIT_BIT, 0, 5), *inside, (91, 0, 30)))
    assert main(["log", str(path), "--perfetto", str(out)]) == 0
    assert capsys.readouterr().out == f"{out}: 6 entries; open it in https://ui.perfetto.dev\n"
    trace = json.loads(out.read_text(encoding="utf-8"))
    assert trace["otherData"]["DataCount"] == 6
    events = [event for event in trace["traceEvents"] if event["ph"] != "M"]
    assert [(event["ph"], event["tid"]) for event in events] == [
        *(("i", 7), ("B", 1), ("B", 91), ("E", 91), ("E", 1), ("B", 91), ("E", 91))
    ]
    times = [event["ts"] for event in events]
    assert times == sorted(times)
    assert len({*times}) == len(times), "what happens at one instant is drawn apart"
    assert [event["args"]["virtual_ns"] for event in events[:3]] == [5_000_000, 10_000_000, 10_000_000]
    tracks = {
        event["tid"]: event["args"]["name"] for event in trace["traceEvents"] if event.get("name") == "thread_name"
    }
    assert tracks == {7: "7 CFE_TIME tone interrupt", 1: "1 CFE_ES main", 91: "91"}


def test_what_is_no_performance_data_has_no_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = str(tmp_path / "x.json")
    log = str(DATA / "cfe_es_syslog.log")
    assert main(["log", log, "--perfetto", out]) == 2
    assert "--perfetto: requires performance data; this file is the system log" in capsys.readouterr().err
    assert main(["log", log, log, "--perfetto", out]) == 2
    assert "--perfetto: takes one file, not 2" in capsys.readouterr().err


def test_a_bad_file_does_not_hide_the_good_ones(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cut = tmp_path / "cut.dat"
    cut.write_bytes((DATA / "cfe_sb_msgmap.dat").read_bytes()[:-3])
    good = DATA / "cfe_cds_reg.log"
    assert main(["log", "nowhere", str(cut), str(DATA / "sample_app_tbl.tbl"), str(good)]) == 2
    out, err = capsys.readouterr()
    assert "40 records" in out
    assert "CFE_TBL.CritReg" in out
    cannot_be_read, cut_off, table = err.splitlines()
    assert "nowhere: cannot be read" in cannot_be_read
    assert "is truncated: record 40 has 5 of 8 bytes" in cut_off
    assert "cfepy tbl show" in table


def test_a_record_that_cannot_be_read_ends_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data = bytearray((DATA / "cfe_evs.log").read_bytes())
    size = TLM_HEADER_SIZE + LONG_EVENT.size
    data[HEADER_SIZE + 2 * size] |= 0xE0  # another version of the packet's header
    path = tmp_path / "evs.log"
    path.write_bytes(data)
    assert main(["log", str(path)]) == 2
    out, err = capsys.readouterr()
    assert "2 records" in out
    assert "is damaged: record 2 cannot be read" in err


def test_bytes_that_are_no_text_are_shown_as_escapes(tmp_path: Path) -> None:
    data = bytearray((DATA / "cfe_cds_reg.log").read_bytes())
    at = data.index(b"CFE_TBL.CritReg")
    data[at] = 0xFF
    path = tmp_path / "cds.log"
    path.write_bytes(data)
    command = [sys.executable, "-m", "cfepy", "log", str(path)]
    done = subprocess.run(command, env=os.environ | {"PYTHONIOENCODING": "utf-8:strict"}, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert b"\\xffFE_TBL.CritReg" in done.stdout
