"""Layouts of ground names compared with the structs of the compiled application beside them."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.pilot.mission_check import check_mission
from tests.extra.c.building import compile_c, needs_compiler, write_mission

pytestmark = needs_compiler

SOURCE = """
    typedef struct { uint8_t Bytes[8]; } CFE_MSG_CommandHeader_t;
    struct CFE_MSG_TelemetryHeader { uint8_t Bytes[16]; };
    typedef struct CFE_MSG_TelemetryHeader CFE_MSG_TelemetryHeader_t;
    typedef struct { uint32_t Value; } CFE_SB_MsgId_t;
    typedef enum { TEST_Off, TEST_On } TEST_Mode_t;

    typedef struct { uint16_t Low; int16_t High; } TEST_Limits_t;
    typedef struct { CFE_MSG_CommandHeader_t Header; uint16_t Value; uint16_t Spare; } TEST_SetCmd_t;
    typedef struct {
        uint8_t Counter;
        bool IsOn;
        char Name[6];
        TEST_Mode_t Mode;
        CFE_SB_MsgId_t Id;
        TEST_Limits_t Rows[2];
        double Mean;
        uint16_t Grid[2][3];
        union { float Real; uint32_t Word; } Either;
    } TEST_HkTlm_Payload_t;
    typedef struct { CFE_MSG_TelemetryHeader_t Header; TEST_HkTlm_Payload_t Payload; } TEST_HkTlm_t;

    TEST_SetCmd_t set;
    TEST_HkTlm_t hk;
    void TEST_Main(void) { OS_TaskDelay(1); }
