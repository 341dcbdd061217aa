"""Thread-local variables: each task has its own."""

from __future__ import annotations

import platform
import struct
from pathlib import Path

import pytest

from cfepy.extra.c.image import without_thread_pointer
from tests.extra.c.building import (
    compile_c,
    compile_cpp,
    console_of,
    fly,
    fly_c,
    needs_compiler,
    needs_cpp,
    said,
    write_mission,
)

pytestmark = needs_compiler

EACH_ITS_OWN = """
    static __thread int count = 40;
    __thread char zeros[100];
    static void fly(const char *who)
    {
        for (int i = 0; i < 3; i++) {
            zeros[99]++;
            count++;
            OS_TaskDelay(10);
        }
        SAY("%s %d %d", who, count, zeros[99]);
    }
    static void child(void) { fly("child"); }
    void TEST_Main(void)
    {
        uint32_t id;
        CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);
        fly("main");
        OS_TaskDelay(200);
        CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);
        OS_TaskDelay(200);
    }
"""


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
@pytest.mark.parametrize("model", ["global-dynamic", "local-dynamic"])
def test_each_task_has_its_own_thread_local_variables(tmp_path: Path, model: str, tasks: str) -> None:
    console = fly_c(tmp_path, EACH_ITS_OWN, flags=(f"-ftls-model={model}",), tasks=tasks)
    assert sorted(said(console)) == ["child 43 3", "child 43 3", "main 43 3"]


LEFT_BEHIND = """
    static __thread unsigned count = 1;
    static void __attribute__((noinline)) seen(const void *at) { __asm__ volatile("" : : "r"(at) : "memory"); }
    static void __attribute__((noinline)) deeper(void) { uint64_t much[20] = {0}; seen(much); OS_TaskDelay(1); }
    static unsigned __attribute__((noinline)) left(void)
    {
        unsigned char bytes[1000];
        unsigned sum = 0;
        seen(bytes);
        for (size_t i = 0; i < sizeof bytes; i++)
            sum = sum * 31 + bytes[i];
        return sum;
    }
    void TEST_Main(void)
    {
        for (int i = 0; i < 3; i++) {
            count += 2;
            deeper();
            SAY("%u %u", count, left());
        }
    }
"""


