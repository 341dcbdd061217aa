"""Tracebacks of faults in C: all calls on the stack, from the main function on."""

from __future__ import annotations

import platform
import re
from pathlib import Path

import pytest

from cfepy.mission import Mission, app_traceback, reason
from cfepy.writing.console import Console
from tests.extra.c.building import compile_c, compile_cpp, fly, needs_compiler, needs_cpp, write_mission

pytestmark = needs_compiler

IS_ARM = platform.machine() == "aarch64"
FRAME = re.compile(r'File "([^"]*)", line (\d+), in (\S+)')
KEPT = "__attribute__((noinline, noclone))"
DEEP = f"""static {KEPT} int five(volatile int *at, int n) {{ return *at + n; }}
static {KEPT} int four(volatile int *at, int n) {{ return five(at, n) * 2; }}
static {KEPT} int three(volatile int *at, int n) {{
    volatile int room[n];
    room[n - 1] = n;
    return four(at, n) + room[n - 1];
}}
static {KEPT} int two(volatile int *at, int n) {{
    _Alignas(64) volatile char wide[64] = {{0}};
    return three(at, n) + wide[n];
}}
static {KEPT} int one(volatile int *at, int n) {{ return two(at, n) + 1; }}
void TEST_Main(void)
{{
    SAY("%d", one((int *)16, 5));
}}
"""


def frames(folder: Path, source: str, *flags: str, tasks: str = "thread") -> list[tuple[str, str, int]]:
    """(function, file, line) of the traceback of an application's fault, the outermost first."""
    compile_c(folder, "TEST", source, "-w", *flags)
    return shown(fly(write_mission(folder, "TEST"), 1, tasks))


def shown(mission: Mission) -> list[tuple[str, str, int]]:
    error = mission.cfe.es.history["TEST"].last_error
    assert error is not None
    found = FRAME.findall(app_traceback(error))
    return [(function, Path(file).name, int(line)) for file, line, function in found]


@pytest.mark.parametrize(
    "flags",
    [
        "-O2",
        pytest.param("-O0", marks=pytest.mark.slow),
        pytest.param("-O2 -fomit-frame-pointer -fPIC -fno-plt", marks=pytest.mark.slow),
        pytest.param("-O1 -fno-omit-frame-pointer", marks=pytest.mark.slow),
    ],
)
def test_a_fault_five_calls_deep(tmp_path: Path, flags: str) -> None:
    names = ["TEST_Main", "one", "two", "three", "four", "five"]
    lines = [15, 12, 10, 6, 2, 1]
    found = frames(tmp_path, DEEP, *flags.split())
    assert found == [(name, "TEST.c", line) for name, line in zip(names, lines, strict=True)]


@pytest.mark.slow
def test_names_come_from_symbols_when_debug_data_is_missing(tmp_path: Path) -> None:
    found = frames(tmp_path, DEEP, "-O2", "-g0")
    assert [name.partition("+")[0] for name, _, _ in found] == ["TEST_Main", "one", "two", "three", "four", "five"]
    assert {(file, line) for _, file, line in found} == {("TEST.so", 0)}


@pytest.mark.slow
def test_a_fault_in_a_callback_shows_both_stacks(tmp_path: Path) -> None:
    source = f"""static {KEPT} int look(int *data) {{ return data[1 << 28]; }}
    static int32_t validate(void *data) {{ return look(data) + 1; }}
    static {KEPT} void load(int16_t handle) {{
        int table[4] = {{1}};
        CFE_TBL_Load(handle, 1, table);
        SAY("not here");
    }}
    void TEST_Main(void)
    {{
        int16_t handle;
        CFE_TBL_Register(&handle, "TABLE", 16, 0, validate);
        load(handle);
        SAY("nor here");
    }}
    """
    lines = {"TEST_Main": 12, "load": 5, "validate": 2, "look": 1}
    assert frames(tmp_path, source) == [(name, "TEST.c", line) for name, line in lines.items()]


@pytest.mark.slow
@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_endless_loop_shows_its_function_and_line(tmp_path: Path, tasks: str) -> None:
    source = f"""static volatile int turns, ends;
    static {KEPT} void turn(void) {{ while (!ends) turns++; }}
    static {KEPT} void work(void) {{ turn(); turns = 0; }}
    void TEST_Main(void)
    {{
        SAY("begins");
        work();
        SAY("never");
    }}
    """
    compile_c(tmp_path, "TEST", source, "-w")
    lines: list[str] = []
    console = Console(sink=lines.append)
    with Mission(write_mission(tmp_path, "TEST"), console=console, tasks=tasks) as mission:
        mission.stall_watch.limit_s = 1
        mission.run_for(1)
        where = "stopped in TEST_Main (TEST.c:7) > work (TEST.c:3) > turn (TEST.c:2)"
        assert where in lines
        assert where not in mission.console.lines  # nor in the trace: the address may be different the next time
        assert shown(mission) == [("TEST_Main", "TEST.c", 6)]
        error = mission.cfe.es.history["TEST"].last_error
        assert error is not None
        assert reason(error) == "CFault: runaway loop: no call for 0.5 s, in TEST_Main (TEST.c:6)"


