"""State of libc in compiled applications: whose it is, and that none of it is the host's."""

from __future__ import annotations

import platform
from pathlib import Path

import pytest

from tests.extra.c.building import compile_c, console_of, digest_of, fly, fly_c, needs_compiler, said, write_mission

pytestmark = needs_compiler

TASKS = pytest.mark.parametrize("tasks", ["thread", "greenlet"])


def error_of(folder: Path, source: str, *flags: str) -> str:
    """Return the last error of an application TEST."""
    compile_c(folder, "TEST", source, "-w", *flags)
    return str(fly(write_mission(folder, "TEST"), 1).cfe.es.history["TEST"].last_error)


# -- errno -------------------------------------------------------------------------------------------------------------


def test_errno_is_set_before_the_application_has_asked_for_it(tmp_path: Path) -> None:
    source = """
        #include <errno.h>
        void TEST_Main(void)
        {
            strtol("99999999999999999999", NULL, 10);
            SAY("%d", errno);
        }
    """
    assert said(fly_c(tmp_path, source)) == ["34"]


def test_errno_that_a_callback_sets_is_its_callers(tmp_path: Path) -> None:
    source = """
        #include <errno.h>
        static int compare(const void *a, const void *b)
        {
            strtoul("99999999999999999999", NULL, 10);
            return *(int *)a - *(int *)b;
        }
        void TEST_Main(void)
        {
            int numbers[] = {2, 1};
            qsort(numbers, 2, sizeof *numbers, compare);
            SAY("%d %d", numbers[0], errno);
        }
    """
    assert said(fly_c(tmp_path, source)) == ["1 34"]


@TASKS
def test_errno_is_the_tasks_own(tmp_path: Path, tasks: str) -> None:
    source = """
        #include <errno.h>
        #include <math.h>
        static void child(void) { log(-1); SAY("child %d", errno); }
        void TEST_Main(void)
        {
            uint32_t id;
            exp(1e10);
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 40, 0);
            OS_TaskDelay(100);
            SAY("%d", errno);
        }
    """
    assert said(fly_c(tmp_path, source, tasks=tasks)) == ["child 33", "34"]


# -- floating point ----------------------------------------------------------------------------------------------------

MODES = """
    #include <fenv.h>
    #include <math.h>
    static volatile double one = 1, three = 3, zero;
    static volatile long double lone = 1, lzero;
    static void tell(const char *who)
    {
        SAY("%s %d %a %g %d", who, fegetround() != FE_TONEAREST, one / three, rint(2.5),
            fetestexcept(FE_DIVBYZERO | FE_OVERFLOW | FE_INVALID));
    }
    static void child(void)
    {
        fesetround(FE_UPWARD);
        volatile long double infinite = lone / lzero;
        volatile double more = one / zero;
        for (int i = 0; i < 3; i++) {
            tell("child");
            OS_TaskDelay(10);
        }
    }
    void TEST_Main(void)
    {
        uint32_t id;
        CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 60, 0);
        for (int i = 0; i < 3; i++) {
            tell("main");
            OS_TaskDelay(10);
        }
        volatile double invalid = sqrt(-one);
        tell("main");
    }
"""


@TASKS
def test_rounding_and_flags_are_the_tasks_own(tmp_path: Path, tasks: str) -> None:
    lines = said(fly_c(tmp_path, MODES, flags=("-w", "-frounding-math", "-lm"), tasks=tasks))
    assert [each for each in lines if each.startswith("main")] == [
        *["main 0 0x1.5555555555555p-2 2 0"] * 3,
        "main 0 0x1.5555555555555p-2 2 1",
    ]
    flag = 4 if platform.machine() == "x86_64" else 2
    assert [each for each in lines if each.startswith("child")] == [f"child 1 0x1.5555555555556p-2 3 {flag}"] * 3


@TASKS
def test_rounding_flags_and_errno_reach_callbacks_and_come_back(tmp_path: Path, tasks: str) -> None:
    source = """
        #include <errno.h>
        #include <fenv.h>
        static volatile double one = 1, three = 3, zero;
        static int compare(const void *a, const void *b)
        {
            volatile double infinite = one / zero;
            OS_TaskDelay(200);
            SAY("%a %d %m", one / three, fetestexcept(FE_DIVBYZERO) != 0);
            fesetround(FE_DOWNWARD);
            return 0;
        }
        static void child(void)
        {
            OS_TaskDelay(120);
            SAY("child %a %d", one / three, fetestexcept(FE_DIVBYZERO) != 0);
        }
        void TEST_Main(void)
        {
            uint32_t id;
            int numbers[] = {2, 1};
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 40, 0);
            OS_TaskDelay(100);
            fesetround(FE_UPWARD);
            errno = 34;
            qsort(numbers, 2, sizeof *numbers, compare);
            SAY("%d %d", fegetround() == FE_DOWNWARD, fetestexcept(FE_DIVBYZERO) != 0);
        }
    """
    lines = said(fly_c(tmp_path, source, flags=("-w", "-frounding-math", "-lm"), tasks=tasks))
    assert lines == [
        "child 0x1.5555555555555p-2 0",
        "0x1.5555555555556p-2 1 Numerical result out of range",
        "1 1",
    ]