"""
IMPORTS = "from cfepy.msg import Layout, ValueNames\nROWS = 2\n"
SET = 'SET = Layout("TEST_SetCmd_t", [("Value", "u16"), ("spare", "u8[2]")])\n'
LIMITS = 'LIMITS = Layout("TEST_Limits_t", [("Low", "u16"), ("High", "i16")])\n'
HK = """
HK = Layout("{}", [
    ("Counter", "u8"),
    ("IsOn", "u8"),
    ("Name", "char[6]"),
    ("Mode", ValueNames("u32", OFF=0, ON=1)),
    ("Id", "u32"),
    ("Rows", (LIMITS, ROWS)),
    ("Mean", "f64"),
    ("Grid", f"u16[{{ROWS}}][3]"),
    ("Either", "u32"),
])
"""


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compile_c(tmp_path_factory.mktemp("ground"), "TEST", SOURCE)


def problems(folder: Path, library: Path, ground: str) -> list[str]:
    """Return the problems of a mission, as line and text."""
    shutil.copy(library, folder)
    (folder / "TEST.py").write_text(ground, encoding="utf-8")
    found = check_mission(write_mission(folder, "TEST"))
    assert all(each.is_warning and each.file.name == "TEST.py" for each in found)
    return [f"{each.line}: {each.text}" for each in found]


@pytest.mark.parametrize("name", ["TEST_HkTlm_t", "TEST_HkTlm_Payload_t"])
def test_equal_layouts_have_no_problem(tmp_path: Path, library: Path, name: str) -> None:
    assert problems(tmp_path, library, IMPORTS + SET + LIMITS + HK.format(name)) == []


def test_measurements_have_the_type_of_their_raw_number(tmp_path: Path, library: Path) -> None:
    measured = 'VALUE = Measurement("{}", "degC", polynomial=(-40.0, 0.1), red=(-20, 60))\n'
    layout = 'SET = Layout("TEST_SetCmd_t", [("Value", VALUE), ("spare", "u16")])\n'
    ground = "from cfepy.msg import Layout, Measurement\n{}" + layout
    assert problems(tmp_path, library, ground.format(measured.format("u16"))) == []
    [problem] = problems(tmp_path, library, ground.format(measured.format("i16")))
    assert problem.startswith("3: TEST_SetCmd_t.Value: is i16 at offset 0 here, but u16 at offset 0 in TEST.so")


REMEDY = "correct the layout, or build again if the header is newer"


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        (
            '("Value", "u16")',
            '("Value", "i16")',
            f"3: TEST_SetCmd_t.Value: is i16 at offset 0 here, but u16 at offset 0 in TEST.so; {REMEDY}",
        ),
        (
            '("Value", "u16")',
            '("Val", "u16")',
            "3: TEST_SetCmd_t.Val: is u16 at offset 0 here, but TEST.so has Value (u16) there; did you mean Value?",
        ),
        (
            ', ("spare", "u8[2]")',
            "",
            f"3: TEST_SetCmd_t: has 2 bytes here, but 4 in TEST.so; {REMEDY}",
        ),
        (
            '    ("Name", "char[6]"),\n',
            "",
            f"5: TEST_HkTlm_t: has no Name (char[6] at offset 2), unlike TEST.so; {REMEDY}",
        ),
        (
            '"char[6]"',
            '"char[2]"',
            f"8: TEST_HkTlm_t.Name: is char[2] at offset 2 here, but char[6] at offset 2 in TEST.so; {REMEDY}",
        ),
        (
            "ROWS = 2",
            "ROWS = 1 + 2",
            f"11: TEST_HkTlm_t.Rows: is TEST_Limits_t[3] at offset 16 here, "
            f"but TEST_Limits_t[2] at offset 16 in TEST.so; {REMEDY}",
        ),
        (
            '("Low", "u16"), ("High", "i16")',
            '("High", "i16"), ("Low", "u16")',
            f"4: TEST_Limits_t.High: is i16 at offset 0 here, but at offset 2 in TEST.so; {REMEDY}",
        ),
        (
            "TEST_SetCmd_t",
            "TEST_SetCmd",
            "3: TEST.so has no struct TEST_SetCmd to compare this layout with; did you mean TEST_SetCmd_t?",
        ),
        (
            '[("Value", "u16"), ("spare", "u8[2]")]',
            "list(FIELDS)",
            "3: the layout cannot be compared with TEST.so; write its fields as a list of names and types",
        ),
    ],
)
def test_difference_is_named_with_line_and_both_sides(
    tmp_path: Path, library: Path, old: str, new: str, text: str
) -> None:
    ground = IMPORTS + SET + LIMITS + HK.lstrip().format("TEST_HkTlm_t")
    assert ground.count(old) == 1
    found = problems(tmp_path, library, ground.replace(old, new))
    assert found[0] == text


def test_object_without_debug_data_is_named(tmp_path: Path) -> None:
    library = compile_c(tmp_path, "TEST", SOURCE, "-g0")
    (tmp_path / "TEST.py").write_text(IMPORTS + SET, encoding="utf-8")
    [problem] = check_mission(write_mission(tmp_path, "TEST"))
    assert (
        problem.text == f"its layouts cannot be compared with {library.name}, which has no debug data; compile with -g"
    )


def test_check_does_not_execute_ground_names(tmp_path: Path, library: Path) -> None:
    ground = f"{IMPORTS}open({str(tmp_path / 'made')!r}, 'w')\n{SET}"
    assert problems(tmp_path, library, ground) == []
    assert not (tmp_path / "made").exists()


def test_build_names_differences(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sources = tmp_path / "fsw" / "src"
    sources.mkdir(parents=True)
    struct = "typedef struct { CFE_MSG_CommandHeader_t Header; uint32 Value; } TEST_SetCmd_t;"
    text = f'#include "cfe.h"\n{struct}\nTEST_SetCmd_t set;\nvoid TEST_Main(void) {{}}\n'
    (sources / "test.c").write_text(text, encoding="utf-8")
    library = tmp_path / "test.so"
    library.with_suffix(".py").write_text(IMPORTS + SET, encoding="utf-8")
    assert main(["build", str(tmp_path), "-o", str(library)]) == 0
    assert "TEST_SetCmd_t.Value: is u16 at offset 0 here, but u32" in capsys.readouterr().err
