"""What `cfepy check` tells of compiled applications."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.pilot.check import check_mission
from tests.c.building import compile_c, needs_compiler, write_mission

pytestmark = needs_compiler

GOOD = "void TEST_Main(void) { OS_TaskDelay(1); }"


def problems(folder: str) -> list[str]:
    return [each.text for each in check_mission(Path(folder) / "startup.scr")]


def test_a_good_one_has_no_problem(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", GOOD)
    assert problems(write_mission(tmp_path, "TEST")) == []


def test_an_entry_point_that_is_not_there(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", "void TEST_Mian(void) {}")
    [text] = problems(write_mission(tmp_path, "TEST"))
    assert "TEST.so has no function TEST_Main" in text
    assert "TEST_Mian" in text


def test_functions_that_nobody_has(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", "int NONE_One(void); int fork(void); void TEST_Main(void) { NONE_One(); fork(); }")
    [text] = problems(write_mission(tmp_path, "TEST"))
    assert "TEST needs NONE_One, fork, which neither cfepy nor a library of the mission has" in text


def test_a_library_that_is_loaded_too_late(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", "int LIB_One(void); void TEST_Main(void) { LIB_One(); }")
    compile_c(tmp_path, "lib", "int LIB_One(void) { return 1; }")
    folder = write_mission(tmp_path, "TEST", libraries="CFE_LIB, lib, NULL, LIB, 0, 0, 0x0, 0;\n")
    assert problems(folder) == []
    script = tmp_path / "startup.scr"
    first, second, end = script.read_text().splitlines()
    script.write_text("\n".join((second, first, end)))
    [text] = problems(folder)
    assert "TEST needs LIB_One of the library LIB, which line 2 loads later" in text


@pytest.mark.parametrize(
    ("at", "change", "what"),
    [
        (18, b"\x28\x00", "a 64-bit little-endian file for"),
        (4, b"\x01", "a 32-bit little-endian file for"),
        (16, b"\x02\x00", "is no shared object"),
        (32, b"\xff\xff\xff", "TEST.so"),
    ],
)
def test_a_file_for_another_computer_or_a_damaged_one(tmp_path: Path, at: int, change: bytes, what: str) -> None:
    made = compile_c(tmp_path, "TEST", GOOD)
    data = bytearray(made.read_bytes())
    data[at : at + len(change)] = change
    made.write_bytes(data)
    assert what in problems(write_mission(tmp_path, "TEST"))[0]


def test_an_elf_file_never_falls_back_to_a_python_application(tmp_path: Path) -> None:
    (tmp_path / "hk.so").write_bytes(b"\x7fELF, but not more")
    folder = write_mission(tmp_path, "hk")
    assert "hk.so" in problems(folder)[0]
