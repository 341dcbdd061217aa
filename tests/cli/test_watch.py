"""`cfepy run --watch` (docs/how_to/recipes.md): a run for each change, its short result, and the files that count."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.cli.main import BAD_USAGE, INTERRUPTED, main
from cfepy.cli.run.watch import RunProcess, WatchedRun
from cfepy.io import WatchedFiles
from tests.cli.conftest import Write

WELL = {"problems": [], "virtual_s": 2.0, "wall_s": 0.5, "trace": "ab" * 16}
WRONG = {"problems": ["DIES died: ValueError: boom"], "virtual_s": 1.0, "wall_s": 0.25, "trace": "cd" * 16}


def test_result_of_a_run_is_short() -> None:
    well = WatchedRun(0, WELL, (), ())
    assert well.text(1, "") == f"run 1: no problems, 2 virtual s in 0.50 s, trace {'ab' * 16}"
    assert well.text(2, "ab" * 16).endswith(", the same as before")
    wrong = WatchedRun(1, WRONG, ("cfepy: DIES died: ValueError: boom",), ())
    assert wrong.text(3, "ab" * 16).splitlines() == [
        f"run 3: 1 problem, 1 virtual s in 0.25 s, trace {'cd' * 16}",
        "  DIES died: ValueError: boom",
    ]
    unread = WatchedRun(2, None, ("cfepy: mission.yaml:1: bord: unknown field",), ())
    assert unread.text(4, "").splitlines() == ["run 4: exit status 2", "  cfepy: mission.yaml:1: bord: unknown field"]


def test_watch_runs_again_after_each_change_until_ctrl_c(
    make_mission: Write, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = make_mission("Quiet")
    runs: Iterator[WatchedRun | None] = iter(
        [WatchedRun(0, WELL, (), ("/lib/used.py",)), None, WatchedRun(1, WRONG, (), ()), WatchedRun(0, WELL, (), ())]
    )
    changes = iter([["/lib/used.py"], [str(folder / "startup.scr")], [str(folder / "startup.scr")]])

    def wait(files: WatchedFiles, *_: Any) -> list[str]:
        found = next(changes, None)
        if found is None:
            raise KeyboardInterrupt
        return found

    monkeypatch.setattr(WatchedFiles, "wait", wait)
    monkeypatch.setattr(RunProcess, "run", lambda process, is_stale: next(runs))
    monkeypatch.chdir(folder)
    assert main(["run", str(folder), "--watch"]) == INTERRUPTED
    lines = [line for line in capsys.readouterr().out.splitlines() if "watching" not in line]
    assert [line.partition(",")[0] for line in lines] == [
        "run 1: no problems",
        "changed: /lib/used.py",
        "changed: startup.scr",
        "run 3: 1 problem",
        "  DIES died: ValueError: boom",
        "changed: startup.scr",
        "run 4: no problems",
    ]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--realtime"], "--watch: cannot be combined with --realtime, because such a run does not end"),
        (["--check-determinism"], "--watch: cannot be combined with --check-determinism"),
        (["--json", "-"], "--watch: cannot be combined with --json -"),
    ],
)
def test_option_without_a_single_run_is_refused(
    make_mission: Write, capsys: pytest.CaptureFixture[str], options: list[str], said: str
) -> None:
    assert main(["run", str(make_mission("Quiet")), "--watch", *options]) == BAD_USAGE
    assert said in capsys.readouterr().err


def test_process_gets_the_words_of_the_user_and_its_own_files(tmp_path: Path) -> None:
    process = RunProcess(["run", "lab", "--for", "2"], tmp_path, None, None)
    more = ["--quiet", "--json", str(tmp_path / "run.json")]
    more += ["--record", str(tmp_path / "run.cfepy"), "--record-no-files"]
    assert process._words == [sys.executable, "-m", "cfepy", "run", *more, "lab", "--for", "2"]
    given = ["run", "lab", "--quiet", "--json", "a.json", "--record", "a.cfepy"]
    assert RunProcess(given, tmp_path, "a.json", "a.cfepy")._words[3:] == given


def test_process_reports_the_run_and_the_files_it_opened(make_mission: Write, tmp_path: Path) -> None:
    folder = make_mission("Dies")
    (tmp_path / "own").mkdir()
    done = RunProcess(["run", str(folder), "--for", "2"], tmp_path / "own", None, None).run(lambda: False)
    assert done is not None
    assert done.results is not None
    assert (done.status, done.results["problems"]) == (1, ["DIES died: ValueError: boom"])
    assert str(folder / "startup.scr") in done.files
    (folder / "startup.scr").unlink()
    done = RunProcess(["run", str(folder)], tmp_path / "own", None, None).run(lambda: False)
    assert done is not None
    assert (done.status, done.results, done.files) == (2, None, ())
    assert done.errors


def test_run_whose_files_change_meanwhile_is_ended(make_mission: Write, tmp_path: Path) -> None:
    process = RunProcess(["run", str(make_mission("Quiet")), "--for", "100000000"], tmp_path, None, None)
    assert process.run(lambda: True) is None
    assert process._process is not None
    assert process._process.poll() is not None
