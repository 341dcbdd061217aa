"""The interface library under the compiler's stricter warnings and under clang-tidy.

`clang_tidy.yaml` gives each rule of clang-tidy that the library does not follow, and why.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from cfepy.extra.c import headers_folder
from cfepy.extra.convert.build import library_folder, library_includes, profile_flags
from cfepy.extra.convert.cpp_sources import collect, message_types
from cfepy.extra.convert.message_headers import Profile, write_headers
from dev.roscfe.building import CPP, needs_cpp
from dev.roscfe.random_messages import LIBRARY

pytestmark = [pytest.mark.slow, needs_cpp]
FOLDER = Path(__file__).parent
SOURCES = sorted((library_folder() / "src").rglob("*.cpp"))
WARNINGS = (
    *("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wsign-conversion", "-Wshadow", "-Wuseless-cast"),
    "-fno-rtti",
)
REPORT = re.compile(r"^/.*: (?:warning|error): .*\[[\w.,-]+\]$", re.MULTILINE)


def flags(folder: Path, profile: Profile) -> list[str]:
    """Return the flags of a compiler for the library's sources, with the headers of their messages.

    Args:
        folder: an empty folder for those headers.
        profile: the profile.
    """
    types = message_types(collect(SOURCES, library_includes()).missing, LIBRARY)
    write_headers(types, folder, profile, LIBRARY)
    includes = [f"-I{each}" for each in library_includes()]
    system = ["-isystem", str(folder), "-isystem", str(headers_folder())]
    return ["-std=c++17", *includes, *system, *profile_flags(profile)]


@pytest.mark.parametrize("profile", [Profile.HOST, Profile.STRICT])
def test_compiler_has_no_warning(profile: Profile, tmp_path: Path) -> None:
    given = [*CPP, "-fsyntax-only", "-O1", *WARNINGS, *flags(tmp_path, profile)]
    for source in SOURCES:
        done = subprocess.run([*given, str(source)], capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, ""), source


@pytest.mark.skipif(shutil.which("clang-tidy") is None, reason="there is no clang-tidy")
@pytest.mark.parametrize("part", range(4))
def test_clang_tidy_has_no_finding(part: int, tmp_path: Path) -> None:
    command = ["clang-tidy", f"--config-file={FOLDER / 'clang_tidy.yaml'}", "--quiet"]
    command += [f"--header-filter={library_folder()}/(include|src)/.*", *map(str, SOURCES[part::4]), "--"]
    done = subprocess.run(
        [*command, *flags(tmp_path, Profile.HOST), "-fno-rtti"], capture_output=True, text=True, check=False
    )
    assert sorted(set(REPORT.findall(done.stdout))) == []
    assert done.returncode == 0, done.stderr
