"""Faults in C code: exceptions of the application, with function, file and line.

They end NASA's process on Linux, except SIGFPE; in a safe mission and on other boards the other applications continue.
"""

from __future__ import annotations

import platform
from pathlib import Path

import pytest

from cfepy.mission import Mission, endless_waits
from cfepy.pilot import problems_of
from cfepy.writing.console import Console
from tests.extra.c.building import compile_c, console_of, fly, fly_c, make_safe, needs_compiler, said, write_mission

pytestmark = needs_compiler

WITNESS = """
    void WITNESS_Main(void)
    {
        uint32_t run = RUN;
        for (int i = 0; CFE_ES_RunLoop(&run); i++) {
            if (i % 10 == 0)
                SAY("witness %d", i);
            OS_TaskDelay(100);
        }
        CFE_ES_ExitApp(run);
    }
"""

IS_ARM = platform.machine() == "aarch64"
FAULTS = {
    "segv": ("*(volatile int *)16 = 1;", "SIGSEGV", "fail (TEST.c:4), address 0x10"),
    "trap": ("__builtin_trap();", "SIGTRAP" if IS_ARM else "SIGILL", "fail (TEST.c:4)"),
    "deep": ("zero = deep(0);", "stack overflow", "deep (TEST.c:2)"),
    "nowhere": (
        "((void (*)(void))(void *)8)();",
        "SIGSEGV",
        "a call by fail (TEST.c:4) of an address that is not a function",
    ),
    "argument": (
        'SAY("%d", (int)CFE_SB_TransmitMsg((void *)0x1234, true));',
        "bad address 0x1234 of a message",
        "in fail (TEST.c:4)",
    ),
    "text": ("zero = strlen((char *)24);", "SIGSEGV", "a function that fail (TEST.c:4) called, address 0x18"),
    "format": ('SAY("%s", (char *)32);', "bad address 0x20 in a format or its arguments", "in fail (TEST.c:4)"),
    "unmapped": (
        "memset((char *)once - ((size_t)1 << 40), 0, 10);",
        "SIGSEGV",
        "a function that fail (TEST.c:4) called",
    ),
    "freed": ("free(once); free(once);", "which malloc did not give, or which was freed", "in fail (TEST.c:4)"),
    "abort": ("abort();", "abort()", "in fail (TEST.c:4)"),
    "nobody": ("fork();", "fork() was called", "in fail (TEST.c:4)"),
}
if not IS_ARM:  # there, an integer divided by zero is 0
    FAULTS["divide"] = ("zero = 5 / zero;", "SIGFPE", "fail (TEST.c:4)")

FAILING = """static volatile int zero; static char *once; int fork(void);
static int deep(int n) { volatile char room[2000]; room[n % 2000] = 1; return n + deep(n + 1) + room[5]; }
static void fail(void) {
    @
}
void TEST_Main(void)
{
    uint32_t run = RUN;
    CFE_ES_RunLoop(&run);
    once = malloc(10);
    OS_TaskDelay(300);
    fail();
    SAY("never %d", zero);
}
"""


@pytest.mark.parametrize("tasks", ["thread", pytest.param("greenlet", marks=pytest.mark.slow)])
@pytest.mark.parametrize("kind", FAULTS)
def test_fault_restarts_the_application_and_others_continue(tmp_path: Path, kind: str, tasks: str) -> None:
    code, what, where = FAULTS[kind]
    compile_c(tmp_path, "TEST", FAILING.replace("@", code), "-O0", "-w")
    compile_c(tmp_path, "WITNESS", WITNESS)
    make_safe(tmp_path)
    mission = fly(write_mission(tmp_path, "TEST", "WITNESS"), 12, tasks)
    console = console_of(mission)
    line = next(line for line in console.splitlines() if "CFE_ES_RunExceptionScan: ExceptionID" in line)
    assert "never 0" not in console  # a traceback may show the line itself
    error = mission.cfe.es.history["TEST"].last_error
    assert what in str(error)
    assert where in str(error)
    assert what[:10] in line
    assert "Restart Application TEST Completed" in console
    assert said(console)[-1] == "witness 110"
    assert not mission.record.resets
    assert mission.cfe.es.history["TEST"].deaths >= 1


