"""Symbols of several objects, as Linux links them: undefined names, and names that a library has as well."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.extra.c.building import compile_c, console_of, fly, needs_compiler, said, write_mission

pytestmark = needs_compiler
LIBRARY = "CFE_LIB, ONE, ONE_Init, ONE, 0, 0, 0x0, 0;\n"
ONE = """
    const char *who(void) { return "one"; }
    int number = 1;
    int weak_number = 1;
    int32_t ONE_Init(void) { return 0; }
"""
TEST = """
    const char *who(void) { return "two"; }
    int number = 2;
    __attribute__((weak)) int weak_number = 2;
    static int mine(void) { return 2; }
    void TEST_Main(void)
    {
        SAY("%s %d %d %d", who(), number, weak_number, mine());
        OS_TaskDelay(9000);
    }
"""
UNDEFINED = """
    int nowhere(void), fork(void);
    void TEST_Main(void)
    {
        volatile int never = 0;
        SAY("runs");
        if (never)
            SAY("%d", CALL());
        OS_TaskDelay(9000);
    }
"""


def test_an_application_uses_the_symbols_of_a_library_in_place_of_its_own(tmp_path: Path) -> None:
    compile_c(tmp_path, "ONE", ONE)
    compile_c(tmp_path, "TEST", TEST)
    console = console_of(fly(write_mission(tmp_path, "TEST", libraries=LIBRARY)))
    assert said(console) == ["one 1 1 2"]
    assert "OS_ModuleLoad: /cf/TEST.so uses number, weak_number, who of a library in place of its own" in console


def test_an_application_alone_uses_its_own_symbols(tmp_path: Path) -> None:
    compile_c(tmp_path, "ONE", ONE.replace("ONE_Init(void) {", "ONE_Main(void) { OS_TaskDelay(9000);"))
    compile_c(tmp_path, "TEST", TEST)
    console = console_of(fly(write_mission(tmp_path, "ONE", "TEST")))
    assert said(console) == ["two 2 2 2"]
    assert "in place of its own" not in console


def test_an_object_with_a_name_that_is_defined_nowhere_is_not_loaded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    compile_c(tmp_path, "TEST", UNDEFINED, "-DCALL=nowhere")
    folder = write_mission(tmp_path, "TEST")
    console = console_of(fly(folder))
    assert "OS_ModuleLoad: Error loading shared library: /cf/TEST.so: undefined symbol: nowhere" in console
    assert "CFE_ES_LoadModule: Could not load file:/cf/TEST.so. EC = -1" in console
    assert said(console) == []
    assert main(["check", folder]) == 1
    assert "it cannot be loaded without nowhere" in capsys.readouterr().out


def test_an_object_with_a_name_that_only_linux_has_is_loaded(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", UNDEFINED, "-DCALL=fork")
    console = console_of(fly(write_mission(tmp_path, "TEST")))
    assert "/cf/TEST.so has undefined symbols: fork" in console
    assert said(console) == ["runs"]
