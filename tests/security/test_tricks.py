"""None of an adversary's tricks runs code, writes outside, or goes on for long: it is told, or does nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.security.package_tricks import PACKAGE_TRICKS
from tests.security.tricks import CANARY, HARMLESS, TRICKS, Trick

QUICKER = {
    "rospy_shim.libraries.rosbag_storage.compression.LARGEST": 10 << 20,
    "cfepy.plain_xml.XML_TAGS": 10_000,
    "rospy_shim.roslaunch.reader.LAUNCH_WORK": 100_000,
}
"""Limits that are made smaller, so that they are reached in less time."""


@pytest.mark.parametrize("trick", TRICKS, ids=[trick.name for trick in TRICKS])
def test_a_trick_does_nothing(
    trick: Trick, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, limit in QUICKER.items():
        monkeypatch.setattr(name, limit)
    check(trick, tmp_path, capsys)


@pytest.mark.parametrize("trick", PACKAGE_TRICKS, ids=[trick.name for trick in PACKAGE_TRICKS])
def test_a_trick_of_a_package_does_nothing(trick: Trick, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    check(trick, tmp_path, capsys)


def check(trick: Trick, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Do what a trick asks for; it must fail as it should, or do nothing, and write nowhere but below `out`."""
    trick.make(tmp_path)
    before = set(tmp_path.rglob("*"))
    status = main(trick.words.replace("{}", str(tmp_path)).split())
    out, err = capsys.readouterr()
    assert not list(tmp_path.rglob(CANARY)), "code of the file has run, or it has left its folder"
    made = set(tmp_path.rglob("*")) - before
    assert all(each.is_relative_to(tmp_path / "out") for each in made)
    assert "Traceback" not in err + out
    assert status in (0, 1, 2)
    if trick.said != HARMLESS:
        assert status != 0
        assert trick.said in out + err


def test_there_are_fifty() -> None:
    assert len(TRICKS) >= 50
    assert len({trick.name for trick in TRICKS}) == len(TRICKS)
