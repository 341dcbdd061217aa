"""Nothing of the host affects a run of compiled applications: neither addresses nor registers, stacks or errno."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.c.engine import engine
from tests.extra.c.building import compile_c, compile_cpp, fly_c, needs_compiler, needs_cpp, said, write_mission

pytestmark = needs_compiler

REPOSITORY = Path(__file__).parents[3]
RUBBISH = """
    static __thread int turns;
    static void __attribute__((noinline)) seen(const void *at) { __asm__ volatile("" : : "r"(at) : "memory"); }
    static void __attribute__((noinline)) used(int turn)
    {
        char text[200];
        snprintf(text, sizeof text, "%d %f %m", turn, turn / 3.);
        seen(text);
    }
    static unsigned __attribute__((noinline, optimize("no-stack-protector"))) left(void)
    {
        unsigned char bytes[2000];
        unsigned sum = 0;
        seen(bytes);
        for (size_t i = 0; i < sizeof bytes; i++)
            sum = sum * 31 + bytes[i];
        return sum;
    }
    static void fly(void)
    {
        for (int i = 0; i < 5; i++) {
            used(turns++);
            CFE_EVS_SendEvent(1, 2, "%d: stack %u, local %p, code %p, heap %p, variable %p", i, left(), (void *)&i,
                              (void *)used, malloc(10), (void *)&turns);
            OS_TaskDelay(30);
        }
    }
    void TEST_Main(void)
    {
        uint32_t id, run = RUN;
        CFE_EVS_Register(NULL, 0, 0);
        CFE_ES_CreateChildTask(&id, "CHILD", fly, NULL, 16384, 60, 0);
        fly();
        CFE_ES_RunLoop(&run);
        OS_TaskDelay(500);
        abort();
    }
"""
MAPS = """
    #include <map>
    #include <stdexcept>
    #include <string>
    #include <unordered_map>
    extern "C" void MAPS_Main()
    {
        std::unordered_map<std::string, int> counts;
        std::map<const void *, int> places;
        CFE_EVS_Register(NULL, 0, 0);
        for (int i = 0; i < 40; i++) {
            counts["name " + std::to_string(i * 7919)] = i;
            places[new int(i)] = i;
        }
        for (const auto &[name, count] : counts)
            CFE_EVS_SendEvent(1, 2, "%s %d", name.c_str(), count);
        for (const auto &[place, count] : places)
            CFE_EVS_SendEvent(2, 2, "%p %d", place, count);
        try {
            throw std::runtime_error("no fuel");
        } catch (const std::exception &error) {
            CFE_EVS_SendEvent(3, 2, "%p %s", (const void *)&error, error.what());
        }
    }
"""
FLIGHT = "import sys; from tests.extra.c.building import digest_of; print(digest_of(*sys.argv[1:]))"
AT_FIXED_ADDRESSES = ("setarch", "-R")


def digest(mission: Path, tasks: str, hash_seed: int, *before: str) -> str:
    """Of a run in a process of its own."""
    environment = {**os.environ, "PYTHONHASHSEED": str(hash_seed), "PYTHONPATH": str(REPOSITORY)}
    command = [*before, sys.executable, "-c", FLIGHT, str(mission), tasks]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.strip()


def has_fixed_addresses() -> bool:
    """Return whether processes may be started without ASLR; containers may forbid it."""
    return bool(shutil.which(AT_FIXED_ADDRESSES[0])) and not subprocess.run([*AT_FIXED_ADDRESSES, "true"]).returncode


@pytest.mark.slow
@needs_cpp
def test_run_has_one_digest_in_each_process(tmp_path: Path) -> None:
    here, there = tmp_path / "here" / "mission", tmp_path / "elsewhere" / "mission"
    here.mkdir(parents=True)
    compile_c(here, "TEST", RUBBISH, "-O2", "-fstack-protector-all", "-Wno-uninitialized", "-Wno-maybe-uninitialized")
    compile_cpp(here, "MAPS", MAPS, "-O2", "-fstack-protector-all")
    write_mission(here, "TEST", "MAPS")
    shutil.copytree(here, there)
    fixed = AT_FIXED_ADDRESSES if has_fixed_addresses() else ()
    found = {
        digest(here, "thread", 0),
        digest(here, "greenlet", 7),
        digest(there, "thread", 7, *fixed),
        digest(there, "greenlet", 0, *fixed),
    }
    assert len(found) == 1
    assert len(found.pop()) == 32


REGISTERS = """
    #if defined(__x86_64__)
    #define LOOK(number, into) __asm__ volatile("movq %%xmm" #number ", %0" : "=r"(into))
    #else
    #define LOOK(number, into) __asm__ volatile("fmov %0, d" #number : "=r"(into))
    #endif
    void TEST_Main(void)
    {
        uint64_t one, three, seven;
        CFE_ES_WriteToSysLog("%f", 1.5);
        LOOK(1, one);
        LOOK(3, three);
        LOOK(7, seven);
        SAY("%lx %lx %lx", one, three, seven);
    }