def test_a_fault_leaves_python_its_rounding(tmp_path: Path) -> None:
    source = """
        #include <fenv.h>
        #include <stdio.h>
        void TEST_Main(void) { fesetround(FE_UPWARD); sscanf("1.5", "%lf", (double *)16); }
    """
    assert "SIGSEGV" in error_of(tmp_path, source, "-lm")
    values = [1.0, 3.0]
    assert (values[0] / values[1]).hex() == "0x1.5555555555555p-2"


@pytest.mark.skipif(platform.machine() != "x86_64", reason="not all processors for aarch64 have traps")
def test_an_enabled_trap_is_a_fault(tmp_path: Path) -> None:
    source = """
        #define _GNU_SOURCE
        #include <fenv.h>
        #include <math.h>
        void TEST_Main(void) { feenableexcept(FE_INVALID); sqrt(-1); }
    """
    assert "SIGFPE" in error_of(tmp_path, source, "-D_GNU_SOURCE", "-lm")


# -- what libc has once for a process ----------------------------------------------------------------------------------


def test_applications_share_strtok_and_rand(tmp_path: Path) -> None:
    compile_c(
        tmp_path,
        "TEST",
        """
        static char text[] = "a b c";
        void TEST_Main(void)
        {
            srand(7);
            SAY("%s %d", strtok(text, " "), rand());
            OS_TaskDelay(100);
        }
        """,
    )
    compile_c(
        tmp_path,
        "OTHER",
        """
        void OTHER_Main(void)
        {
            OS_TaskDelay(50);
            SAY("%s %d", strtok(NULL, " "), rand());
            srand(7);
            int first = rand();
            SAY("%d %d", first, rand());
        }
        """,
    )
    first, second, again = said(console_of(fly(write_mission(tmp_path, "TEST", "OTHER"), 1)))
    assert (first[0], second[0]) == ("a", "b")
    assert again == f"{first[2:]} {second[2:]}"


