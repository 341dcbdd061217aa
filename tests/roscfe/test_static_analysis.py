"""The interface library under the compiler's stricter warnings, clang-tidy and cppcheck.

`clang_tidy.yaml` gives each rule of clang-tidy that the library does not follow, and why; `cppcheck.txt` does so for
cppcheck. `CFEPY_CLANG_TIDY=all` lets clang-tidy read all sources.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from cfepy.extra.c import headers_folder
from cfepy.extra.convert.build import BuildOptions, library_folder, library_includes, profile_flags
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
EVERYTHING = os.environ.get("CFEPY_CLANG_TIDY") == "all"
"""Whether clang-tidy reads all sources, for three minutes. Otherwise it reads those that take packets from the bus."""
READERS = (
    *("core/bus.cpp", "core/topics.cpp", "subscribers.cpp", "services.cpp", "long_messages.cpp"),
    *("master.cpp", "parameter_server.cpp", "ground.cpp", "sim_time.cpp", "tf/listening.cpp"),
)
PARTS = 2
THREADS = re.compile(
    r"std::(?:jthread|thread|async|atomic|mutex|recursive_mutex)|thread_local|pthread_\w+|OS_TaskCreate"
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
    return ["-std=c++17", *includes, *system, *profile_flags(BuildOptions(profile))]


@pytest.mark.parametrize("profile", [Profile.HOST, Profile.STRICT])
def test_compiler_has_no_warning(profile: Profile, tmp_path: Path) -> None:
    given = [*CPP, "-fsyntax-only", "-O1", *WARNINGS, *flags(tmp_path, profile)]
    for source in SOURCES:
        done = subprocess.run([*given, str(source)], capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, ""), source


@pytest.mark.skipif(shutil.which("clang-tidy") is None, reason="there is no clang-tidy")
@pytest.mark.parametrize("part", range(PARTS))
def test_clang_tidy_has_no_finding(part: int, tmp_path: Path) -> None:
    checked = SOURCES if EVERYTHING else [library_folder() / "src" / name for name in READERS]
    command = ["clang-tidy", f"--config-file={FOLDER / 'clang_tidy.yaml'}", "--quiet"]
    command += [f"--header-filter={library_folder()}/(include|src)/.*", *map(str, checked[part::PARTS]), "--"]
    done = subprocess.run(
        [*command, *flags(tmp_path, Profile.HOST), "-fno-rtti"], capture_output=True, text=True, check=False
    )
    assert sorted(set(REPORT.findall(done.stdout))) == []
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(shutil.which("cppcheck") is None, reason="there is no cppcheck")
def test_cppcheck_has_no_finding() -> None:
    command = [
        "cppcheck",
        "--enable=warning,performance,portability",
        "--std=c++17",
        "--language=c++",
        "--max-configs=1",
    ]
    command += [f"-I{each}" for each in library_includes()]
    command += ["--quiet", "-DROSCFE_PROFILE_STRICT", f"--suppressions-list={FOLDER / 'cppcheck.txt'}"]
    done = subprocess.run([*command, str(library_folder() / "src")], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_only_some_parts_know_threads() -> None:
    """Threads of a node take turns, so the other parts have no state that two tasks use at once."""
    found = {
        str(each.relative_to(library_folder()))
        for name in ("src", "include")
        for each in (library_folder() / name).rglob("*.*")
        if THREADS.search(each.read_text(encoding="utf-8"))
    }
    parts = {f"src/posix/{name}" for name in ("turns.cpp", "threads.cpp", "std_threads.cpp")}
    assert found == {*parts, "include/roscfe/thread_waits.h"}
