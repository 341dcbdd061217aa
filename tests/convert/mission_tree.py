"""Converts a package of ROS nodes, builds it in a cFS mission tree, and boots it on NASA's cFE.

    python -m tests.convert.mission_tree TREE [--profile pool]

TREE is a checkout of cFS 7.0.0 with its submodules, and sample_defs; it is copied. Needs Linux, cmake, a compiler and
the rights of root, for `tests.twin.real` boots it in namespaces of its own.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from cfepy.cli.main import main
from tests.convert.ping import ping_package
from tests.twin.real import RealCfe

STARTUP = "sample_defs/cpu1_cfe_es_startup.scr"
HEARD = ("heard 3 plain-beat-odd!", "doubling 3")
LIMIT_S = 30.0


def build(tree: Path, scratch: Path, profile: str) -> Path:
    """Convert, and build in a copy of the tree: the folder of the executable.

    Args:
        tree: the mission tree.
        scratch: an empty folder.
        profile: of the nodes.

    Raises:
        subprocess.CalledProcessError: the build failed.
    """
    package = ping_package(scratch)
    mission = scratch / "mission"
    shutil.copytree(tree, mission, symlinks=True, ignore=shutil.ignore_patterns("build", ".git"))
    made = mission / "apps/ros_nodes"
    if main(["convert", str(package / "launch/nodelet.launch"), "-o", str(made), "--profile", profile]):
        raise SystemExit("the package could not be converted")
    targets = mission / "sample_defs/targets.cmake"
    include = "include(${MISSION_SOURCE_DIR}/apps/ros_nodes/targets.cmake)\n"
    targets.write_text(targets.read_text(encoding="utf-8") + include, encoding="utf-8")
    startup = (mission / STARTUP).read_text(encoding="utf-8")
    head, mark, rest = startup.partition("!\n")
    lines = (made / "startup_lines.scr").read_text(encoding="utf-8")
    (mission / STARTUP).write_text(head + lines + mark + rest, encoding="utf-8")
    installed = f"DESTDIR={mission / 'build'}"
    for words in (["SIMULATION=native", "prep"], [], [installed, "install"]):
        done = subprocess.run(["make", *words], cwd=mission, capture_output=True, text=True, check=False)
        if done.returncode:
            raise SystemExit(done.stdout[-4000:] + done.stderr[-4000:])
    return mission / "build/exe/cpu1"


def boot(built: Path, folder: Path) -> None:
    """Boot it, and wait until the nodes hear each other.

    Args:
        built: the folder of the executable.
        folder: for its private copy.
    """
    with RealCfe(built, folder, {}) as cfe:
        cfe.wait(lambda: all(text in console(folder) for text in HEARD), "hear each other", LIMIT_S)


def console(folder: Path) -> str:
    """What it has printed."""
    return (folder / "console.log").read_text(encoding="utf-8", errors="replace")


def run(arguments: list[str]) -> None:
    """Do it all, and say what came of it."""
    parser = argparse.ArgumentParser(prog="python -m tests.convert.mission_tree")
    parser.add_argument("tree", type=Path)
    parser.add_argument("--profile", default="host")
    said = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="cfepy-tree-") as scratch:
        os.environ["ROS_PACKAGE_PATH"] = scratch
        built = build(said.tree, Path(scratch), said.profile)
        folder = Path(scratch) / "run"
        folder.mkdir()
        boot(built, folder)
        print("\n".join(line for line in console(folder).splitlines() if any(text in line for text in HEARD)))


if __name__ == "__main__":
    run(sys.argv[1:])
