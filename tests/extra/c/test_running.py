"""Compiled applications on cfepy: calls, texts, numbers, restarts, determinism."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import pytest

from cfepy.es import StartParams
from cfepy.extra.c import runtime
from cfepy.extra.c.engine import engine
from cfepy.mission import Mission
from cfepy.pilot.results import mark
from cfepy.writing.console import Console
from tests.extra.c.building import compile_c, console_of, digest_of, fly, fly_c, needs_compiler, said, write_mission

pytestmark = needs_compiler

TASKS = ("thread", "greenlet")


@pytest.mark.parametrize("tasks", TASKS)
def test_an_application_runs_and_exits(tmp_path: Path, tasks: str) -> None:
    console = fly_c(
        tmp_path,
        """
        void TEST_Main(void)
        {
            uint32_t run = RUN;
            int turns = 0;
            while (CFE_ES_RunLoop(&run) && turns < 3) {
                SAY("turn %d", turns++);
                OS_TaskDelay(10);
            }
            CFE_ES_ExitApp(EXIT);
        }
        """,
        tasks=tasks,
    )
    assert said(console) == ["turn 0", "turn 1", "turn 2"]
    assert "CFE_ES_ExitApp: Application TEST called CFE_ES_ExitApp" in console


def test_application_whose_main_function_returns_stays_running_as_in_nasas_es(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", "void TEST_Main(void) {}")
    with Mission(write_mission(tmp_path, "TEST"), console=Console(quiet=True)) as mission:
        mission.run_for(5)
        assert [app.name for app in mission.cfe.es.apps if not app.is_core] == ["TEST"]
        assert mark(mission, 0).returned == [
            "TEST: its main function has returned without CFE_ES_ExitApp; ES keeps the application and its objects"
        ]


SHARED = """
static int starts;
void TEST_Main(void)
{
    uint32_t run = RUN;
    SAY("starts %d", ++starts);
    while (CFE_ES_RunLoop(&run)) OS_TaskDelay(100);
    CFE_ES_ExitApp(run);
}
"""


@pytest.mark.parametrize(("safe", "starts"), [(False, ["1", "2", "3", "1"]), (True, ["1", "1", "1", "1"])])
def test_applications_of_one_file_share_its_variables_as_on_linux(
    tmp_path: Path, safe: bool, starts: list[str]
) -> None:
    compile_c(tmp_path, "TEST", SHARED)
    lines = [f"CFE_APP, TEST, TEST_Main, {name}, 50, 16384, 0x0, 0;\n" for name in ("A", "B")]
    (tmp_path / "startup.scr").write_text("".join(lines) + "!\n", encoding="utf-8")
    (tmp_path / "mission.yaml").write_text(f"safe: {str(safe).lower()}\n", encoding="utf-8")
    with Mission(str(tmp_path), console=Console(quiet=True)) as mission:
        mission.run_for(1)
        es = mission.cfe.es
        es.restart_app(es.get_app_id_by_name("B"))
        mission.run_for(8)
        for name in ("A", "B"):
            es.delete_app(es.get_app_id_by_name(name))
        mission.run_for(8)
        es.create_app("A", StartParams("/cf/TEST.so", "TEST_Main", 16384, 50))
        mission.run_for(1)
        lines = list(mission.console.lines)
    assert [line.rpartition(" ")[2] for line in lines if "starts " in line] == starts
    assert ("OS_ModuleLoad: /cf/TEST.so is in use: B shares the variables of A" in lines) is not safe


def test_formats_take_all_kinds_of_arguments(tmp_path: Path) -> None:
    console = fly_c(
        tmp_path,
        r"""
        void TEST_Main(void)
        {
            char text[40];
            SAY("%d %u %ld %llx %c %s %5.2f %g %p", -1, 4000000000u, -5000000000l, 0xFEDCBA9876543210ull, 0x63, "text",
                3.14159, 1e-9, (void *)0x10);
            SAY("%d %d %d %d %d %d %d %d %f %f %f %f %f %f %f %f %f %d", 1, 2, 3, 4, 5, 6, 7, 8, 1., 2., 3., 4., 5., 6.,
                7., 8., 9., 10);
            int length = snprintf(text, sizeof text, "%s is %.3f", "pi", 3.14159);
            SAY("%s: %d", text, length);
            SAY("%*d|%-4s|%%", 5, 42, "ab");
        }
        """,
    )
    assert said(console) == [
        "-1 4000000000 -5000000000 fedcba9876543210 c text  3.14 1e-09 0x10",
        "1 2 3 4 5 6 7 8 1.000000 2.000000 3.000000 4.000000 5.000000 6.000000 7.000000 8.000000 9.000000 10",
        "pi is 3.142: 11",
        "   42|ab  |%",
    ]


def test_arrays_are_sorted_and_searched(tmp_path: Path) -> None:
    console = fly_c(
        tmp_path,
        r"""
        #include <stdlib.h>
        typedef struct { int key; char name[8]; } Item;
        static int calls;
        static int by_key(const void *one, const void *other)
        {
            calls++;
            return ((const Item *)one)->key - ((const Item *)other)->key;
        }
        void TEST_Main(void)
        {
            Item items[] = {{3, "c"}, {-1, "a"}, {3, "d"}, {2, "b"}}, wanted = {2, ""}, none = {5, ""};
            qsort(items, 4, sizeof *items, by_key);
            SAY("%s%s%s%s %d", items[0].name, items[1].name, items[2].name, items[3].name, calls > 2);
            Item *found = bsearch(&wanted, items, 4, sizeof *items, by_key);
            SAY("%s %d", found->name, bsearch(&none, items, 4, sizeof *items, by_key) == NULL);
            qsort(items, 0, sizeof *items, by_key);
        }
        """,
    )
    assert said(console) == ["abcd 1", "b 1"]


def test_floating_point_survives_calls_and_other_tasks(tmp_path: Path) -> None:
    console = fly_c(
        tmp_path,
        """
        double sqrt(double);
        double pow(double, double);
        static volatile double shared = 2;
        static void other(void)
        {
            for (int i = 0; i < 5; i++) {
                shared = sqrt(shared) * 3;
                OS_TaskDelay(10);
            }
        }
        void TEST_Main(void)
        {
            uint32_t id;
            double sum = 0.125;
            CFE_ES_CreateChildTask(&id, "OTHER", other, NULL, 16384, 60, 0);
            for (int i = 0; i < 5; i++) {
                sum += pow(1.5, i);
                OS_TaskDelay(50);
            }
            SAY("%.6f %.6f", sum, shared);
        }
        """,
    )
    assert said(console) == ["13.312500 8.586766"]


def test_a_restart_finds_statics_as_new(tmp_path: Path) -> None:
    console = fly_c(
        tmp_path,
        """
        static int starts = 1;
        static char zeros[5000];
        void TEST_Main(void)
        {
            SAY("start %d %d", starts++, zeros[4999]++);
            OS_TaskDelay(1000);
            CFE_ES_ExitApp(3);
        }
        int32_t CFE_ES_RestartApp(uint32_t);
        """,
        1,
    )
    assert said(console) == ["start 1 0"]
    compile_c(
        tmp_path,
        "TEST",
        """
        static int starts = 1;
        int32_t CFE_ES_RestartApp(uint32_t);
        int32_t CFE_ES_GetAppID(uint32_t *);
        void TEST_Main(void)
        {
            uint32_t id, run = RUN;
            char *kept = malloc(100);
            SAY("start %d", starts++);
            CFE_ES_GetAppID(&id);
            CFE_ES_RunLoop(&run);
            OS_TaskDelay(200);
            kept[0] = 1;
            CFE_ES_RestartApp(id);
            while (CFE_ES_RunLoop(&run))
                OS_TaskDelay(100);
            CFE_ES_ExitApp(run);
        }
        """,
    )
    again = said(console_of(fly(write_mission(tmp_path, "TEST"), 20)))
    assert len(again) > 2
    assert set(again) == {"start 1"}


def test_tasks_share_memory_of_each_others_stacks(tmp_path: Path) -> None:
    source = """
        static volatile int *shared;
        static void child(void)
        {
            for (int i = 0; i < 3; i++) {
                OS_TaskDelay(20);
                SAY("child reads %d", *shared);
                *shared += 100;
            }
        }
        void TEST_Main(void)
        {
            volatile int local = 7;
            uint32_t id;
            shared = &local;
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);
            for (int i = 0; i < 8; i++) {
                OS_TaskDelay(20);
                local++;
            }
            SAY("main ends with %d", local);
        }
    """
    compile_c(tmp_path, "TEST", source)
    folder = write_mission(tmp_path, "TEST")
    assert said(console_of(fly(folder)))[-1] == "main ends with 315"
    assert digest_of(folder, "thread") == digest_of(folder, "greenlet")


def test_unwritten_memory_and_addresses_are_the_same_in_each_run(tmp_path: Path) -> None:
    compile_c(
        tmp_path,
        "TEST",
        """
        static int a_static;
        void TEST_Main(void)
        {
            unsigned char message[64];
            CFE_EVS_Register(NULL, 0, 0);
            for (int i = 0; i < 5; i++) {
                unsigned sum = 0;
                for (int k = 6; k < 64; k++)
                    sum = sum * 31 + ((volatile unsigned char *)message)[k];
                SAY("rubbish %u, local %p, function %p, static %p, heap %p", sum, (void *)message, (void *)TEST_Main,
                    (void *)&a_static, malloc(10));
                OS_TaskDelay(100);
            }
        }
        """,
        "-Wno-maybe-uninitialized",
    )
    folder = write_mission(tmp_path, "TEST")
    assert len({digest_of(folder, tasks) for tasks in (*TASKS, "thread")}) == 1
    assert len(said(console_of(fly(folder)))) == 5


def test_a_library_is_called_by_applications(tmp_path: Path) -> None:
    compile_c(
        tmp_path,
        "lib",
        """
        static int calls;
        int32_t LIB_Init(uint32_t id) { SAY("library %x", id != 0); return 0; }
        int LIB_Twice(int value) { calls++; return 2 * value; }
        int LIB_Calls(void) { return calls; }
        """,
    )
    for name in ("ONE", "TWO"):
        source = f"""
            int LIB_Twice(int); int LIB_Calls(void);
            void {name}_Main(void) {{ int twice = LIB_Twice(21); SAY("{name} %d %d", twice, LIB_Calls()); }}
        """
        compile_c(tmp_path, name, source)
    folder = write_mission(tmp_path, "ONE", "TWO", libraries="CFE_LIB, lib, LIB_Init, LIB, 0, 0, 0x0, 0;\n")
    assert said(console_of(fly(folder))) == ["library 1", "ONE 42 1", "TWO 42 2"]


PACKED = """
    #define TEN(n) &numbers[n], &numbers[n + 1], &numbers[n + 2], &numbers[n + 3], &numbers[n + 4], &numbers[n + 5], \\
        &numbers[n + 6], &numbers[n + 7], &numbers[n + 8], &numbers[n + 9]
    static int numbers[100];
    static int *const all[] = {
        TEN(0), TEN(10), TEN(20), TEN(30), TEN(40), TEN(50), TEN(60), TEN(70), TEN(80), TEN(90), NULL, NULL, NULL,
    };
    static struct { char gap[1000]; int *last; const char *name; } far_away = {"", &numbers[99], "far away"};
    void TEST_Main(void)
    {
        int sum = 0;
        for (int i = 0; i < 100; i++)
            numbers[i] = i;
        for (int i = 0; i < 103; i++)
            sum = sum * 3 + (all[i] != NULL ? *all[i] : 1);
        SAY("%u %d %s", (unsigned)sum, *far_away.last, far_away.name);
    }
"""


def test_packed_relocations_are_filled_in(tmp_path: Path) -> None:
    """DT_RELR. A linker that does not know the flag warns, and makes relocations that are not packed."""
    plain = said(fly_c(tmp_path, PACKED))
    packed = said(fly_c(tmp_path, PACKED, flags=("-Wl,-z,pack-relative-relocs",)))
    assert packed == plain
    assert packed[0].endswith(" 99 far away")


def test_run_is_not_watched_while_it_waits_for_the_compiler_of_the_engine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    compile_c(tmp_path, "TEST", "void TEST_Main(void) {}")
    mission = Mission(write_mission(tmp_path, "TEST"), console=Console(quiet=True))
    paused: list[bool] = []

    def built() -> ModuleType:  # that takes many seconds on a busy computer, the first time
        paused.append(mission.stall_watch._is_paused)
        return engine()

    monkeypatch.setattr(runtime, "engine", built)
    with mission:
        mission.run_for(1)
        assert not mission.stall_watch._is_paused
    assert paused[0]