def test_rand_begins_anew_with_each_processor(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", 'void TEST_Main(void) { SAY("%d", rand()); }')
    folder = write_mission(tmp_path, "TEST")
    assert said(console_of(fly(folder, 1))) == said(console_of(fly(folder, 1))) == ["1804289383"]


@TASKS
def test_results_in_memory_of_libc_have_the_same_address_each_time(tmp_path: Path, tasks: str) -> None:
    source = """
        #define _GNU_SOURCE
        #include <locale.h>
        #include <math.h>
        #include <time.h>
        extern char *strerror(int);
        void TEST_Main(void)
        {
            time_t now = 100000;
            SAY("%p %p %p", gmtime(&now), asctime(localtime(&now)), ctime(&now));
            SAY("%p %p %p %p", strerror(2), strerror(9999), setlocale(LC_ALL, NULL), localeconv()->decimal_point);
            SAY("%p %p %p", tzname[0], gmtime(&now)->tm_zone, &signgam);
        }
    """
    compile_c(tmp_path, "TEST", source, "-w", "-D_GNU_SOURCE")
    folder = write_mission(tmp_path, "TEST")
    assert digest_of(folder, tasks) == digest_of(folder, "thread")
    first, second = (said(console_of(fly(folder, 1, tasks))) for _ in range(2))
    assert first == second
    assert all(0x10 << 32 <= int(each, 16) < 0x50 << 32 for line in first for each in line.split())


# -- jumps -------------------------------------------------------------------------------------------------------------

JUMPS = "#include <setjmp.h>\nstatic jmp_buf place;\n"


def test_longjmp_without_a_setjmp_is_a_fault(tmp_path: Path) -> None:
    error = error_of(tmp_path, JUMPS + "void TEST_Main(void) { longjmp(place, 1); }")
    assert "longjmp() with a buffer that no setjmp() has filled, in TEST_Main (TEST.c:3)" in error


@TASKS
def test_longjmp_out_of_a_callback_ends_it(tmp_path: Path, tasks: str) -> None:
    source = """
        static jmp_buf outer;
        static int calls;
        static int compare(const void *a, const void *b) { longjmp(place, ++calls); }
        static int nested(const void *a, const void *b)
        {
            int others[] = {4, 3};
            qsort(others, 2, sizeof *others, compare);
            return 0;
        }
        void TEST_Main(void)
        {
            int numbers[] = {2, 1};
            volatile int kept = 5;
            int got = setjmp(place);
            if (got < 3)
                qsort(numbers, 2, sizeof *numbers, got < 2 ? compare : nested);
            SAY("%d %d %d %d", got, kept, numbers[0], calls);
        }
    """
    compile_c(tmp_path, "TEST", JUMPS + source, "-w")
    assert said(console_of(fly(write_mission(tmp_path, "TEST"), 1, tasks))) == ["3 5 2 3"]


def test_longjmp_to_a_stack_of_another_task_is_a_fault(tmp_path: Path) -> None:
    source = """
        static void child(void) { longjmp(place, 1); }
        void TEST_Main(void)
        {
            uint32_t id;
            if (setjmp(place) == 0)
                CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 40, 0);
            OS_TaskDelay(100);
        }
    """
    assert "where no setjmp() was called in this task, in child (TEST.c:4)" in error_of(tmp_path, JUMPS + source)


def test_fortified_longjmp_into_a_function_that_has_returned_is_a_fault(tmp_path: Path) -> None:
    source = """
        extern void jump(jmp_buf, int) __asm__("__longjmp_chk");
        static __attribute__((noinline)) int begin(void) { volatile char room[999]; room[0] = 1; return setjmp(place); }
        void TEST_Main(void)
        {
            if (begin() == 0)
                jump(place, 1);
        }
    """
    assert "longjmp causes uninitialized stack frame" in error_of(tmp_path, JUMPS + source)


# -- streams, ends -----------------------------------------------------------------------------------------------------


def test_stdin_is_at_its_end(tmp_path: Path) -> None:
    source = """
        #include <stdio.h>
        void TEST_Main(void)
        {
            char line[10] = "kept";
            int number = 7;
            SAY("%d", feof(stdin) != 0);
            SAY("%d %d %s", getchar(), fgets(line, 10, stdin) == NULL, line);
            SAY("%d %d %d", feof(stdin) != 0, ferror(stdin), scanf("%d", &number));
            clearerr(stdin);
            SAY("%d", feof(stdin) != 0);
            SAY("%d", fscanf(stdin, "%d", &number));
            SAY("%c", ungetc('x', stdin));
            SAY("%d %c", feof(stdin) != 0, fgetc(stdin));
            ungetc('b', stdin);
            ungetc('a', stdin);
            fgets(line, 10, stdin);
            SAY("%s %d %d", line, feof(stdin) != 0, setvbuf(stdout, NULL, _IONBF, 0));
        }
    """
    compile_c(tmp_path, "TEST", source, "-w")
    lines = said(console_of(fly(write_mission(tmp_path, "TEST"), 1)))
    assert lines == ["0", "-1 1 kept", "1 0 -1", "0", "-1", "x", "0 x", "ab 1 0"]


def test_perror_prints_the_text_of_errno(tmp_path: Path) -> None:
    source = """
        #include <errno.h>
        #include <stdio.h>
        void TEST_Main(void)
        {
            strtol("99999999999999999999", NULL, 10);
            perror("> number");
            errno = 2;
            perror(NULL);
        }
    """
    lines = console_of(fly(_built(tmp_path, source), 1)).splitlines()
    assert "> number: Numerical result out of range" in lines
    assert "No such file or directory" in lines


@pytest.mark.parametrize("name", ["exit", "_exit", "_Exit", "quick_exit"])
def test_the_end_of_the_process_is_a_fault(tmp_path: Path, name: str) -> None:
    error = error_of(tmp_path, f"void {name}(int); void TEST_Main(void) {{ {name}(3); }}")
    assert f"{name}(3) was called, which would end cFE" in error


def test_printf_prints_long_lines_whole(tmp_path: Path) -> None:
    source = '#include <stdio.h>\nvoid TEST_Main(void) { printf("> %5000d\\n", 7); }'
    [line] = said(console_of(fly(_built(tmp_path, source), 1)))
    assert line == "7".rjust(5000)


def test_numbers_of_c23_may_be_binary(tmp_path: Path) -> None:
    source = """
        extern long parse(const char *, char **, int) __asm__("__isoc23_strtol");
        extern unsigned long parse_unsigned(const char *, char **, int) __asm__("__isoc23_strtoul");
        static void tell(const char *text, int base)
        {
            char *end;
            long value = parse(text, &end, base);
            SAY("%ld %d %lu", value, (int)(end - text), parse_unsigned(text, NULL, base));
        }
        void TEST_Main(void)
        {
            tell("0b101x", 0);
            tell(" -0B11", 2);
            tell("0b", 0);
            tell("0b2", 2);
            tell("0b101", 10);
            tell("0b0000", 2);
            tell("077", 0);
            tell("0b11111111111111111111111111111111111111111111111111111111111111111", 0);
        }
    """
    most = (1 << 64) - 1
    assert said(fly_c(tmp_path, source, flags=("-w",))) == [
        "5 5 5",
        f"-3 6 {most - 2}",
        "0 1 0",
        "0 1 0",
        "0 1 0",
        "0 6 0",
        "63 3 63",
        f"{(1 << 63) - 1} 67 {most}",
    ]


def test_a_scan_with_too_many_results_is_a_fault(tmp_path: Path) -> None:
    source = '#include <stdio.h>\nvoid TEST_Main(void) { int n; sscanf("1", "%99$d", &n); }'
    assert "sscanf() with 65 results; cfepy gives 64 at most" in error_of(tmp_path, source)


def _built(folder: Path, source: str) -> str:
    """Compile an application TEST, and return its mission."""
    compile_c(folder, "TEST", source, "-w")
    return write_mission(folder, "TEST")