"""


def test_a_call_leaves_nothing_of_the_host_in_registers(tmp_path: Path) -> None:
    assert said(fly_c(tmp_path, REGISTERS)) == ["0 0 0"]


OWN_STACK = """
    int32_t OS_TaskCreate(uint32_t *, const char *, void (*)(void), void *, size_t, uint8_t, uint32_t);
    static uint64_t stack[8192];
    static void child(void)
    {
        char text[100];
        snprintf(text, sizeof text, "%p", __builtin_return_address(0));
        OS_TaskDelay(10);
        SAY("%s", text);
    }
    void TEST_Main(void)
    {
        uint32_t id;
        int addresses = 0;
        OS_TaskCreate(&id, "CHILD", child, stack, sizeof stack, 60, 0);
        OS_TaskDelay(200);
        for (int i = 0; i < 8192; i++)
            addresses += stack[i] >= ARENA_HIGH && stack[i] < 1ull << 48;
        SAY("%d", addresses);
    }
"""


def test_a_stack_keeps_no_address_of_the_host(tmp_path: Path) -> None:
    returns_to, addresses = said(
        fly_c(tmp_path, OWN_STACK, flags=(f"-DARENA_HIGH={engine().ARENA_HIGH}", "-fno-stack-protector"))
    )
    assert engine().ARENA_LOW < int(returns_to, 16) < engine().ARENA_HIGH
    assert addresses == "0"


def test_stack_guard_has_one_value_in_each_run(tmp_path: Path) -> None:
    source = """
        #if defined(__x86_64__)
        #define LOOK(into) __asm__ volatile("mov %%fs:0x28, %0" : "=r"(into))
        #else
        extern uint64_t __stack_chk_guard;
        #define LOOK(into) (into = __stack_chk_guard)
        #endif
        void TEST_Main(void)
        {
            uint64_t first, later;
            LOOK(first);
            OS_TaskDelay(10);
            LOOK(later);
            SAY("%lx %lx", first, later);
        }
    """
    console = fly_c(tmp_path, source, flags=("-fstack-protector-all",))
    assert said(console) == ["5afe57ac4b0a2d00 5afe57ac4b0a2d00"]
    assert "what nobody has" not in console


def test_format_prints_the_errno_of_its_task(tmp_path: Path) -> None:
    source = """
        int *__errno_location(void);
        void TEST_Main(void)
        {
            SAY("%m");
            *__errno_location() = 2;
            SAY("%m");
        }
    """
    assert said(fly_c(tmp_path, source, flags=("-Wno-format",))) == ["Success", "No such file or directory"]


def test_files_of_the_host_do_not_exist(tmp_path: Path) -> None:
    console = fly_c(tmp_path, 'int access(const char *, int); void TEST_Main(void) { SAY("%d", access("/etc", 0)); }')
    assert "access() of /etc: it is not in the file systems of the mission" in console
    assert said(console) == ["-1"]


LEAKS = """
    #if defined(__x86_64__)
    #define ASK(answer) __asm__ volatile("syscall" : "=a"(answer) : "a"(39) : "rcx", "r11", "memory")
    #else
    #define ASK(answer) __asm__ volatile("mov x8, 172; svc 0; mov %0, x0" : "=r"(answer) : : "x0", "x8", "memory")
    #endif
    static uint32_t process_id(void)
    {
        long answer;
        ASK(answer);
        return answer;
    }
    static uint32_t message[8];
    static void __attribute__((noinline)) report(void)
    {
        message[5] = process_id();
        CFE_SB_TransmitMsg(message, true);
    }
    static void __attribute__((noinline)) rest(void)
    {
        OS_TaskDelay(200 + process_id() % 10000);
    }
    void TEST_Main(void)
    {
        uint32_t pipe, run = RUN;
        CFE_SB_CreatePipe(&pipe, 5, "PIPE");
        CFE_SB_Subscribe(0x891, pipe);
        CFE_MSG_Init(message, 0x891, sizeof message);
        while (CFE_ES_RunLoop(&run)) {
            OS_TaskDelay(100);
            HERE;
        }
    }
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("how", "place", "source", "what"),
    [
        ("report()", ":16 in report", "CFE_SB_TransmitMsg(message, true);", "TEST send 0x0891 sequence 1"),
        ("rest()", ":20 in rest", "OS_TaskDelay(200 + process_id() % 10000);", "TEST calls from "),
    ],
)
def test_nondeterminism_is_found_with_its_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], how: str, place: str, source: str, what: str
) -> None:
    compile_c(tmp_path, "TEST", LEAKS, f"-DHERE={how}", "-fno-optimize-sibling-calls", "-Wno-unused-function")
    folder = write_mission(tmp_path, "TEST")
    assert main(["run", folder, "--for", "1", "--check-determinism", "2"]) == 1
    shown = capsys.readouterr().out
    assert shown.count(f"  made at {tmp_path / 'TEST.c'}{place}\n      {source}\n") == 2
    assert what in shown
    assert "even two runs alike differ" in shown
    assert "a compiled application" in shown


@pytest.mark.slow
def test_calls_that_are_compared_are_not_in_the_digest(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compile_c(tmp_path, "TEST", RUBBISH, "--coverage", "-Wno-uninitialized", "-Wno-maybe-uninitialized", "-Wno-format")
    folder = write_mission(tmp_path, "TEST")
    assert main(["run", folder, "--for", "1", "--check-determinism", "3"]) == 0
    compared = capsys.readouterr().out.splitlines()
    assert compared[-2].startswith("all made the same ")
    assert main(["run", folder, "--for", "1", "--no-console"]) == 0
    assert capsys.readouterr().out.splitlines()[-2] == compared[-1]
