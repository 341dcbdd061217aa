"""GoogleTest programs as nodes, compiled together with the GoogleTest sources of the computer.

The operating system functions of such a program, and the file with its test results, are in `roscfe/gtest`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from cfepy.extra.convert.cpp_package import Program
from cfepy.reading.resources import shipped
from cfepy.status import UsageError

PLACES = ("/usr/src/googletest/googletest", "/usr/src/gtest")
"""Folders in which distributions put the sources."""
ROOT = "GTEST_ROOT"
"""The environment variable with another folder of the sources, as for CMake."""
SOURCE, MAIN, MOCK = "src/gtest-all.cc", "src/gtest_main.cc", "src/gmock-all.cc"
DEFINITIONS = ("GTEST_HAS_PTHREAD=0",)
"""The file of the flight computer with the results of the tests."""


def uses_google_test(missing: Iterable[str]) -> bool:
    """Return True if sources include GoogleTest's headers.

    Args:
        missing: headers that nearby packages do not have.
    """
    return any(each.startswith(("gtest/", "gmock/")) for each in missing)


def add_google_test(program: Program, missing: Iterable[str]) -> None:
    """Add GoogleTest to a program.

    Args:
        program: the test.
        missing: headers that nearby packages do not have.

    Raises:
        UsageError: GoogleTest is not installed.
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
    """Return the folder of GoogleTest's sources.

    Raises:
        UsageError: they are not installed.
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
