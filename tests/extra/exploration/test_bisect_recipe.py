"""The recipe of docs/how_to/explore_schedules.md for `git bisect`: it finds the commit that brought a race."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.reading.resources import import_path

ROOT = Path(__file__).parents[3]
RACE = ROOT / "tests" / "quality" / "missions" / "lost_update"
PAGE = ROOT / "docs" / "how_to" / "explore_schedules.md"
IDENTITY = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
IDENTITY |= {f"GIT_{who}_{what}": "tester" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}


@pytest.mark.skipif(shutil.which("git") is None, reason="needs git")
def test_bisect_recipe_finds_the_commit_that_brought_the_race(tmp_path: Path) -> None:
    repository, results = tmp_path / "repository", tmp_path / "arm.results"
    mission = repository / "arm"
    shutil.copytree(RACE, mission)
    program = tmp_path / "bin" / "cfepy"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m cfepy "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    path = f"{program.parent}:{os.environ['PATH']}"
    environment = {**os.environ, **IDENTITY, "PATH": path, "PYTHONPATH": import_path()}

    def shell(command: str, status: int = 0) -> str:
        done = subprocess.run(
            ["sh", "-c", command], cwd=repository, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == status, f"{command}\n{done.stdout}\n{done.stderr}"
        return done.stdout

    node = mission / "odometer.py"
    racy = node.read_text(encoding="utf-8")
    lines = racy.splitlines(keepends=True)
    begin = next(at for at, line in enumerate(lines) if "def on_ticks" in line) + 1
    body = [f"    {line}" for line in lines[begin : begin + 3]]
    locked = "".join([*lines[:begin], "        with self.lock:\n", *body, *lines[begin + 3 :]])
    with_lock = "self.travelled = 0\n        self.lock = threading.Lock()\n"
    good = "import threading\n" + locked.replace("self.travelled = 0\n", with_lock)
    shell("git init --quiet")
    for name, text in (
        ("with a lock", good),
        ("does not boot", "def broken(:\n"),
        ("with a comment", good + "# the odometer\n"),
        ("without a lock", racy),
        ("with another comment", racy + "# the odometer\n"),
    ):
        node.write_text(text, encoding="utf-8")
        shell(f"git add . && git commit --quiet -m '{name}'")
    page = PAGE.read_text(encoding="utf-8")
    begins = r"^cfepy explore arm .*\n^git bisect start .*\n"
    recipe = re.search(rf"{begins}(?P<run>^git bisect run .*)\n", page, re.MULTILINE)
    assert recipe is not None
    shell(f"cfepy explore arm --for 1.3 --seeds 4 --jobs 1 --quiet --results {results}", 1)
    shell("git bisect start HEAD HEAD~4")
    shown = shell(recipe["run"].replace("/tmp/arm.results", str(results)))
    assert re.search(r"^[0-9a-f]{40} is the first bad commit$", shown, re.MULTILINE)
    assert "\n    without a lock\n" in shown
    shell("git bisect reset")
