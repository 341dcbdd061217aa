"""`cfepy run --script`: verdicts in the report, exit statuses, run time, and one trace with every way of observing
it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.cli.conftest import Write

GOOD = "at 1 send CFE_ES_NOOP\nexpect event CFE_ES 3 within 1\nat 2 expect app QUIET RUNNING\n"
BAD = "at 1 expect app NOBODY\nat 2 expect app QUIET RUNNING\n"


@pytest.fixture
def script(tmp_path: Path) -> Path:
    return tmp_path / "checks.txt"


def run(folder: Path, script: Path, text: str, *options: str) -> int:
    script.write_text(text, encoding="utf-8")
    return main(["run", str(folder), "--script", str(script), "--no-console", *options])


def test_a_good_script(make_mission: Write, script: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(make_mission("Quiet"), script, GOOD) == 0
    shown = capsys.readouterr().out
    assert f"ok         1.000000  {script}:1: at 1 send CFE_ES_NOOP\n" in shown
    assert "3 steps, all ok\n" in shown
    assert "2.000 virtual s in " in shown
    assert shown.splitlines()[-2].startswith("trace: ")


def test_a_failed_step_is_the_exit_status(
    make_mission: Write, script: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(make_mission("Quiet"), script, BAD) == 1
    shown = capsys.readouterr().out
    assert f"FAILED     1.000000  {script}:1: at 1 expect app NOBODY: there are CFE_ES, " in shown
    assert f"ok         2.000000  {script}:2: at 2 expect app QUIET RUNNING\n" in shown
    assert "2 steps, 1 failed\n" in shown


def test_only_the_script_counts(make_mission: Write, script: Path) -> None:
    text = 'expect event COMPLAINS 5 ERROR "something is wrong" within 2\n'
    assert run(make_mission("Complains"), script, text) == 0


def test_stop_on_failure(make_mission: Write, script: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(make_mission("Quiet"), script, BAD, "--stop-on-failure", "--for", "5") == 1
    shown = capsys.readouterr().out
    assert "1.000 virtual s in " in shown
    assert f"FAILED     1.000000  {script}:2: at 2 expect app QUIET RUNNING: the run ended earlier" in shown


@pytest.mark.parametrize(("seconds", "status"), [("1.5", 1), ("3", 0)])
def test_a_given_time_is_kept(
    make_mission: Write, script: Path, capsys: pytest.CaptureFixture[str], seconds: str, status: int
) -> None:
    assert run(make_mission("Quiet"), script, GOOD, "--for", seconds) == status
    assert f"{float(seconds):.3f} virtual s in " in capsys.readouterr().out


def test_a_mistake_in_the_script_is_bad_usage(
    make_mission: Write, script: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(make_mission("Quiet"), script, "at 1 send CFE_ES_NOOP\nsned CFE_ES_NOOP\n") == 2
    shown = capsys.readouterr()
    assert shown.err == f"cfepy: {script}:2: invalid step 'sned'; did you mean send?\n"
    assert shown.out == ""


def test_verdicts_in_the_json_file(make_mission: Write, script: Path, tmp_path: Path) -> None:
    file = tmp_path / "numbers.json"
    assert run(make_mission("Quiet"), script, BAD, "--json", str(file)) == 1
    numbers = json.loads(file.read_text(encoding="utf-8"))
    assert numbers["script"]["ok"] is False
    assert [(step["line"], step["ok"], step["at_s"]) for step in numbers["script"]["steps"]] == [
        (1, False, 1.0),
        (2, True, 2.0),
    ]


def test_one_trace_however_it_is_run(
    make_mission: Write, script: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, traces = make_mission("Quiet", "Chatty"), set()
    for options in ((), ("--realtime", "50"), ("--tasks", "thread"), ("--trace", str(tmp_path / "trace.txt"))):
        assert run(folder, script, GOOD, *options) == 0
        traces.add(capsys.readouterr().out.splitlines()[-2])
    assert len(traces) == 1
