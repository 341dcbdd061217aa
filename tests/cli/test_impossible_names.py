"""File names from the user that no file can have: reported like missing files."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main

LONG = "a" * 5000
LAUNCH = f"""<launch>
  <node pkg="p" type="{LONG}" name="n"/>
  <include file="{LONG}"/>
</launch>
"""


@pytest.mark.parametrize("text", [f"board: {LONG}", f"params_from: {LONG}", f"launch: [{LONG}]"])
def test_a_mission_file(text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "startup.scr").write_text("!\n", encoding="utf-8")
    (tmp_path / "mission.yaml").write_text(f"name: test\n{text}\n", encoding="utf-8")
    assert main(["check", str(tmp_path)]) == 1
    assert "mission.yaml:2: " in capsys.readouterr().out
    assert main(["run", str(tmp_path), "--for", "1"]) == 2
    assert "Errno" not in capsys.readouterr().err


def test_a_launch_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "x.launch").write_text(LAUNCH, encoding="utf-8")
    assert main(["check", str(tmp_path / "x.launch")]) == 1
    told = capsys.readouterr().out
    assert "x.launch:2: " in told
    assert "x.launch:3: " in told


@pytest.mark.parametrize(
    "words",
    [
        ["run", LONG],
        ["check", LONG],
        ["launch", LONG],
        ["launch", "rospy", LONG],
        ["node", LONG],
        ["node", "rospy", LONG],
        ["rostest", LONG],
        ["rosparam", "dump", LONG],
        ["export", "xtce", LONG],
        ["replay", LONG],
    ],
)
def test_words(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 2
    assert "Errno" not in capsys.readouterr().err
