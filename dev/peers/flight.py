"""Run test files, each in its own process: `cfepy node` for Python files, `cfepy rostest` for launch files."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from cfepy.cli.ros.rostest import read_results
from dev.corpus.sources import Sources
from dev.peers.peers import UNIT, Peer

DRIVER = Path(__file__).with_name("driver.py")
VIRTUAL_S = 600  # of a Python file
WALL_S = 120
LAST_LINES = 3
PASSED, SKIPPED = "passed", "skipped"


class Verdict(NamedTuple):
    """Results of a test file: the result of each test, and the reason if there are no results."""

    peer: Peer
    said: dict[str, str]
    reason: str
    wall_s: float

    @property
    def passed(self) -> int:
        """How many tests passed."""
        return sum(each == PASSED for each in self.said.values())

    @property
    def failing(self) -> dict[str, str]:
        """Return the tests that neither passed nor were skipped, with their errors."""
        return {name: said for name, said in self.said.items() if said not in (PASSED, SKIPPED)}

    @property
    def good(self) -> bool:
        """Whether enough tests passed. Without a count from ROS, all must pass except those that are not counted."""
        if self.peer.passed is not None:
            return self.peer.enough(self.passed)
        return not self.reason and self.failing.keys() <= self.peer.aside.keys()


def run(peer: Peer, sources: Sources) -> Verdict:
    """Run a test file. Returns its results."""
    missing = [repo for repo in peer.repos if not sources.folder(repo).is_dir()]
    if missing:
        return Verdict(peer, {}, f"no sources of {', '.join(missing)}", 0.0)
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        said, reason = _run(peer, sources, Path(folder))
    return Verdict(peer, said, reason, time.perf_counter() - begun)


def _run(peer: Peer, sources: Sources, folder: Path) -> tuple[dict[str, str], str]:
    file, results = _place(peer, sources, folder), folder / "results"
    if peer.kind == UNIT:
        saved = folder / "saved"  # files that nodes write belong to the run
        command = ["node", "--for", str(VIRTUAL_S), "--save-files", str(saved), str(DRIVER), str(file), str(results)]
        results = saved / os.path.realpath(results).lstrip("/")
    else:
        command = ["rostest", "--results", str(results), str(file)]
    try:
        done = subprocess.run(
            [sys.executable, "-m", "cfepy", *command],
            env=_environment(peer, sources, folder),
            cwd=file.parent,
            capture_output=True,
            text=True,
            timeout=WALL_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return {}, f"takes longer than {WALL_S} s"
    if not results.is_file():
        lines = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        return {}, " / ".join(lines[-LAST_LINES:])
    if peer.kind == UNIT:
        said: dict[str, str] = json.loads(results.read_text(encoding="utf-8"))
        return said, ""
    return dict(_cases(results)), ""


def _place(peer: Peer, sources: Sources, folder: Path) -> Path:
    """Return the file to run.

    Tests of libraries that cfepy brings along are copied away from the code that they came with.
    """
    file = sources.folder(peer.repo) / peer.path
    if peer.packages or peer.kind != UNIT:
        return file
    top = _top(file)
    shutil.copytree(top, folder / "away" / top.name)
    return folder / "away" / top.name / file.relative_to(top)


def _top(file: Path) -> Path:
    """Return the topmost folder of the Python packages that contain a file, or the file's folder if none does."""
    folder = file.parent
    while (folder.parent / "__init__.py").is_file():
        folder = folder.parent
    return folder


def _environment(peer: Peer, sources: Sources, folder: Path) -> dict[str, str]:
    packages = [str(sources.folder(repo) / path) for repo, _, path in (each.partition(":") for each in peer.packages)]
    return {
        **os.environ,
        "HOME": str(folder),
        "PYTHONPATH": str(Path(__file__).parents[2]),
        "ROS_PACKAGE_PATH": os.pathsep.join(packages),
    }


def _cases(results: Path) -> Iterator[tuple[str, str]]:
    for case in read_results(results, "").cases:
        yield case.name, "\n".join(problem.text for problem in case.problems) or PASSED
