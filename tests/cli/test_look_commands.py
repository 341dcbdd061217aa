"""`cfepy trace` and `cfepy report`: of a replayed journal, and of a mission that they fly."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.cli.conftest import Write
from tests.extra.reports.looked_at import busy_mission

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def journal(make_mission: Write, tmp_path: Path, capsys: Capture) -> Path:
    """The journal of a run of 2 virtual seconds."""
    file = tmp_path / "run.cfepy"
    assert main(["run", str(make_mission("Quiet", "Chatty")), "--for", "2", "--no-console", "--record", str(file)]) == 0
    capsys.readouterr()
    return file


def test_the_trace_of_a_journal_is_that_of_its_run(
    journal: Path, make_mission: Write, tmp_path: Path, capsys: Capture
) -> None:
    assert main(["trace", str(journal)]) == 0
    printed = capsys.readouterr().out
    mission, file = str(make_mission("Quiet", "Chatty")), tmp_path / "trace.txt"
    assert main(["run", mission, "--for", "2", "--no-console", "--trace", str(file)]) == 0
    assert printed == file.read_text(encoding="utf-8")
    capsys.readouterr()
    assert main(["trace", mission, "--for", "2"]) == 0
    assert capsys.readouterr().out == printed


def test_the_trace_is_filtered_by_time_task_and_topic(journal: Path, capsys: Capture) -> None:
    assert main(["trace", str(journal), "--from", "1", "--until", "1.5", "--topic", "0x089*"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 5
    assert all(re.fullmatch(r"1\.\d{9} CHATTY send 0x0890 sequence \d+ length \d+", line) for line in lines)
    assert main(["trace", str(journal), "--task", "QUI*", "--task", "CFE_TIME"]) == 0
    assert {line.split()[1] for line in capsys.readouterr().out.splitlines()} == {"QUIET", "CFE_TIME"}
    assert main(["trace", str(journal), "--topic", "/nobody"]) == 0
    out, error = capsys.readouterr()
    assert out == ""
    assert "no matching record in the trace" in error


def test_a_ros_topic_is_named(tmp_path: Path, capsys: Capture) -> None:
    assert main(["trace", busy_mission(tmp_path), "--for", "2", "--topic", "/ch*"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) > 5
    assert all(" TALK send " in line and " /chat sequence " in line for line in lines)


def test_a_trace_for_perfetto(journal: Path, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "out.json"
    assert main(["trace", str(journal), "--perfetto", str(file)]) == 0
    assert "ui.perfetto.dev" in capsys.readouterr().out
    written = json.loads(file.read_text(encoding="utf-8"))
    assert written["displayTimeUnit"] == "ns"
    assert written["otherData"]["mission"] == "mission"
    assert {"B", "E", "X", "M", "i"} <= {event["ph"] for event in written["traceEvents"]}


def test_the_page_of_a_journal(journal: Path, tmp_path: Path, capsys: Capture) -> None:
    page = tmp_path / "page.html"
    assert main(["report", str(journal), "-o", str(page)]) == 0
    assert str(page) in capsys.readouterr().out
    text = page.read_text(encoding="utf-8")
    assert f"cfepy replay {journal}" in text
    assert 'data-path="topics.0.sent"' in text


def test_the_page_of_a_mission_tells_the_command_for_the_same_run(
    make_mission: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    words = ["mission", "--for", "2", "--seed", "4", "--schedule", "random", "--board", "rx64m"]
    make_mission("Quiet", "Dies")
    assert main(["report", *words]) == 0
    text = Path("report.html").read_text(encoding="utf-8")
    assert "cfepy run --for 2 --seed 4 --board rx64m --schedule random:4" in text
    assert "died: ValueError: boom" in text


def test_a_replay_that_is_another_run_is_told(journal: Path, tmp_path: Path, capsys: Capture) -> None:
    code = tmp_path / "mission"
    for file in code.glob("*.py"):
        file.write_text(file.read_text(encoding="utf-8").replace("task_delay(100)", "task_delay(90)"), encoding="utf-8")
    page = tmp_path / "page.html"
    assert main(["report", str(journal), "--from-disk", "-o", str(page)]) == 1
    assert "not the run of" in capsys.readouterr().err
    assert "not the run of" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (
            ["trace", "JOURNAL", "--seed", "3"],
            "--seed: only valid for a mission; the journal JOURNAL contains this setting",
        ),
        (["report", "JOURNAL", "--for", "3"], "--for: only valid for a mission; the journal JOURNAL"),
        (["trace", "MISSION", "--from-disk"], "--from-disk: only valid for a journal"),
        (["trace", "MISSION", "--perfetto", "x.json", "--from", "1"], "--from: cannot be combined with --perfetto"),
        (["trace", "nowhere"], "nowhere: unknown mission"),
        (["report", "MISSION", "-o", "nowhere/page.html"], "nowhere/page.html: --output: cannot be written"),
        (["trace", "MISSION", "--perfetto", "nowhere/x.json"], "nowhere/x.json: --perfetto: cannot be written"),
        (["trace", "MISSION", "--schedule", "chess"], "chess"),
    ],
)
def test_bad_usage_is_told(
    journal: Path,
    make_mission: Write,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    words: list[str],
    says: str,
    capsys: Capture,
) -> None:
    monkeypatch.chdir(tmp_path)
    make_mission("Quiet")
    names = {"JOURNAL": "run.cfepy", "MISSION": "mission"}
    assert main([names.get(word, word) for word in words]) == 2
    assert says.replace("JOURNAL", "run.cfepy") in capsys.readouterr().err
    assert not Path("x.json").exists()


def test_deadlines_that_are_missed_make_a_run_fail(make_mission: Write, tmp_path: Path, capsys: Capture) -> None:
    mission = str(make_mission("Chatty", yaml='deadlines: {topics: {"0x0890": {at_most_every: 1 s}}}'))
    numbers = tmp_path / "numbers.json"
    assert main(["run", mission, "--for", "2", "--no-console", "--json", str(numbers)]) == 1
    out, error = capsys.readouterr()
    assert re.search(r"0x0890 +at_most_every +1 s +\d+ +\d+ +100 ms", out)
    assert "cfepy: 0x0890 missed its deadline at_most_every 1 s" in error
    (deadline,) = json.loads(numbers.read_text(encoding="utf-8"))["deadlines"]
    assert deadline["owner"] == "0x0890"
    assert deadline["overruns"] == deadline["checked"] > 5
