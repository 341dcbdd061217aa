"""Line and branch coverage of the interface library by the project's own tests.

    python -m dev.roscfe.coverage                       # the tests of `TESTS`, then the figures
    python -m dev.roscfe.coverage --files               # with a row for each file
    python -m dev.roscfe.coverage tests/roscfe/test_heap.py

The tests compile with a wrapper around g++ that adds `--coverage` and `-O0`, whatever program or shared object they
make. Counted are the sources and headers of `roscfe/`, whatever program they are compiled into. A branch is a way out
of a condition, as gcov (gcc) finds it; see `decisions`.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.reading.resources import shipped

CHECKOUT = Path(__file__).parents[2]
TESTS = (
    *("tests/roscfe/test_alone.py", "tests/roscfe/test_boost.py", "tests/roscfe/test_bus_fuzz.py"),
    *("tests/roscfe/test_fixed.py", "tests/roscfe/test_formats.py", "tests/roscfe/test_frames.py"),
    *("tests/roscfe/test_geometry.py", "tests/roscfe/test_heap.py", "tests/roscfe/test_linear_math.py"),
    *("tests/roscfe/test_probes.py", "tests/roscfe/test_random.py", "tests/roscfe/test_tf_flight.py"),
    "tests/extra/convert/test_nodes.py",
    *(f"tests/extra/convert/test_node_{name}.py" for name in ("ends", "ground", "memory", "parameters")),
    *(f"tests/extra/convert/test_{name}.py" for name in ("service_ends", "strict_flight", "strict_nodes")),
    *(
        f"tests/extra/convert/test_{name}.py"
        for name in ("unheard_topics", "google_test", "hostile_packets", "configurations")
    ),
)
"""Tests that run the library. Those that only compile it, or run it elsewhere, measure nothing."""
LEFT_OUT = ("tests/roscfe/test_linear_math.py::test_numbers_equal_a_real_ros",)
"""Tests of the last bit of a sine, which is another one without optimization."""
MEASURED = ("src", "include", "threads", "boost")
LEAST = 90.0
"""Percent of lines, and of branches."""
WRAPPER = """#!{python}
import hashlib, os, shutil, subprocess, sys
left_out = ("-ffile-prefix-map=", "-fsanitize=address")  # short names of sources, and branches that no source has
given = [each for each in sys.argv[1:] if not each.startswith(left_out)]
more = ["--coverage", "-O0", "-fprofile-update=atomic", "-Wl,-u,__gcov_dump"]
if "-c" in given and "-o" in given:
    at = given.index("-o") + 1
    wanted = given[at]
    name = hashlib.blake2b("\\0".join([os.getcwd(), *given]).encode(), digest_size=8).hexdigest()
    given[at] = os.path.join({objects!r}, f"{{os.path.splitext(os.path.basename(wanted))[0][:60]}}-{{name}}.o")
    done = subprocess.run(["g++", *given, *more[:3]])
    if done.returncode == 0:
        shutil.copyfile(given[at], wanted)
    sys.exit(done.returncode)
