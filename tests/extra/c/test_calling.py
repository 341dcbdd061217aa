"""Effects of a processor's calling convention: registers and stacks of calls, formats, callbacks, modes."""

from __future__ import annotations

import platform
from pathlib import Path

import pytest

from tests.extra.c.building import fly_c, needs_compiler, said

pytestmark = needs_compiler

PROTECTION = ("-mbranch-protection=standard",) if platform.machine() == "aarch64" else ("-fcf-protection=full",)
ALL_KINDS = [
    "1 2 3 4 5 6 7 8 9 10 11 12 0.5 1.5 2.5 3.5 4.5 5.5 6.5 7.5 8.5 9.5",
    "-1 x 0.25 text 18446744073709551615 9.75",
]


def test_formats_read_arguments_beyond_the_registers_in_every_printing_function(tmp_path: Path) -> None:
    console = fly_c(
        tmp_path,
        r"""
        #include <stdarg.h>
        int sprintf(char *, const char *, ...);
        int vsnprintf(char *, size_t, const char *, va_list);
        #define INTEGERS "%d %d %d %d %d %d %d %d %d %d %d %d"
        #define FLOATS " %.1f %.1f %.1f %.1f %.1f %.1f %.1f %.1f %.1f %.1f"
        #define ALL 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, .5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5
        #define MIXED "%d %c %.2Lf %s %llu %.2f\n", -1, 'x', (long double)0.25, "text", ~0ull, 9.75
        static void say(const char *format, ...)
        {
            char text[200];
            va_list list;
            va_start(list, format);
            vsnprintf(text, sizeof text, format, list);
            va_end(list);
            SAY("%s", text);
        }
        void TEST_Main(void)
        {
            char text[200];
            SAY(INTEGERS FLOATS, ALL);
            SAY(MIXED);
            snprintf(text, sizeof text, INTEGERS FLOATS, ALL);
            SAY("%s", text);
            snprintf(text, sizeof text, MIXED);
            SAY("%s", text);
            sprintf(text, INTEGERS FLOATS, ALL);
            SAY("%s", text);
            sprintf(text, MIXED);
            SAY("%s", text);
            say(INTEGERS FLOATS, ALL);
            say(MIXED);
            CFE_EVS_Register(NULL, 0, 0);
            CFE_EVS_SendEvent(1, 2, "> " INTEGERS FLOATS, ALL);
            CFE_EVS_SendEvent(2, 2, "> " MIXED);
            OS_printf("> " INTEGERS FLOATS "\n", ALL);
            OS_printf("> " MIXED);
        }
        """,
        flags=("-w",),
    )
    assert [each.strip() for each in said(console)] == 6 * ALL_KINDS


def test_long_doubles_keep_all_their_digits(tmp_path: Path) -> None:
    console = fly_c(
        tmp_path,
        r"""
        void TEST_Main(void)
        {
            char text[200];
            long double one = 1, many[9];
            for (int i = 0; i < 9; i++)
                many[i] = one + i / 1e18L;
            snprintf(text, sizeof text, "%.18Lf %.18Lf %.18Lf %.18Lf %.18Lf %.18Lf %.18Lf %.18Lf %.18Lf", many[0],
                     many[1], many[2], many[3], many[4], many[5], many[6], many[7], many[8]);
            SAY("%.84s", text);
            SAY("%s", text + 84);
        }
        """,
    )
    assert " ".join(said(console)).split() == [f"1.{digit:018}" for digit in range(9)]


def test_structures_are_results_and_arguments(tmp_path: Path) -> None:
    console = fly_c(
        tmp_path,
        """
        typedef struct { uint32_t seconds, subseconds; } Time;
        typedef struct { size_t count; const void *elements; } Array;
        Time CFE_TIME_Add(Time, Time);
        int32_t CFE_TIME_Compare(Time, Time);
        uint32_t CFE_Config_GetIdByName(const char *);
        Array CFE_Config_GetArrayValue(uint32_t);
        void TEST_Main(void)
        {
            Time a = {5, 0xC0000000}, b = {2, 0x80000001};
            Time sum = CFE_TIME_Add(a, b);
            Array array = CFE_Config_GetArrayValue(0);
            SAY("%u %x %d", sum.seconds, sum.subseconds, (int)CFE_TIME_Compare(a, b));
            SAY("%zu %p", array.count, array.elements);
        }
        """,
    )
    assert said(console) == ["8 40000001 1", "0 (nil)"]


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_callbacks_have_six_arguments_and_call_in_turn(tmp_path: Path, tasks: str) -> None:
    console = fly_c(
        tmp_path,
        """
        typedef struct Request {
            volatile bool is_pending;
            char file[64];
            uint32_t subtype;
            char description[32];
            bool (*get)(void *, uint32_t, void **, size_t *);
            void (*event)(void *, int, int32_t, uint32_t, size_t, size_t);
        } Request;
        int32_t CFE_FS_BackgroundFileDumpRequest(Request *);
        static Request request;
        static bool get(void *meta, uint32_t record, void **buffer, size_t *size)
        {
            static char data[] = "0123456789";
            SAY("get %d %u", meta == &request, record);
            *buffer = data;
            *size = record < 3 ? 5 + record : 0;
            return record >= 3;
        }
        static void event(void *meta, int event, int32_t status, uint32_t record, size_t block, size_t position)
        {
            SAY("event %d %d %d %u %zu %zu", meta == &request, event, (int)status, record, block, position);
        }
        void TEST_Main(void)
        {
            request = (Request){.file = "/ram/dump", .subtype = 7, .description = "a dump", .get = get, .event = event};
            SAY("%d", (int)CFE_FS_BackgroundFileDumpRequest(&request));
            OS_TaskDelay(3000);
            SAY("%d", request.is_pending);
        }
        """,
        6,
        tasks=tasks,
    )
    assert said(console) == [
        "0",
        *(f"get 1 {record}" for record in range(4)),
        "event 1 1 0 4 0 82",
        "0",
    ]


