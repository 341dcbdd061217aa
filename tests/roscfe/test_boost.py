"""The small Boost beside Boost itself, and the interface library with Boost itself."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from cfepy.extra.convert.message_headers import Profile, write_headers
from dev.roscfe.building import CPP, INCLUDE, ROSCFE, STRICT_FLAGS, SYSTEM, compile_program, needs_cpp
from dev.roscfe.random_messages import LIBRARY

pytestmark = [pytest.mark.slow, needs_cpp]
needs_boost = pytest.mark.skipif(
    not (SYSTEM / "boost" / "thread.hpp").is_file(),
    reason="there is no Boost (Debian: libboost-thread-dev); what its programs print is recorded",
)
FOLDER = Path(__file__).parent
STUBS = FOLDER / "stubs.cpp"
TWICE = """
#include <boost/thread/mutex.hpp>
int main()
{
    boost::mutex                    mutex;
    boost::lock_guard<boost::mutex> one(mutex);
    boost::mutex::scoped_lock       other(mutex);
}
"""


@pytest.mark.parametrize("profile", Profile)
def test_locks_and_arrays_print_the_recorded_output(tmp_path: Path, profile: Profile) -> None:
    sources, flags = [FOLDER / "locks.cpp", STUBS], (f"-DROSCFE_PROFILE_{profile.name}",)
    made = compile_program(tmp_path / "locks", sources, *flags, base=STRICT_FLAGS)
    assert subprocess.check_output([made], text=True) == (FOLDER / "locks.txt").read_text(encoding="utf-8")


@needs_boost
def test_recorded_output_equals_the_output_with_boost(tmp_path: Path) -> None:
    sources, libraries = [FOLDER / "locks.cpp"], ("-lboost_thread", "-lboost_system", "-lpthread")
    made = compile_program(tmp_path / "locks", sources, base=("-std=c++17",), include=(), libraries=libraries)
    assert subprocess.check_output([made], text=True) == (FOLDER / "locks.txt").read_text(encoding="utf-8")


@pytest.mark.parametrize("profile", Profile)
def test_mutex_locked_twice_by_its_owner_ends_the_node(tmp_path: Path, profile: Profile) -> None:
    source = tmp_path / "twice.cpp"
    source.write_text(TWICE, encoding="utf-8")
    made = compile_program(tmp_path / "twice", [source, STUBS], f"-DROSCFE_PROFILE_{profile.name}", base=STRICT_FLAGS)
    done = subprocess.run([made], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout[:21]) == (3, "refused: boost::mutex")


def test_locks_between_threads_have_no_race(tmp_path: Path) -> None:
    """Under ThreadSanitizer, which finds the race if the locks are left out."""
    flags = ("-DROSCFE_PROFILE_HOST", "-O1", "-g1", "-fsanitize=thread")
    sources = [FOLDER / "threads.cpp", STUBS]
    locked = compile_program(tmp_path / "locked", sources, *flags, base=STRICT_FLAGS)
    done = subprocess.run([locked], capture_output=True, text=True, timeout=100, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "8000 8000 1\n", "")
    unlocked = compile_program(tmp_path / "unlocked", sources, *flags, "-DUNLOCKED", base=STRICT_FLAGS)
    done = subprocess.run([unlocked], capture_output=True, text=True, timeout=100, check=False)
    assert done.returncode != 0
    assert "WARNING: ThreadSanitizer: data race" in done.stderr


@needs_boost
def test_interface_library_compiles_with_the_original_boost(tmp_path: Path) -> None:
    include = ROSCFE / "include"
    headers = sorted(str(each.relative_to(include)) for each in include.rglob("*.h"))
    packages = ("std_msgs", "geometry_msgs", "sensor_msgs", "visualization_msgs", "actionlib_msgs", "rosgraph_msgs")
    packages += ("tf2_msgs", "tf", "diagnostic_msgs", "dynamic_reconfigure", "roscpp", "std_srvs")
    kinds = [(name, kind) for name in packages for kind in ("msg", "srv")]
    known = [f"{name}/{each}" for name, kind in kinds for each in LIBRARY.names(name, kind) or ()]
    write_headers(known, tmp_path, Profile.HOST, LIBRARY)
    source = tmp_path / "all.cpp"
    source.write_text(
        "#include <boost/signals2.hpp>\n" + "".join(f"#include <{each}>\n" for each in headers), encoding="utf-8"
    )
    command = [*CPP, "-std=c++17", INCLUDE[0], f"-I{tmp_path}", "-fsyntax-only", str(source)]
    assert subprocess.run(command, capture_output=True, text=True, check=False).returncode == 0