@pytest.mark.slow
def test_fault_in_an_interrupted_loop_shows_its_calls(tmp_path: Path) -> None:
    source = f"""static volatile long turns;
    static {KEPT} long turn(long n) {{
        for (long i = 0; i < n; i++)
            if (++turns == 60000000)
                *(volatile int *)16 = 1;
        return n;
    }}
    static {KEPT} long work(long n) {{ long done = 0; while (done < 4 * n) done += turn(n); return done; }}
    void TEST_Main(void)
    {{
        SAY("%ld", work(25000000));
    }}
    """
    lines = {"TEST_Main": 11, "work": 8, "turn": 5}
    assert frames(tmp_path, source, "-O1") == [(name, "TEST.c", line) for name, line in lines.items()]


BROKEN = {
    "overwritten": "for (volatile int i = 0; i < 40; i++) room[i] = 0x4141414141414141;",
    "zeros": "for (volatile int i = 0; i < 40; i++) room[i] = 0;",
    "itself": "for (volatile int i = 0; i < 40; i++) room[i] = (uint64_t)room;",
}


@pytest.mark.slow
@pytest.mark.parametrize("how", BROKEN)
def test_overwritten_stack_ends_the_traceback(tmp_path: Path, how: str) -> None:
    source = f"""static {KEPT} int inner(int *at) {{ return *at + 1; }}
    static {KEPT} int break_it(uint64_t *room) {{ {BROKEN[how]} return inner((int *)16); }}
    static {KEPT} int holds(void) {{ uint64_t room[4]; return break_it(room) + room[2]; }}
    void TEST_Main(void)
    {{
        volatile char below[1024];
        below[0] = holds();
    }}
    """
    names = [name for name, _, _ in frames(tmp_path, source, "-O1", "-fno-stack-protector")]
    own = (
        ["TEST_Main"] if IS_ARM else []
    )  # there, return addresses are below the variables: its caller's is written over
    assert names == [*own, "holds", "break_it", "inner"]


@pytest.mark.slow
def test_return_to_an_invalid_address_shows_the_address(tmp_path: Path) -> None:
    source = f"""static {KEPT} void break_it(uint64_t *room) {{ for (int i = 0; i < 40; i++) room[i] = 0x10; }}
    static {KEPT} int holds(void) {{ uint64_t room[4]; break_it(room); return room[2]; }}
    void TEST_Main(void)
    {{
        volatile char below[1024];
        below[0] = holds();
    }}
    """
    compile_c(tmp_path, "TEST", source, "-w", "-O1", "-fno-stack-protector")
    error = fly(write_mission(tmp_path, "TEST"), 1).cfe.es.history["TEST"].last_error
    assert "SIGSEGV" in str(error)
    assert "address 0x10" in str(error)


@pytest.mark.slow
def test_runaway_recursion_shows_its_first_and_last_calls(tmp_path: Path) -> None:
    source = f"""static volatile int zero;
    static {KEPT} int deep(int n) {{ return n + deep(n + 1) + zero; }}
    void TEST_Main(void) {{ zero = deep(0); }}
    """
    compile_c(tmp_path, "TEST", source, "-w")
    error = fly(write_mission(tmp_path, "TEST"), 1).cfe.es.history["TEST"].last_error
    text = app_traceback(error) if error is not None else ""
    assert "stack overflow in deep (TEST.c:2)" in text
    assert text.count("in TEST_Main") == 1
    assert "[Previous line repeated 28 more times]" in text


@pytest.mark.slow
@needs_cpp
def test_uncaught_exception_shows_the_function_that_threw_it(tmp_path: Path) -> None:
    source = f"""#include <stdexcept>
    static {KEPT} int pump(int fuel) {{ if (fuel < 9) throw std::runtime_error("no fuel"); return fuel; }}
    static {KEPT} int burn(int fuel) {{ return pump(fuel) + 1; }}
    extern "C" void TEST_Main()
    {{
        SAY("%d", burn(1));
    }}
    """
    compile_cpp(tmp_path, "TEST", source)
    found = [each for each in shown(fly(write_mission(tmp_path, "TEST"), 1)) if each[1] == "TEST.cpp"]
    assert found == [("TEST_Main", "TEST.cpp", 6), ("_ZL4burni", "TEST.cpp", 3), ("_ZL4pumpi", "TEST.cpp", 2)]