def test_fault_resets_the_processor_when_the_startup_script_demands_it(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", FAILING.replace("@", FAULTS["segv"][0]), "-O0", "-w")
    make_safe(tmp_path)
    mission = fly(write_mission(tmp_path, "TEST", action=1), 1.5)
    assert "SIGSEGV" in mission.record.resets[0].reason


GO_ON = ("divide", "nobody")
"""Of FAULTS: NASA's PSP handles SIGFPE, and Linux has a function that cfepy does not have."""


def lives_on(folder: Path, kind: str, board: str = "linux") -> bool:
    """Return whether other applications and the run go on after a fault; the run must fail in any case."""
    compile_c(folder, "TEST", FAILING.replace("@", FAULTS[kind][0]), "-O0", "-w")
    compile_c(folder, "WITNESS", WITNESS)
    mission = fly(write_mission(folder, "TEST", "WITNESS"), 4, board=board)
    told = [each.text for each in problems_of(mission, endless_waits(mission)) if "CFault" in each.text]
    assert told
    assert mission.over == (said(console_of(mission))[-1] == "witness 0")
    assert mission.over == any(each.startswith("the flight software aborts at 0.8") for each in told)
    return not mission.over


@pytest.mark.parametrize("kind", FAULTS)
def test_fault_ends_all_flight_software_as_on_linux_except_sigfpe(tmp_path: Path, kind: str) -> None:
    assert lives_on(tmp_path, kind) == (kind in GO_ON)


def test_fault_ends_only_its_application_on_another_board(tmp_path: Path) -> None:
    assert lives_on(tmp_path, "segv", "workstation") is False
    (tmp_path / "mission.yaml").write_text("memory: ranges\n", encoding="utf-8")
    assert lives_on(tmp_path, "segv")


def test_fault_ends_only_its_application_with_the_guard(tmp_path: Path) -> None:
    (tmp_path / "mission.yaml").write_text("compiled: {guard: true}\n", encoding="utf-8")
    assert lives_on(tmp_path, "segv")


LOOPING = """static volatile long turns;
void TEST_Main(void)
{
    uint32_t run = RUN;
    CFE_ES_RunLoop(&run);
    OS_TaskDelay(300);
    SAY("loops");
    for (;;)
        turns++;
}
"""


@pytest.mark.slow
@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_endless_loop_is_a_fault_of_its_application(tmp_path: Path, tasks: str) -> None:
    compile_c(tmp_path, "TEST", LOOPING)
    compile_c(tmp_path, "WITNESS", WITNESS)
    with Mission(write_mission(tmp_path, "TEST", "WITNESS"), console=Console(quiet=True), tasks=tasks) as mission:
        mission.stall_watch.limit_s = 2
        mission.run_for(12)
        assert mission.record.resets == []
        error = mission.cfe.es.history["TEST"].last_error
        assert "runaway loop: no call for 1 s" in str(error)
        assert "in TEST_Main (TEST.c:7)" in str(error)
        assert said(console_of(mission))[-1] == "witness 110"


def test_long_computation_is_not_a_fault_and_continues(tmp_path: Path) -> None:
    compile_c(
        tmp_path,
        "TEST",
        """
        void TEST_Main(void)
        {
            uint32_t a = 1;
            double x = 1;
            for (uint32_t i = 0; i < 120000000; i++) {
                a = a * 1664525 + 1013904223;
                x = x * 1.0000001 - (a & 1) * 1e-9;
            }
            SAY("%u %.9f", a, x);
        }
        """,
        "-O2",
    )
    with Mission(write_mission(tmp_path, "TEST"), console=Console(quiet=True)) as mission:
        mission.stall_watch.limit_s = 0  # however slow this computer is
        mission.run_for(2)
    console = console_of(mission)
    a, x = 1, 1.0
    step, add, bits = 1664525, 1013904223, 0xFFFFFFFF
    power, total = 1, 0
    for bit in f"{120000000:b}":
        power, total = power * power & bits, (power * total + total) & bits
        if bit == "1":
            power, total = power * step & bits, (total * step + add) & bits
    a = (power * a + total) & bits
    assert said(console)[0].split()[0] == str(a)
    assert float(said(console)[0].split()[1]) > x


def test_fault_in_a_child_task_is_reported_with_its_line(tmp_path: Path) -> None:
    console = fly_c(
        tmp_path,
        """
        static void child(void)
        {
            OS_TaskDelay(50);
            *(volatile int *)NULL = 1;
        }
        void TEST_Main(void)
        {
            uint32_t id, run = RUN;
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);
            while (CFE_ES_RunLoop(&run))
                OS_TaskDelay(100);
            CFE_ES_ExitApp(run);
        }
        """,
        flags=("-w",),
    )
    assert "child (TEST.c:4)" in console


def test_fault_in_a_constructor_is_reported_and_others_continue(tmp_path: Path) -> None:
    compile_c(
        tmp_path,
        "TEST",
        """
        static __attribute__((constructor)) void early(void)
        {
            *(volatile int *)24 = 1;
        }
        void TEST_Main(void) { SAY("never"); }
        """,
        "-w",
    )
    compile_c(tmp_path, "WITNESS", WITNESS)
    console = console_of(fly(write_mission(tmp_path, "TEST", "WITNESS"), 1))
    assert "OS_ModuleLoad: /cf/TEST.so: SIGSEGV" in console
    assert "in early (TEST.c:3), address 0x18" in console
    assert said(console)[-1] == "witness 0"