def test_stacks_have_no_leftovers_of_the_host_thread(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", LEFT_BEHIND, "-O2", "-Wno-uninitialized", "-Wno-maybe-uninitialized")
    folder = write_mission(tmp_path, "TEST")
    assert said(console_of(fly(folder))) == said(console_of(fly(folder, tasks="greenlet")))


def test_code_of_aarch64_gets_no_thread_pointer() -> None:
    ask, other = (0xD53BD040, 0xD53BD054, 0xD53BD05F), (0xD51BD041, 0xD53BD060, 0xD53BE041, 0xD65F03C0)
    instead = (0xD2800000, 0xD2800014, 0xD280001F)
    assert without_thread_pointer(struct.pack("<7I", *ask, *other)) == struct.pack("<7I", *instead, *other)
    across = struct.pack("<HIH", 0, ask[0], 0)
    assert without_thread_pointer(across) == across


def test_library_shares_its_thread_local_variables_with_applications(tmp_path: Path) -> None:
    compile_c(tmp_path, "lib", "__thread int LIB_Level = 5; int LIB_Up(void) { return ++LIB_Level; }")
    compile_c(
        tmp_path,
        "TEST",
        """
        extern __thread int LIB_Level;
        int LIB_Up(void);
        static void child(void) { SAY("child %d", LIB_Up()); }
        void TEST_Main(void)
        {
            uint32_t id;
            LIB_Level = 10;
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);
            OS_TaskDelay(200);
            int level = LIB_Up();
            SAY("main %d %d", level, LIB_Level);
        }
        """,
    )
    folder = write_mission(tmp_path, "TEST", libraries="CFE_LIB, lib, NULL, LIB, 0, 0, 0x0, 0;\n")
    console = console_of(fly(folder))
    assert said(console) == ["child 6", "main 11 11"]
    assert "has undefined symbols" not in console


@pytest.mark.slow
def test_many_libraries_have_thread_local_variables(tmp_path: Path) -> None:
    numbers = range(10)  # as many libraries as there may be
    for number in numbers:
        compile_c(tmp_path, f"lib{number}", f"__thread int LIB{number} = {number};")
    declared = "".join(f"extern __thread int LIB{number};\n" for number in numbers)
    added = "".join(f"sum = sum * 3 + (LIB{number} += 2);\n" for number in numbers)
    compile_c(
        tmp_path,
        "TEST",
        declared
        + f"static void fly(const char *who) {{ unsigned sum = 0;\n for (int i = 0; i < 3; i++) {{\n{added}"
        + 'OS_TaskDelay(10); }\nSAY("%s %u", who, sum); }\nstatic void child(void) { fly("child"); }\n'
        'void TEST_Main(void)\n{\nuint32_t id;\nCFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);\n'
        'fly("main");\nOS_TaskDelay(200);\n}\n',
    )
    lines = "".join(f"CFE_LIB, lib{number}, NULL, LIB{number}, 0, 0, 0x0, 0;\n" for number in numbers)
    sum_ = 0
    for turn in range(3):
        for number in numbers:
            sum_ = (sum_ * 3 + number + 2 * (turn + 1)) % 2**32
    console = console_of(fly(write_mission(tmp_path, "TEST", libraries=lines)))
    assert sorted(said(console)) == [f"child {sum_}", f"main {sum_}"]


def test_initial_exec_model_is_refused_with_the_flag_to_use(tmp_path: Path) -> None:
    console = fly_c(tmp_path, EACH_ITS_OWN, flags=("-ftls-model=initial-exec",))
    assert "TEST.so has thread-local variables in the initial-exec model" in console
    assert "compile it with -fPIC -ftls-model=global-dynamic" in console


@pytest.mark.skipif(platform.machine() != "x86_64", reason="elsewhere descriptors are what compilers make, and work")
def test_tls_descriptors_are_refused_with_the_flag_to_use(tmp_path: Path) -> None:
    console = fly_c(tmp_path, EACH_ITS_OWN, flags=("-mtls-dialect=gnu2",))
    assert "TEST.so uses TLS descriptors; compile it with -mtls-dialect=gnu" in console


@needs_cpp
def test_thread_local_objects_are_destroyed_with_their_task(tmp_path: Path) -> None:
    compile_cpp(
        tmp_path,
        "TEST",
        """
        struct Own {
            int number = 1;
            ~Own() { SAY("own %d ends", number); }
        };
        static thread_local Own own;
        static void child() { own.number = 2; }
        extern "C" void TEST_Main()
        {
            uint32_t id;
            own.number = 3;
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);
            OS_TaskDelay(200);
        }
        """,
    )
    assert said(console_of(fly(write_mission(tmp_path, "TEST")))) == ["own 2 ends", "own 3 ends"]


def test_indirect_function_is_resolved_when_it_is_loaded(tmp_path: Path) -> None:
    source = """
        static int one(void) { return 1; }
        static int two(void) { return 2; }
        static int (*choose(void))(void) { return sizeof(long) == 8 ? two : one; }
        int number(void) __attribute__((ifunc("choose")));
        int (*by_pointer)(void) = number;
        void TEST_Main(void) { (void)one; SAY("%d %d", number(), by_pointer()); }
    """
    assert said(fly_c(tmp_path, source)) == ["2 2"]


def test_each_task_has_its_own_errno(tmp_path: Path) -> None:
    source = """
        int *__errno_location(void);
        static int *other;
        static void child(void) { other = __errno_location(); *other = 7; }
        void TEST_Main(void)
        {
            uint32_t id;
            *__errno_location() = 3;
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 40, 0);
            OS_TaskDelay(200);
            SAY("%d %d", *__errno_location(), other != __errno_location());
        }
    """
    assert said(fly_c(tmp_path, source)) == ["3 1"]
