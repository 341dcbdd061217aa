"""Tests of GoogleTest as nodes: they are compiled together with GoogleTest's sources, as the computer has them.

What such a program asks of an operating system, and the file with what came of its tests, is in `roscfe/gtest`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from cfepy.extra.convert.packages import Program
from cfepy.reading.resources import shipped
from cfepy.status import UsageError

PLACES = ("/usr/src/googletest/googletest", "/usr/src/gtest")
"""Where distributions put the sources."""
ROOT = "GTEST_ROOT"
"""The environment variable that says where else they are, as it does for CMake."""
SOURCE, MAIN, MOCK = "src/gtest-all.cc", "src/gtest_main.cc", "src/gmock-all.cc"
DEFINITIONS = ("GTEST_HAS_PTHREAD=0",)
"""The file of the flight computer with what came of the tests."""


def uses_google_test(missing: Iterable[str]) -> bool:
    """Whether sources include GoogleTest's headers.

    Args:
        missing: headers that are not near by.
    """
    return any(each.startswith(("gtest/", "gmock/")) for each in missing)


def add_google_test(program: Program, missing: Iterable[str]) -> None:
    """Make GoogleTest a part of a program.

    Args:
        program: the test.
        missing: headers that are not near by.

    Raises:
        UsageError: GoogleTest is not there.
    """
    folder = google_test_folder()
    parts = [folder]
    if any(each.startswith("gmock/") for each in missing):
        parts.append(folder.parent / "googlemock")
        program.support.append(parts[1] / MOCK)
    if {"gtest_main", "gmock_main"} & set(program.outside):
        program.sources.append(folder / MAIN)
    for each in parts:
        program.includes += [each / "include", each]
    program.definitions += DEFINITIONS
    own = shipped("roscfe") / "gtest"
    program.support += [folder / SOURCE, own / "results.cpp", own / "host.cpp"]


def google_test_folder() -> Path:
    """Where the sources of GoogleTest are.

    Raises:
        UsageError: they are not there.
    """
    said = os.environ.get(ROOT)
    for place in (said,) if said else PLACES:
        for folder in (Path(place), Path(place) / "googletest"):
            if (folder / SOURCE).is_file():
                return folder
    text = "are not installed; tests in C++ require them (on Debian `apt-get install libgtest-dev`)"
    raise UsageError(
        f"the sources of GoogleTest {text}. Install them, or set {ROOT} to their folder [gtest]", file=said
    )
