"""`python -m dev.take_out [NAME ...]`: take add-ons out of a copy of this checkout, one at a time, and fly the rest.

A name is one of the folders of `cfepy/extra`, or `ros_libraries` or `rclpy_shim`; `all` is all of them at once.
Without names, each is taken out in turn. The program tries the help, the check and the run of `lab`, the run of
`capture`, and `cfepy.boot`.
It also checks that a removed command names its add-on. With `--tests` it also runs the quick tests of the rest.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from cfepy.plugins import OWN
from dev.house.tree import ROOT

SHELVES, ALL = ("ros_libraries", "rclpy_shim"), "all"
NAMES = (*(each.name for each in OWN), *SHELVES)
COMPUTER = ("rtos", "osal", "psp", "msg", "fs", "es", "sb", "evs", "time", "tbl")
PYTEST = ("-m", "pytest", "-p", "no:cacheprovider")
BOOT = "import cfepy\nwith cfepy.boot('lab') as flight:\n    flight.run_for(1.0)\n"
LEFT_OUT = shutil.ignore_patterns(".git", ".venv", "__pycache__", "*.so", ".*_cache", ".hypothesis", ".site")


class Tried(NamedTuple):
    """A check and its error; `trouble` is empty on success."""

    what: str
    trouble: str


class Copy:
    """A copy of the checkout without some add-ons.

    Args:
        folder: folder of the copy; must not exist yet.
        names: add-ons to remove.
    """

    def __init__(self, folder: Path, names: Sequence[str]) -> None:
        self.folder = folder
        self.names = names
        shutil.copytree(ROOT, folder, ignore=LEFT_OUT)
        for name in names:
            shutil.rmtree(folder / name if name in SHELVES else folder / "cfepy" / "extra" / name)

    def give(self, *words: str) -> subprocess.CompletedProcess[str]:
        """Give a command of this Python, which finds the copy and not the checkout."""
        environ = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
        environ["PYTHONPATH"] = str(self.folder)
        command = [sys.executable, *words]
        return subprocess.run(command, cwd=self.folder, env=environ, capture_output=True, text=True, check=False)

    def flights(self) -> list[Tried]:
        """Check everything that must work without the add-ons."""
        tried = [
            self._well("cfepy --help", "-m", "cfepy", "--help"),
            self._well("cfepy check lab", "-m", "cfepy", "check", "lab"),
            self._well("cfepy run lab", "-m", "cfepy", "run", "lab", "--for", "2", "--quiet"),
            self._well("cfepy run capture", "-m", "cfepy", "run", "capture", "--for", "2", "--quiet"),
            self._well("cfepy.boot", "-c", BOOT),
        ]
        for plugin in OWN:
            if plugin.name in self.names and plugin.commands:
                tried.append(self._gone(plugin.commands[0], plugin.name))
        return tried

    def tests(self) -> list[Tried]:
        """Run the quick tests of the rest. Without all add-ons, run the default tests of the computer."""
        if set(NAMES) <= set(self.names):
            return [self.computer()]
        return [self._well("quick tests", *PYTEST, "-m", "quick", "tests")]

    def computer(self) -> Tried:
        """Run the default tests of the computer: of kernel, OSAL, PSP and services."""
        return self._well("tests of the computer", *PYTEST, *(f"tests/{part}" for part in COMPUTER))

    def _well(self, what: str, *words: str) -> Tried:
        done = self.give(*words)
        return Tried(what, "" if done.returncode == 0 else f"status {done.returncode}\n{done.stdout}{done.stderr}")

    def _gone(self, command: str, name: str) -> Tried:
        done = self.give("-m", "cfepy", command, "--help")
        said = f"cfepy: the command {command} requires the add-on {name}, which is missing in this installation"
        is_said = done.returncode == 2 and done.stderr.startswith(said)
        return Tried(f"cfepy {command}", "" if is_said else f"status {done.returncode}\n{done.stdout}{done.stderr}")


def main() -> int:
    """Take add-ons out and check. Returns exit status 1 if a check fails."""
    parser = argparse.ArgumentParser(prog="python -m dev.take_out", description=__doc__)
    parser.add_argument(
        "names", metavar="NAME", nargs="*", help=f"{', '.join(NAMES)}, or {ALL} (default: each in turn)"
    )
    parser.add_argument("--tests", action="store_true", help="run the quick tests of the rest, too")
    arguments = parser.parse_args()
    unknown = {*arguments.names} - {*NAMES, ALL}
    if unknown:
        parser.error(f"unknown add-on {', '.join(sorted(unknown))}; expected {', '.join(NAMES)}")
    status = 0
    for name in arguments.names or NAMES:
        with tempfile.TemporaryDirectory() as folder:
            copy = Copy(Path(folder) / "cfepy", NAMES if name == ALL else [name])
            for tried in [*copy.flights(), *(copy.tests() if arguments.tests else [])]:
                print(f"without {name}: {tried.what}: {'well' if not tried.trouble else tried.trouble}", flush=True)
                status |= bool(tried.trouble)
    return status


if __name__ == "__main__":
    sys.exit(main())
