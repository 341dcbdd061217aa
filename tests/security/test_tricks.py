"""None of an adversary's tricks runs code, writes outside, or takes long: it is reported, or does nothing."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.security.package_tricks import PACKAGE_TRICKS
from tests.security.tricks import CANARY, HARMLESS, TRICKS, Trick

SECONDS = 30
"""Of the processor, for a trick; most take one."""
MEMORY = 500 << 10
"""KB that a trick may take."""
QUICKER = {
    "cfepy.extra.c.toolchain.cmake_budget.CMAKE_CHARACTERS": 2_000_000,
    "cfepy.extra.c.toolchain.cmake_budget.CMAKE_COMMANDS": 20_000,
    "cfepy.extra.c.toolchain.cmake_budget.CMAKE_FILES": 5_000,
    "cfepy.extra.convert.packages.CPP_FILES": 500,
    "cfepy.interpreter.syntax_trees.PYTHON_WORDS": 50_000,
    "ros_libraries.rosbag_storage.compression.LARGEST": 10 << 20,
    "cfepy.reading.plain_xml.XML_TAGS": 10_000,
    "rospy_shim.roslaunch.reader.LAUNCH_WORK": 100_000,
}
"""Limits that are made smaller, so that they are reached in less time."""


@pytest.mark.parametrize("trick", TRICKS, ids=[trick.name for trick in TRICKS])
def test_trick_has_no_effect(
    trick: Trick, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    check(trick, tmp_path, capsys, monkeypatch)


@pytest.mark.parametrize("trick", PACKAGE_TRICKS[::3], ids=[trick.name for trick in PACKAGE_TRICKS[::3]])
def test_trick_of_a_package_has_no_effect(
    trick: Trick, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    check(trick, tmp_path, capsys, monkeypatch)


def check(trick: Trick, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Execute a trick's command, with limits that are reached sooner."""
    for name, limit in QUICKER.items():
        monkeypatch.setattr(name, limit)
    trick.make(tmp_path)
    before = set(tmp_path.rglob("*"))
    status = main(trick.words.replace("{}", str(tmp_path)).split())
    out, err = capsys.readouterr()
    judge(trick, tmp_path, before, status, out + err)


def judge(trick: Trick, folder: Path, before: set[Path], status: int, said: str) -> None:
    """It must fail as it should, or do nothing, and write nowhere but below `out`."""
    assert not list(folder.rglob(CANARY)), "code of the file has run, or it has left its folder"
    assert all(each.is_relative_to(folder / "out") for each in set(folder.rglob("*")) - before)
    assert "Traceback" not in said
    assert status in (0, 1, 2)
    if trick.said != HARMLESS:
        assert status != 0
        assert trick.said in said


MEASURE = """
import os, resource, sys
child = os.fork()
if not child:
    resource.setrlimit(resource.RLIMIT_CPU, (int(sys.argv[1]), int(sys.argv[1])))
    os.dup2(2, 1)
    os.execv(sys.argv[2], sys.argv[2:])
_, status, used = os.wait4(child, 0)
print(os.waitstatus_to_exitcode(status), used.ru_maxrss)
"""
"""Starts a command from a small process: the most that a process ever had counts what its parent has when it forks."""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "wait4"), reason="what a process took is not told")
@pytest.mark.parametrize("trick", PACKAGE_TRICKS, ids=[trick.name for trick in PACKAGE_TRICKS])
def test_tricks_of_packages_stay_within_the_default_limits(trick: Trick, tmp_path: Path) -> None:
    """This runs all of them, in separate processes; the test above runs a third."""
    folder = tmp_path / "made"
    folder.mkdir()
    trick.make(folder)
    before = set(folder.rglob("*"))
    words = trick.words.replace("{}", str(folder)).split()
    with (tmp_path / "said").open("wb") as said:
        command = [sys.executable, "-S", "-c", MEASURE, str(SECONDS), sys.executable, "-m", "cfepy", *words]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=said, text=True)
    status, memory = map(int, done.stdout.split())
    judge(trick, folder, before, status, (tmp_path / "said").read_text(errors="replace", encoding="utf-8"))
    assert memory < MEMORY


def test_suite_has_fifty_tricks() -> None:
    assert len(TRICKS) >= 50
    assert len({trick.name for trick in (*TRICKS, *PACKAGE_TRICKS)}) == len(TRICKS) + len(PACKAGE_TRICKS)
