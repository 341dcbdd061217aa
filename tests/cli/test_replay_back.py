"""Going back with forked processes shows the same as going back without them."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not hasattr(os, "fork"), reason="needs a system that can fork a process"),
]
STEPS = 30


@pytest.fixture(scope="module")
def journal(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return the journal of a run with many events between two keepers."""
    file = tmp_path_factory.mktemp("capture") / "run.cfepy"
    assert main(["run", "capture", "--for", "1", "--quiet", "--record", str(file)]) == 0
    return str(file)


def replayed(journal: str, typed: str, *options: str) -> tuple[int, str, str]:
    """Return status, output and error output of a replay in a separate process."""
    command = [sys.executable, "-m", "cfepy", "replay", journal, "--quiet", *options]
    done = subprocess.run(command, input=typed, capture_output=True, text=True, timeout=300, check=False)
    return done.returncode, done.stdout, done.stderr


def both_ways(journal: str, typed: str, *options: str) -> list[str]:
    """Return the output, the same on greenlets, with keepers, and on threads, without them."""
    quick, plain = (replayed(journal, typed, "--tasks", tasks, *options) for tasks in ("greenlet", "thread"))
    lines, others = ([line for line in each[1].splitlines() if " x real time" not in line] for each in (quick, plain))
    assert lines == others
    assert quick[0] == plain[0] == 0
    assert "cfepy: the same run as" in quick[2]
    return [line for line in lines if line[:1].isdigit()]


def test_steps_at_random_are_the_same_with_and_without_keepers(journal: str) -> None:
    choose = random.Random(3).choice
    typed = "".join(f"{choose(['b', 'b', 's', 's', 'rc', 'bt /joint_states'])}\n" for _ in range(STEPS))
    shown = both_ways(journal, f"{typed}q\n", "--back", "--break", "/phase", "--until", "0.9")
    assert len(shown) > STEPS / 2


def test_a_search_goes_through_all_that_was_before(journal: str) -> None:
    shown = both_ways(
        journal, "bt self.no_such_thing == 1\nbt len(self.joints) == 7\nb\nq\n", "--back", "--until", "0.9"
    )
    assert "the end of the run" in shown[0]
    assert shown[1] == shown[2] == shown[0]


def test_a_run_that_was_gone_back_in_ends_as_it_did(journal: str) -> None:
    typed = "b\nb\nb\nrc\nc\nc\nc\nc\n"
    status, _, said = replayed(journal, typed, "--back", "--break", "/phase", "--tasks", "greenlet")
    assert status == 0
    assert f"the same run as {journal}\n" in said


def test_ends_that_nobody_asked_for_leave_no_process_behind(journal: str) -> None:
    status, shown, _ = replayed(journal, "b\nb\n", "--back", "--tasks", "greenlet")  # and the input ends
    assert status == 0
    assert shown


WRITES = """
import rospy
rospy.init_node("counter")
with open("starts", "a+") as file:
    for _ in range(20):
        rospy.sleep(0.1)
        file.write("z")
        file.flush()
"""


def test_keepers_leave_no_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "counter.py").write_text(WRITES, encoding="utf-8")
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TMPDIR", str(temporary))
    command = [sys.executable, "-m", "cfepy", "node", "counter.py", "--for", "2", "--quiet", "--record", "run.cfepy"]
    subprocess.run(command, capture_output=True, check=True, timeout=300)
    status, _, said = replayed("run.cfepy", "b\nb\ns\nb\nb\nq\n", "--tasks", "greenlet", "--back", "--until", "1.5")
    assert status == 0, said
    assert list(temporary.iterdir()) == []
