"""`cfepy check` as a person sees it: a line for each problem, and the exit status."""

from __future__ import annotations

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
    assert "has no function Quite; is Quiet meant?" in first
    assert second == "startup.scr:3: the name 'QUIET' is taken by line 1; give this one another name"
    assert count == "2 problems found"


def test_no_such_mission(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(tmp_path / "nothing")]) == 2
    assert "no startup script" in capsys.readouterr().err
