"""`cfepy check` for a user: a line for each problem, and the exit status."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.cli.conftest import Write


def test_a_good_mission(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(make_mission("Quiet"))]) == 0
    assert capsys.readouterr().out == "nothing found\n"


@pytest.mark.parametrize("mission", ["capture", "rx64m_pubsub"])
def test_shipped_missions_are_good(mission: str) -> None:
    assert main(["check", mission]) == 0


def test_every_problem_is_a_line(
    make_mission: Write, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = make_mission("Quiet", "Quite", "Quiet")
    monkeypatch.chdir(folder)
    assert main(["check", "startup.scr"]) == 1
    first, second, count = capsys.readouterr().out.splitlines()
    assert first.startswith("startup.scr:2: ")
    assert "has no function Quite; did you mean Quiet?" in first
    assert second == "startup.scr:3: the name 'QUIET' is already taken by line 1; choose another name"
    assert count == "2 problems found"


def test_no_such_mission(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(tmp_path / "nothing")]) == 2
    assert "unknown mission" in capsys.readouterr().err


def test_warnings_stand_apart_and_do_not_fail(
    make_mission: Write, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = make_mission("Quiet", "Quiet")
    script = folder / "startup.scr"
    lines = script.read_text(encoding="utf-8").splitlines()
    first, second = lines[0].replace(" 50,", " high,", 1), lines[1]
    monkeypatch.chdir(folder)
    script.write_text(f"{first}\n!", encoding="utf-8")
    assert main(["check", "."]) == 0
    warning = (
        "startup.scr:1: warning: invalid priority 'high', which cFE reads as 0; write a number, such as 60 or 0x3C"
    )
    assert capsys.readouterr().out.splitlines() == [warning, "1 warning found"]
    script.write_text(f"{first}\n{second}\n{second}\n!", encoding="utf-8")
    assert main(["check", "."]) == 1
    *problems, warned, count = capsys.readouterr().out.splitlines()
    assert all(line.startswith(("startup.scr:2: ", "startup.scr:3: ")) for line in problems)
    assert warned == warning
    assert count == f"{len(problems)} problems, 1 warning found"


def test_json_alone_on_standard_output(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_mission("Quite")
    assert main(["check", str(folder), "--json", "-"]) == 1
    found = json.loads(capsys.readouterr().out)
    (problem,) = found.pop("found")
    assert found == {"problems": 1, "warnings": 0}
    assert (problem["file"], problem["line"], problem["is_warning"]) == (str(folder / "startup.scr"), 1, False)
    assert "has no function Quite" in problem["text"]