os.execvp("g++", ["g++", *given, *([] if "-fsyntax-only" in given or "-E" in given else more)])
"""


class Row(NamedTuple):
    """The coverage of a file: lines and branches that were reached, of how many."""

    name: str
    lines: int
    all_lines: int
    branches: int
    all_branches: int


class Coverage(NamedTuple):
    """The coverage of the library.

    Attributes:
        rows: of its files.
    """

    rows: list[Row]

    @property
    def lines(self) -> float:
        """Percent of lines."""
        return 100 * sum(each.lines for each in self.rows) / max(sum(each.all_lines for each in self.rows), 1)

    @property
    def branches(self) -> float:
        """Percent of branches."""
        return 100 * sum(each.branches for each in self.rows) / max(sum(each.all_branches for each in self.rows), 1)


def measure(folder: Path, tests: list[str]) -> tuple[int, Coverage]:
    """Run tests, and measure the library's coverage by them.

    Args:
        folder: an empty folder, for the objects.
        tests: files or names of tests, for pytest.

    Returns:
        The exit status of pytest, and the coverage.
    """
    wrapper = compiler(folder)
    environ = {**os.environ, "CXX": str(wrapper), "XDG_CACHE_HOME": str(folder / "cache")}
    given = ["-m", "slow or not slow", "-q", "-n0", "-p", "no:randomly", f"--basetemp={folder / 'tests'}"]
    given += [*(f"--deselect={each}" for each in LEFT_OUT), *tests]
    done = subprocess.run([sys.executable, "-m", "pytest", *given], cwd=CHECKOUT, env=environ, check=False)
    return done.returncode, read(folder)


def compiler(folder: Path) -> Path:
    """Write a compiler into an empty folder, which makes objects that count, and keeps them there. Returns its path."""
    (objects := folder / "objects").mkdir()
    wrapper = folder / "g++-with-coverage"
    wrapper.write_text(WRAPPER.format(python=sys.executable, objects=str(objects)), encoding="utf-8")
    wrapper.chmod(0o755)
    return wrapper


def read(folder: Path) -> Coverage:
    """Return the coverage that objects in a folder, and in its folders, have counted.

    A line of a header or of a template counts once, however many objects have it. Its branches are the branches
    of the instance with most of them.
    """
    library, lines, branches = (
        str(shipped("roscfe").resolve()),
        Counter[tuple[str, int]](),
        dict[tuple[str, int], list[int]](),
    )
    for each in sorted(folder.rglob("*.gcda")):
        command = ["gcov", "--json-format", "--stdout", "--branch-probabilities", str(each)]
        done = subprocess.run(command, cwd=folder, capture_output=True, check=False)
        for text in done.stdout.splitlines():
            for source in json.loads(text)["files"]:
                if source["file"].startswith(tuple(f"{library}/{name}/" for name in MEASURED)):
                    _add(lines, branches, source["file"].removeprefix(f"{library}/"), source["lines"])
    rows = []
    for name in sorted({name for name, _ in lines}):
        of_lines = [count for (file, _), count in lines.items() if file == name]
        of_branches = [count for (file, _), counts in branches.items() if file == name for count in counts]
        rows.append(Row(name, reached(of_lines), len(of_lines), reached(of_branches), len(of_branches)))
    return Coverage(rows)


def reached(counts: Iterable[int]) -> int:
    """Return how many counts are above 0."""
    return sum(count > 0 for count in counts)


def decisions(branches: list[dict[str, Any]]) -> list[int]:
    """Return how often each way out of the conditions of a line was taken.

    gcov has two more for each call that may throw: to the next statement, and behind it the exception's.

    Args:
        branches: the branches of a line in gcov's JSON, in their order.
    """
    throws = [each["throw"] for each in branches]
    of_calls = [is_throw or follows for is_throw, follows in zip(throws, [*throws[1:], False], strict=False)]
    return [each["count"] for each, is_of_call in zip(branches, of_calls, strict=True) if not is_of_call]


def _add(lines: Counter[tuple[str, int]], branches: dict[tuple[str, int], list[int]], name: str, found: Any) -> None:
    for line in found:
        place = name, line["line_number"]
        lines[place] += line["count"]
        taken = decisions(line["branches"])
        known = branches.setdefault(place, [])
        for at, count in enumerate(taken):
            if at < len(known):
                known[at] += count
            else:
                known.append(count)


def main(arguments: list[str]) -> int:
    """Print the coverage. Returns 1 if it is below `LEAST`, or a test fails."""
    parser = argparse.ArgumentParser(prog="python -m dev.roscfe.coverage", description=main.__doc__)
    parser.add_argument("tests", nargs="*", default=TESTS, metavar="TEST", help="tests of pytest (default: TESTS)")
    parser.add_argument("--files", action="store_true", help="print a row for each file")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="a new folder that keeps the objects")
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as scratch:
        folder = (given.keep or Path(scratch)).resolve()
        folder.mkdir(exist_ok=True)
        status, found = measure(folder, list(given.tests))
    if given.files:
        for each in found.rows:
            print(f"{each.lines:5} of {each.all_lines:5} {each.branches:5} of {each.all_branches:5}  {each.name}")
    print(f"{found.lines:.1f} % of lines, {found.branches:.1f} % of branches")
    return 1 if status or min(found.lines, found.branches) < LEAST else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
