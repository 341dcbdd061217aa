"""Nodes that use every part of Python that could distinguish runs: one trace on every kind of tasks."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.mission import Mission
from cfepy.writing.console import Console

NODES = Path(__file__).parent / "busy_nodes"


@pytest.fixture
def folder(tmp_path: Path) -> str:
    names = sorted(path.stem for path in NODES.glob("*.py"))
    for name in names:
        shutil.copy(NODES / f"{name}.py", tmp_path)
    startup = "".join(f"CFE_APP, {name}.py, __main__, {name.upper()}, 100, 16384, 0x0, 0;\n" for name in names)
    (tmp_path / "startup.scr").write_text(startup + "!\n", encoding="utf-8")
    return str(tmp_path)


def check(folder: str, runs: int, *options: str) -> int:
    """Compare runs. Returns the exit status."""
    return main(["run", folder, "--for", "26", "--check-determinism", str(runs), *options])


def test_all_nodes_end(folder: str) -> None:
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(26)
        mission.shut_down_nodes()
        printed = [line for line in mission.console.lines if line.startswith("[")]
        assert mission.record.resets == []
        assert not [line for line in mission.console.lines if "Traceback" in line or "died" in line]
    last = {line.partition("]")[0][1:]: line.partition("] ")[2] for line in printed}
    assert last["workers"] == "True 1"
    assert last["loop"] == "[None, None, None]"
    assert last["robot"] == "over 9"
    assert last["clocks"].startswith("['clocks.py', 'loop.py', 'robot.py', 'startup.scr', 'workers.py']")


@pytest.mark.slow
def test_a_few_runs(folder: str) -> None:
    assert check(folder, 3) == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("runs", "options"), [(10, []), (6, ["--schedule", "random", "--seed", "9"]), (6, ["--board", "rx64m"])]
)
def test_many_runs_are_the_same(folder: str, runs: int, options: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    does_not_fit = "rx64m" in options  # which is a problem of the mission, the same in each run
    assert check(folder, runs, *options) == int(does_not_fit)
    assert f"{runs} runs" in capsys.readouterr().out
