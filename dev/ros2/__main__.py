"""Write docs/reference/generated/ros2_nodes.md: public ROS 2 nodes on cfepy and on the real rclpy.

    python -m dev.ros2 --sources FOLDER --real PYTHON

FOLDER has checkouts of the repositories of missions.json at its commits, named OWNER+NAME. PYTHON is a Python 3.11 with
the packages `ros-rclpy[fastrtps]` and `ros-common-interfaces`. Each mission flies for 6 s on both, with the same
nodes, unmodified. Lines that nodes print must be equal, but for the times in log lines; the longer output may go on.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/reference/generated/ros2_nodes.md"
MISSIONS = Path(__file__).with_name("missions.json")
SECONDS = 6
REAL_SECONDS = 8  # on the real one, with the start of the processes
_TIME = re.compile(r"\[\d+\.\d{9}\]|\b\d{9,}(?:\.\d+)?\b")
_OWN = re.compile(r"\[([\w/]+)\] (.*)")
_END = ("Traceback", "KeyboardInterrupt", "  ", "^C", "rclpy.executors.ExternalShutdownException")


class Program(NamedTuple):
    """One node: its repository, path and arguments."""

    repository: str
    path: str
    arguments: tuple[str, ...]

    @classmethod
    def parse(cls, text: str) -> Program:
        """Return a program from "OWNER/NAME:PATH ARGUMENT ..."."""
        place, *arguments = text.split()
        repository, _, path = place.partition(":")
        return cls(repository, path, tuple(arguments))

    def package(self, sources: Path) -> Path:
        """Return the folder of its package."""
        file = sources / self.repository.replace("/", "+") / self.path
        return next((each for each in file.parents if (each / "package.xml").exists()), file.parent)

    def module(self, sources: Path) -> str:
        """Return the name of its module in its package."""
        file = sources / self.repository.replace("/", "+") / self.path
        return ".".join(file.relative_to(self.package(sources)).with_suffix("").parts)


def normal(lines: Sequence[str]) -> list[str]:
    """Return printed lines without times, and without the traces of the end by Ctrl-C."""
    found = [_TIME.sub("[time]", line.rstrip()) for line in lines]
    return [line for line in found if line and not line.startswith(_END)]


def on_cfepy(programs: Sequence[Program], sources: Path, folder: Path) -> list[list[str]]:
    """Return the lines of each program on cfepy."""
    script, nodes = [], []
    for number, program in enumerate(programs):
        inner = folder / f"p{number}"
        shutil.copytree(program.package(sources), inner, ignore=shutil.ignore_patterns(".git"))
        start = f"import sys\nfrom {program.module(sources)} import main\nsys.exit(main())\n"
        (inner / "start.py").write_text(start, encoding="utf-8")
        script.append(f"CFE_APP, p{number}/start.py, __main__, N{number}, 100, 65536, 0x0, 0;\n")
        nodes.append(f"  N{number}: {{ros: 2, args: {json.dumps(program.arguments)}}}\n")
    (folder / "startup.scr").write_text("".join(script) + "!\n", encoding="utf-8")
    (folder / "mission.yaml").write_text("nodes:\n" + "".join(nodes), encoding="utf-8")
    command = [sys.executable, "-m", "cfepy", "run", str(folder), "--for", str(SECONDS)]
    shown = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, timeout=300, check=False).stdout
    found: dict[str, list[str]] = {}
    for line in shown.splitlines():
        match = _OWN.fullmatch(line)
        if match is not None:
            found.setdefault(match[1], []).append(match[2])
    lists = [*found.values(), *([] for _ in programs)]
    return [normal(each) for each in lists[: max(len(programs), len(found))]]


def on_rclpy(programs: Sequence[Program], sources: Path, python: str) -> list[list[str]]:
    """Return the lines of each program on the real rclpy."""
    environ = {
        **os.environ,
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "ROS_DOMAIN_ID": "79",
        "PYTHONUNBUFFERED": "1",
    }
    running = []
    for program in programs:
        start = f"import sys; from {program.module(sources)} import main; sys.exit(main())"
        command = [python, "-c", start, *program.arguments]
        running.append(
            subprocess.Popen(
                command,
                cwd=program.package(sources),
                env=environ,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
        )
    time.sleep(REAL_SECONDS)
    for process in running:
        process.send_signal(signal.SIGINT)
    found = []
    for process in running:
        try:
            shown, _ = process.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            process.kill()
            shown, _ = process.communicate()
        missing = re.search(r"ModuleNotFoundError: No module named '([\w.]+)'", shown)
        found.append([f"missing: {missing[1]}"] if missing else normal(shown.splitlines()))
    return found


def verdict(ours: list[list[str]], theirs: list[list[str]]) -> str:
    """Return "equal" with the number of lines, or the first difference."""
    missing = [lines[0] for lines in theirs if lines and lines[0].startswith("missing: ")]
    if missing:
        return f"not compared: the real one lacks {missing[0].removeprefix('missing: ')}"
    count = 0
    for number, lines in enumerate(theirs):
        best = max(ours, key=lambda each: _shared(each, lines)) if ours else []
        shared = _shared(best, lines)
        if shared < min(len(best), len(lines)) or (lines and not shared):
            one = best[shared] if shared < len(best) else "(nothing)"
            other = lines[shared] if shared < len(lines) else "(nothing)"
            return f"node {number + 1} differs after {shared} lines: `{one}`, and `{other}` on rclpy"
        count += shared
    return f"equal: {count} lines"


def _shared(one: list[str], other: list[str]) -> int:
    """Return the number of equal lines at the beginning."""
    return next((at for at, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other)))


def main() -> None:
    """Fly all missions on both, and write the page."""
    parser = argparse.ArgumentParser(
        prog="python -m dev.ros2", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--sources", type=Path, required=True, help="folder with the checkouts")
    parser.add_argument("--real", required=True, help="Python with the real rclpy")
    arguments = parser.parse_args()
    rows = []
    table = json.loads(MISSIONS.read_text(encoding="utf-8"))
    for name, texts in table["missions"]:
        programs = [Program.parse(text) for text in texts]
        with tempfile.TemporaryDirectory() as folder:
            ours = on_cfepy(programs, arguments.sources, Path(folder))
        found = verdict(ours, on_rclpy(programs, arguments.sources, arguments.real))
        nodes = ", ".join(f"`{' '.join([Path(each.path).stem, *each.arguments])}`" for each in programs)
        rows.append(f"| {name} | {nodes} | {found} |\n")
        print(rows[-1], end="", flush=True)
    equal = sum("| equal" in row for row in rows)
    commits = ", ".join(f"{repository} at {commit}" for repository, commit in table["commits"].items())
    PAGE.write_text(
        "# Public ROS 2 nodes on cfepy and on rclpy\n\n"
        "`python -m dev.ros2` writes this page. Each row is a mission of unmodified public nodes. It flies for "
        f"{SECONDS} s on cfepy,\nand on rclpy 9.1.2 with Fast DDS. Lines that nodes print are compared without times. "
        "The longer output may go on.\n"
        "Where threads or processes race on rclpy, lines may come in another order there.\n\n"
        f"The nodes are from {commits}. {equal} of {len(rows)} missions are equal.\n\n"
        "| mission | nodes | result |\n|---|---|---|\n" + "".join(rows),
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()
