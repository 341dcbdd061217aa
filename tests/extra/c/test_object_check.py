"""Findings of `cfepy check` about compiled applications."""

from __future__ import annotations

import platform
import re
from pathlib import Path

import pytest

from cfepy.pilot.mission_check import check_mission
from tests.extra.c.building import compile_c, console_of, fly, needs_compiler, write_mission

pytestmark = needs_compiler

needs_x86 = pytest.mark.skipif(platform.machine() != "x86_64", reason="machine code of x86-64 is searched")
GOOD = "void TEST_Main(void) { OS_TaskDelay(1); }"


def problems(folder: str) -> list[str]:
    return [each.text for each in check_mission(folder)]


def test_valid_application_has_no_problem(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", GOOD)
    assert problems(write_mission(tmp_path, "TEST")) == []


def test_missing_entry_point_is_reported(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", "void TEST_Mian(void) {}")
    [text] = problems(write_mission(tmp_path, "TEST"))
    assert "TEST.so has no function TEST_Main" in text
    assert "TEST_Mian" in text


def test_undefined_functions_are_reported(tmp_path: Path) -> None:
    names = [f"NONE_{number}" for number in range(10, 30)]
    calls = "".join(f"extern int {name}(void); {name}();" for name in (*names, "fork"))
    compile_c(tmp_path, "TEST", f"void TEST_Main(void) {{ {calls} }}")
    text, refused = problems(write_mission(tmp_path, "TEST"))
    listed = ", ".join(f"{each} (TEST.c:1)" for each in names)
    assert f"TEST needs {listed}, but cfepy and the libraries of the mission do not define them" in text
    assert "TEST needs fork (TEST.c:1), but a flight computer has no processes" in refused


@needs_x86
@pytest.mark.parametrize("flags", [["-O0"], ["-O2"], ["-O2", "-fno-plt"], ["-fcf-protection=none"]])
def test_first_call_of_each_refused_function_has_its_line(flags: list[str], tmp_path: Path) -> None:
    source = """\
        int fork(void);
        int system(const char *text);
        int pause(void);
        static int kept(void) { return fork(); }
        int (*later)(void) = pause;
        int TEST_Tail(void)
        {
            return system("one");
        }
        void TEST_Main(void) { if (kept() == 7) TEST_Tail(); system("two"); }
    """
    compile_c(tmp_path, "TEST", source, *flags)
    text = "\n".join(problems(write_mission(tmp_path, "TEST")))
    assert re.search(r"needs fork \(TEST\.c:4\), but", text)
    assert re.search(r"needs system \(TEST\.c:8\), but", text)
    assert "needs pause, but" in text  # its address alone is taken


def test_calls_without_debug_data_have_no_line(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", "int fork(void); void TEST_Main(void) { fork(); }", "-g0")
    assert "TEST needs fork, but" in problems(write_mission(tmp_path, "TEST"))[0]


def test_library_loaded_too_late_is_reported(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", "int LIB_One(void); void TEST_Main(void) { LIB_One(); }")
    compile_c(tmp_path, "lib", "int LIB_One(void) { return 1; }")
    folder = write_mission(tmp_path, "TEST", libraries="CFE_LIB, lib, NULL, LIB, 0, 0, 0x0, 0;\n")
    assert problems(folder) == []
    script = tmp_path / "startup.scr"
    first, second, end = script.read_text(encoding="utf-8").splitlines()
    script.write_text("\n".join((second, first, end)), encoding="utf-8")
    [text] = problems(folder)
    assert "TEST needs LIB_One of the library LIB, which line 2 loads later" in text


@pytest.mark.parametrize(
    ("at", "change", "what"),
    [
        (18, b"\x28\x00", "a 64-bit little-endian file for"),
        (4, b"\x01", "a 32-bit little-endian file for"),
        (16, b"\x02\x00", "is not a shared object"),
        (32, b"\xff\xff\xff", "TEST.so"),
    ],
)
def test_file_for_another_computer_or_damaged_file_is_reported(
    tmp_path: Path, at: int, change: bytes, what: str
) -> None:
    made = compile_c(tmp_path, "TEST", GOOD)
    data = bytearray(made.read_bytes())
    data[at : at + len(change)] = change
    made.write_bytes(data)
    assert what in problems(write_mission(tmp_path, "TEST"))[0]


def test_an_elf_file_never_falls_back_to_a_python_application(tmp_path: Path) -> None:
    (tmp_path / "hk.so").write_bytes(b"\x7fELF, but not more")
    folder = write_mission(tmp_path, "hk")
    assert "hk.so" in problems(folder)[0]


TABLES = """
    typedef struct { uint32_t id; } CFE_TBL_HandleId_t;
    typedef HANDLE CFE_TBL_Handle_t;
    int32_t CFE_TBL_Update(CFE_TBL_Handle_t);
    static CFE_TBL_Handle_t handle;
    void TEST_Main(void) { CFE_TBL_Update(handle); }
"""
HANDLES = {False: "int16_t", True: "CFE_TBL_HandleId_t"}
OMITS = "compiled: {{omit_deprecated: {}}}\n"


@pytest.mark.parametrize("of_file", [False, True])
@pytest.mark.parametrize("of_mission", [None, False, True])
def test_object_of_the_other_abi_profile_is_reported(tmp_path: Path, of_file: bool, of_mission: bool | None) -> None:
    made = compile_c(tmp_path, "TEST", TABLES, f"-DHANDLE={HANDLES[of_file]}")
    folder = write_mission(tmp_path, "TEST")
    if of_mission is not None:
        (tmp_path / "mission.yaml").write_text(OMITS.format(str(of_mission).lower()), encoding="utf-8")
    found = check_mission(str(tmp_path / "startup.scr"))
    console = console_of(fly(folder, 1))
    if of_file is bool(of_mission):
        assert found == []
        assert "OMIT_DEPRECATED" not in console
        return
    [problem] = found
    assert not problem.is_warning
    assert problem.file == made
    word = str(of_file).lower()
    assert problem.text.startswith(f"was built with OMIT_DEPRECATED={word}, where handles of tables are")
    assert f"add `compiled: {{omit_deprecated: {word}}}` to the mission file" in problem.text
    assert f"OS_ModuleLoad: /cf/TEST.so was built with OMIT_DEPRECATED={word}" in console


def test_unknown_abi_profile_is_a_warning_when_debug_data_is_missing(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", TABLES, "-DHANDLE=int16_t", "-g0")
    folder = write_mission(tmp_path, "TEST")
    [problem] = check_mission(folder)
    assert problem.is_warning
    assert "cannot determine whether TEST.so have OMIT_DEPRECATED" in problem.text
    (tmp_path / "mission.yaml").write_text(OMITS.format("false"), encoding="utf-8")
    assert check_mission(folder) == []


def test_object_that_was_built_for_cfe_6_is_named(tmp_path: Path) -> None:
    compile_c(tmp_path, "OLD", "int CFE_SB_RcvMsg(void *, int, int);\nvoid OLD_Main(void) { CFE_SB_RcvMsg(0, 0, 0); }")
    found = [each.text for each in check_mission(write_mission(tmp_path, "OLD"))]
    assert any("because it was built for cFE 6; build its sources with cfepy build --cfe 6.5" in each for each in found)