WIDE = """
typedef uint64_t Pair __attribute__((vector_size(16)));
void TEST_Main(void)
{
    Pair all[24];
    uint64_t words[8];
    for (int i = 0; i < 24; i++)
        all[i] = (Pair){i, i + 100};
    for (int i = 0; i < 8; i++)
        words[i] = i;
    for (uint32_t turn = 0; turn < TURNS; turn++) {
        for (int i = 0; i < 24; i++)
            all[i] = (all[i] << 5) - all[i] + 7;
        for (int i = 0; i < 8; i++)
            words[i] = words[i] * 33 + 5;
    }
    uint64_t sum = 0;
    for (int i = 0; i < 24; i++)
        sum = sum * 1000003 + all[i][0] + 3 * all[i][1];
    for (int i = 0; i < 8; i++)
        sum = sum * 1000003 + words[i];
    SAY("%llu", (unsigned long long)sum);
}
"""


def test_long_computation_keeps_its_registers_when_it_is_interrupted(tmp_path: Path) -> None:
    turns = 4_000_000

    def after(step: int, add: int, value: int) -> int:
        """Return the value after `turns` times value * step + add."""
        power = pow(step, turns, step - 1 << 64)
        return value * power + add * ((power - 1) // (step - 1))

    console = fly_c(tmp_path, WIDE, flags=("-O2", "-funroll-loops", f"-DTURNS={turns}u"))
    total = 0
    for number in range(24):
        total = total * 1000003 + after(31, 7, number) + 3 * after(31, 7, number + 100)
    for number in range(8):
        total = total * 1000003 + after(33, 5, number)
    assert said(console) == [str(total % (1 << 64))]


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_modes_of_floating_point_belong_to_each_task(tmp_path: Path, tasks: str) -> None:
    console = fly_c(
        tmp_path,
        """
        static void round_up(void)
        {
        #if defined(__aarch64__)
            __asm__ volatile("msr fpcr, %0" : : "r"(1ull << 22));
        #else
            unsigned modes = 0x1F80 | 2 << 13;
            __asm__ volatile("ldmxcsr %0" : : "m"(modes));
        #endif
        }
        static volatile double one = 1, three = 3;
        static void other(void)
        {
            for (int i = 0; i < 3; i++) {
                double third = one / three;
                SAY("near %llx", *(unsigned long long *)&third);
                OS_TaskDelay(10);
            }
        }
        void TEST_Main(void)
        {
            uint32_t id;
            round_up();
            CFE_ES_CreateChildTask(&id, "OTHER", other, NULL, 16384, 60, 0);
            for (int i = 0; i < 3; i++) {
                for (volatile long turn = 0; turn < TURNS; turn++)
                    ;
                double third = one / three;
                SAY("up %llx", *(unsigned long long *)&third);
                OS_TaskDelay(10);
            }
        }
        """,
        flags=("-fno-strict-aliasing", "-DTURNS=30000000l"),
        tasks=tasks,
    )
    assert sorted(said(console)) == 3 * ["near 3fd5555555555555"] + 3 * ["up 3fd5555555555556"]


@pytest.mark.parametrize("flags", [(), PROTECTION])
def test_code_added_by_compilers_is_supported(tmp_path: Path, flags: tuple[str, ...]) -> None:
    console = fly_c(
        tmp_path,
        """
        static int made;
        static unsigned counter = 5;
        static __attribute__((constructor)) void make(void) { made = 42; }
        static int twice(int value) { return 2 * value; }
        void TEST_Main(void)
        {
            int (*volatile function)(int) = twice;
            char text[8];
            memset(text, 'a', 7);
            text[7] = 0;
            __sync_fetch_and_add(&counter, 3);
            SAY("%d %u %d %s", made, __atomic_exchange_n(&counter, 1, __ATOMIC_SEQ_CST), function(4), text);
        }
        """.replace("", ""),
        flags=("-fstack-protector-all", *flags),
    )
    assert said(console) == ["42 8 8 aaaaaaa"]
