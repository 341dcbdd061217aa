"""The heap of nodes in the profiles pool and strict: alignment, refusals, and the C functions that allocate from it."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from cfepy.extra.convert.build import OWN_CPP_LIBRARY, WITH_ARENA, BuildOptions, profile_flags
from cfepy.extra.convert.message_headers import Profile
from dev.roscfe.building import ROSCFE, STRICT_FLAGS, compile_objects, link_program, needs_cpp

pytestmark = [pytest.mark.slow, needs_cpp]
PROGRAM = Path(__file__).parent / "heap.cpp"
NO_WARNINGS = ("-Wno-alloc-size-larger-than", "-Wno-unused-result")
THROWN = (
    *(
        "vector::at",
        "bad_alloc",
        "bad_array_new_length",
        "bad_cast",
        "bad_exception",
        "bad_function_call",
        "bad_typeid",
    ),
    *("logic_error", "domain_error", "invalid_argument", "length_error", "out_of_range"),
    *("runtime_error", "range_error", "overflow_error", "underflow_error", "allocate", "allocate dependent"),
)
Run = Callable[[str], list[str]]


@pytest.fixture(scope="module", params=[Profile.POOL, Profile.STRICT], ids=["pool", "strict"])
def profile(request: pytest.FixtureRequest) -> Profile:
    found: Profile = request.param
    return found


@pytest.fixture(scope="module")
def run(profile: Profile, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Return a function that runs a case and returns its output lines."""
    made = tmp_path_factory.mktemp("heap") / "heap"
    base = [*STRICT_FLAGS, *NO_WARNINGS, *profile_flags(BuildOptions(profile)), "-O1"]
    objects = compile_objects(made, [ROSCFE / "src/heap.cpp", ROSCFE / "src/throwing.cpp"], base=base)
    objects += compile_objects(made.with_name("case"), [PROGRAM], base=base)
    link_program(made, objects, *WITH_ARENA, *OWN_CPP_LIBRARY)

    def run(case: str) -> list[str]:
        done = subprocess.run(
            [str(made), case], input="line\n", capture_output=True, text=True, check=False, timeout=20
        )
        assert done.returncode == 0, (done.returncode, done.stdout, done.stderr)
        return done.stdout.splitlines()

    return run


def failures(lines: list[str]) -> list[str]:
    """Return the lines that report a failed check."""
    return [line for line in lines if line.endswith(" 0")]


@pytest.mark.parametrize("case", ["aligned", "c", "given back", "resized", "too large"])
def test_heap_returns_aligned_memory_or_null(run: Run, case: str) -> None:
    lines = run(case)
    assert failures(lines) == []
    assert lines[-1] == "done"


def test_full_arena_returns_null_and_then_ends_the_node(run: Run) -> None:
    *before, last = run("full")
    assert failures(before) == []
    assert len(before) == 6
    assert last == "refused: the node's arena is full: build it with a larger ROSCFE_ARENA_BYTES"


@pytest.mark.parametrize("case", ["negative", "half", "wide"])
def test_impossible_size_ends_the_node(run: Run, case: str) -> None:
    assert run(case)[-1] == "refused: the arena has no room: a block is larger than any arena"


@pytest.mark.parametrize("case", THROWN)
def test_exception_of_the_cpp_library_ends_the_node(run: Run, case: str) -> None:
    assert run(case)[-1] == "refused: exception: a function of the C++ library has thrown one"


@pytest.mark.parametrize("case", ["pure", "deleted"])
def test_virtual_function_without_a_body_ends_the_node(run: Run, case: str) -> None:
    assert run(case)[-1] == f"refused: exception: a {case} virtual function was called"


def test_memory_of_an_exception_is_never_given_back(run: Run) -> None:
    assert run("free")[-1] == "done"


def test_strict_node_cannot_allocate_after_its_start(run: Run, profile: Profile) -> None:
    lines = run("sealed")[1:]
    if profile is Profile.POOL:
        assert lines == ["nothrow 1, counted 1", "malloc 1", "done"]
    else:
        refused = "refused: memory was allocated after initialisation: the profile is strict"
        assert lines == ["nothrow 0, counted 0", refused]
