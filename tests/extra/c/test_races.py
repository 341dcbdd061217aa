"""Data races in compiled applications: accesses are scheduling points, and unordered ones are reported."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.pilot import RunPlan, fly
from cfepy.schedules import Schedule
from cfepy.writing.console import Console
from tests.extra.c.building import compile_c, compile_cpp, needs_compiler, needs_cpp, said, write_mission

pytestmark = needs_compiler

START = """
    int32_t OS_MutSemCreate(uint32_t *, const char *, uint32_t);
    int32_t OS_MutSemTake(uint32_t);
    int32_t OS_MutSemGive(uint32_t);
    int32_t OS_BinSemCreate(uint32_t *, const char *, uint32_t, uint32_t);
    int32_t OS_BinSemTake(uint32_t);
    int32_t OS_BinSemGive(uint32_t);
    static int counter, done[2];
    static uint32_t lock, ready;
    static void add(int who);
    static void other(void) { add(1); }
    void TEST_Main(void)
    {
        uint32_t id, run = RUN;
        CFE_EVS_Register(NULL, 0, 0);
        OS_MutSemCreate(&lock, "LOCK", 0);
        OS_BinSemCreate(&ready, "READY", 0, 0);
        CFE_ES_RunLoop(&run);
        CFE_ES_CreateChildTask(&id, "ADDER", other, NULL, 16384, 50, 0);
        OS_TaskDelay(200);
        add(0);
        OS_TaskDelay(500);
        CFE_ES_ExitApp(EXIT);
    }
    static void add(int who)
    {
        @
    }
"""


def explore(folder: Path, code: str, *options: str) -> list[dict[str, str]]:
    """Return the failures that an exploration finds. Each has a kind and a text."""
    compile_c(folder, "TEST", START.replace("@", code), "-fsanitize=thread", "-O0", "-w")
    out = folder / "found.json"
    main(["explore", write_mission(folder, "TEST"), "--for", "2", "--seeds", "12", "--json", str(out), *options])
    found = json.loads(out.read_text(encoding="utf-8"))
    return list(found["failures"])


@pytest.mark.slow
def test_unordered_accesses_are_reported_with_both_lines(tmp_path: Path) -> None:
    [found] = explore(tmp_path, "counter++;")
    assert found["kind"] == "data race"
    assert found["text"] == (
        "counter: read in add (TEST.c:26) of TEST, write in add (TEST.c:26) of ADDER: nothing orders them"
    )
    assert found["detail"].splitlines()[1:] == [
        "ADDER: other (TEST.c:10) > add (TEST.c:26)",
        "TEST: TEST_Main (TEST.c:20) > add (TEST.c:26)",
    ]


def test_run_under_a_given_schedule_reports_the_race(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compile_c(tmp_path, "TEST", START.replace("@", "counter++;"), "-fsanitize=thread", "-O0", "-w")
    folder = write_mission(tmp_path, "TEST")
    assert main(["run", folder, "--for", "2", "--quiet", "--schedule", "random:1"]) == 1
    told = capsys.readouterr().err
    assert "cfepy: data race at " in told
    assert "counter: read in add (TEST.c:26) of " in told
    assert main(["run", folder, "--for", "2", "--quiet"]) == 0


NESTED = """
    static int counter, loads;
    static __attribute__((noinline)) void step(void) { counter++; }
    static __attribute__((noinline)) void twice(void) { step(); }
    static int32_t validate(void *data) { twice(); return 0; }
    static void other(void) { OS_TaskDelay(100); twice(); OS_TaskDelay(1000); }
    static __attribute__((noinline)) void load(int16_t handle)
    {
        int table[4] = {loads++};
        CFE_TBL_Load(handle, 1, table);
    }
    void TEST_Main(void)
    {
        uint32_t id, run = RUN;
        int16_t handle;
        CFE_TBL_Register(&handle, "TABLE", 16, 0, validate);
        CFE_ES_CreateChildTask(&id, "ADDER", other, NULL, 16384, 50, 0);
        CFE_ES_RunLoop(&run);
        OS_TaskDelay(200);
        load(handle);
        OS_TaskDelay(1000);
    }
"""


@pytest.mark.slow
def test_stacks_go_through_calls_and_callbacks(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compile_c(tmp_path, "TEST", NESTED, "-fsanitize=thread", "-O0", "-w")
    assert main(["run", write_mission(tmp_path, "TEST"), "--for", "2", "--quiet", "--schedule", "at"]) == 1
    told = [line.strip() for line in capsys.readouterr().err.splitlines()]
    assert "s: counter: read in step (TEST.c:2) of TEST" in told[0]
    assert "ADDER: other (TEST.c:5) > twice (TEST.c:3) > step (TEST.c:2)" in told
    main_task = "TEST_Main (TEST.c:19) > load (TEST.c:9) > validate (TEST.c:4) > twice (TEST.c:3) > step (TEST.c:2)"
    assert f"TEST: {main_task}" in told


@pytest.mark.slow
def test_replay_command_of_a_race_under_fifo_reports_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    [found] = explore(tmp_path, "counter++;")
    [replay] = [line.partition("replay: ")[2] for line in capsys.readouterr().out.splitlines() if "replay: " in line]
    for command in (replay, found["command"]):
        program, *words = shlex.split(command)
        assert program == "cfepy"
        assert main([*words, "--quiet"]) == 1
        assert "cfepy: data race at " in capsys.readouterr().err


LIBC = {
    "strlen": ("name[1] = 'x';", 'SAY("%d", (int)strlen(name));'),
    "strcpy": ('strcpy(name, "xy");', 'SAY("%c", name[2]);'),
    "strncpy": ('strncpy(name, "x", 9);', 'SAY("%c", name[8]);'),
    "strcat": ('strcat(name, "d");', 'SAY("%c", name[4]);'),
    "strcmp": ("name[2] = 'x';", 'SAY("%d", strcmp(name, "abd"));'),
    "strchr": ("name[2] = 'x';", "SAY(\"%d\", strchr(name, 'c') != NULL);"),
    "snprintf": ('snprintf(name, sizeof name, "%d", 12);', 'SAY("%c", name[2]);'),
    "strtol": ("digits[1] = '5';", 'SAY("%d", (int)strtol(digits, NULL, 10));'),
    "strtok": ('strtok(name, "b");', 'strtok(digits, "2");'),
    "asctime": ("extern char *asctime(void *); asctime(NULL);", "extern char *asctime(void *); asctime(NULL);"),
    "stpcpy": ('stpcpy(name, "xy");', 'SAY("%c", name[1]);'),
}
APART = {
    "strcpy": ('strcpy(name, "xy");', 'SAY("%c", name[3]);'),
    "strncmp": ("name[3] = 'x';", 'SAY("%d", strncmp(name, "abd", 3));'),
    "strcmp": ("name[2] = 'x';", 'SAY("%d", strcmp(name, "x"));'),
    "strchr": ("name[2] = 'x';", "SAY(\"%d\", strchr(name, 'b') != NULL);"),
    "snprintf": ('snprintf(name, sizeof name, "%d", 12);', 'SAY("%c", name[3]);'),
}
TEXTS = 'static char name[16] = "abc", digits[4] = "123"; if (who) {{ {} }} else {{ {} }}'


@pytest.mark.slow
@pytest.mark.parametrize("name", LIBC)
def test_memory_accessed_by_libc_functions_counts(tmp_path: Path, name: str) -> None:
    found = explore(tmp_path, TEXTS.format(*LIBC[name]), "--seeds", "4")
    assert {each["kind"] for each in found} == {"data race"}


@pytest.mark.slow
def test_race_of_strtok_names_it(tmp_path: Path) -> None:
    found = explore(tmp_path, TEXTS.format(*LIBC["strtok"]), "--seeds", "4")
    assert any("the place of strtok(): write in" in each["text"] for each in found)


@pytest.mark.slow
@pytest.mark.parametrize("name", APART)
def test_memory_not_accessed_by_libc_functions_is_not_a_race(tmp_path: Path, name: str) -> None:
    assert explore(tmp_path, TEXTS.format(*APART[name]), "--seeds", "4") == []


WIDE = """
    typedef unsigned __int128 wide;
    wide __tsan_atomic128_load(const volatile wide *, int);
    void __tsan_atomic128_store(volatile wide *, wide, int);
    wide __tsan_atomic128_exchange(volatile wide *, wide, int);
    wide __tsan_atomic128_fetch_add(volatile wide *, wide, int);
    wide __tsan_atomic128_fetch_sub(volatile wide *, wide, int);
    wide __tsan_atomic128_fetch_and(volatile wide *, wide, int);
    wide __tsan_atomic128_fetch_nand(volatile wide *, wide, int);
    int __tsan_atomic128_compare_exchange_strong(volatile wide *, wide *, wide, int, int);
    wide __tsan_atomic128_compare_exchange_val(volatile wide *, wide, wide, int, int);
    static wide all;
    static void tell(const char *what, wide value)
    {
        SAY("%s %lx %lx", what, (long)(value >> 64), (long)value);
    }
    void TEST_Main(void)
    {
        wide big = (wide)0x1234 << 64 | 0xfffffffffffffff0, expected = 5;
        __tsan_atomic128_store(&all, big, 5);
        tell("load", __tsan_atomic128_load(&all, 5));
        tell("add", __tsan_atomic128_fetch_add(&all, 0x20, 5));
        tell("sub", __tsan_atomic128_fetch_sub(&all, (wide)1 << 65, 5));
        tell("and", __tsan_atomic128_fetch_and(&all, (wide)0xff << 64 | 0xff, 5));
        tell("nand", __tsan_atomic128_fetch_nand(&all, 0, 5));
        tell("exchange", __tsan_atomic128_exchange(&all, 7, 5));
        tell("strong", __tsan_atomic128_compare_exchange_strong(&all, &expected, big, 5, 5));
        tell("expected", expected);
        tell("strong", __tsan_atomic128_compare_exchange_strong(&all, &expected, big, 5, 5));
        tell("val", __tsan_atomic128_compare_exchange_val(&all, 1, 2, 5, 5));
        tell("val", __tsan_atomic128_compare_exchange_val(&all, big, 2, 5, 5));
        tell("last", all);
    }
"""


@pytest.mark.slow
@pytest.mark.parametrize("schedule", ["fifo", "random:1"])
def test_atomics_of_16_bytes(tmp_path: Path, schedule: str) -> None:
    compile_c(tmp_path, "TEST", WIDE, "-w")
    console = Console(quiet=True)
    plan = RunPlan((write_mission(tmp_path, "TEST"),), seconds=1, schedule=Schedule.parse(schedule))
    fly(plan, console=console)
    assert said("\n".join(console.lines)) == [
        "load 1234 fffffffffffffff0",
        "add 1234 fffffffffffffff0",
        "sub 1235 10",
        "and 1233 10",
        "nand 33 10",
        "exchange ffffffffffffffff ffffffffffffffff",
        "strong 0 0",
        "expected 0 7",
        "strong 0 1",
        "val 1234 fffffffffffffff0",
        "val 1234 fffffffffffffff0",
        "last 0 2",
    ]


@pytest.mark.slow
def test_the_race_is_found_wherever_the_memory_is(tmp_path: Path) -> None:
    for code in (
        "static char *heap; if (who) heap = malloc(4); else heap[1]++;",
        "static struct { char one, two; short both; } all; if (who) all.two = 1; else memset(&all, 0, sizeof all);"
        ' struct { char one, two; short both; } copy = {all.one, all.two, 0}; SAY("%d", copy.two);',
        "static char from[8], to[8]; if (who) memcpy(to, from, sizeof to); else to[3] = 1;",
    ):
        assert {each["kind"] for each in explore(tmp_path, code)} == {"data race"}


@pytest.mark.slow
def test_other_tasks_run_between_accesses(tmp_path: Path) -> None:
    code = """
        if (who)
            OS_BinSemTake(ready);
        else
            OS_BinSemGive(ready);
        counter++;
        if (!who) {
            OS_TaskDelay(100);
            CFE_EVS_SendEvent(1, counter == 2 ? 2 : 3, "counter %d of 2", counter);
        }
    """
    found = explore(tmp_path, code, "--policy", "random", "--seeds", "40")
    assert {each["kind"] for each in found} == {"data race", "event"}
    [event] = [each for each in found if each["kind"] == "event"]
    assert "counter 1 of 2" in event["text"]


ORDERED = {
    "a mutex": "OS_MutSemTake(lock); counter++; OS_MutSemGive(lock);",
    "a semaphore": "if (who) { counter++; OS_BinSemGive(ready); } else { OS_BinSemTake(ready); counter++; }",
    "each its own": "done[who]++;",
    "only reads": 'if (counter) SAY("%d", who);',
    "an atomic": "__atomic_fetch_add(&counter, 1, __ATOMIC_SEQ_CST);",
}


@pytest.mark.slow
@pytest.mark.parametrize(
    "how", [each if each == "a mutex" else pytest.param(each, marks=pytest.mark.slow) for each in ORDERED]
)
def test_ordered_accesses_are_not_reported(tmp_path: Path, how: str) -> None:
    assert explore(tmp_path, ORDERED[how]) == []


RELAYED = """
    static int counter;
    static unsigned char message[16];
    static void other(void)
    {
        counter = 1;
        CFE_MSG_Init(message, 0x0A01, sizeof message);
        CFE_SB_TransmitMsg(message, 1);
    }
    void TEST_Main(void)
    {
        uint32_t id, pipe, run = RUN;
        void *got;
        CFE_SB_CreatePipe(&pipe, 5, "PIPE");
        CFE_SB_Subscribe(0x0A02, pipe);
        CFE_ES_CreateChildTask(&id, "CHILD", other, NULL, 16384, 50, 0);
        CFE_ES_RunLoop(&run);
        CFE_SB_ReceiveBuffer(&got, pipe, -1);
        counter++;
        OS_TaskDelay(100);
    }
"""
RELAY = """
from cfepy.msg import header

def RELAY_Main(cfe):
    pipe = cfe.sb.create_pipe(5, "RELAY")
    cfe.sb.subscribe(0x0A01, pipe)
    cfe.sb.receive_buffer(pipe)
    @
    while cfe.es.run_loop():
        cfe.os.task_delay(100)
"""


@pytest.mark.slow
@pytest.mark.parametrize(("relays", "races"), [("pass", 1), ("cfe.sb.transmit_msg(header.init(0x0A02, 16))", 0)])
def test_python_application_between_two_tasks_orders_them(tmp_path: Path, relays: str, races: int) -> None:
    code = RELAYED if not races else RELAYED.replace("pipe, -1)", "pipe, 500)")
    compile_c(tmp_path, "TEST", code, "-fsanitize=thread", "-O0", "-w")
    (tmp_path / "RELAY.py").write_text(RELAY.replace("@", relays), encoding="utf-8")
    flown = fly(RunPlan((write_mission(tmp_path, "TEST", "RELAY"),), seconds=2, schedule=Schedule.parse("at")))
    assert len(flown.mission.record.data_races) == races
    assert flown.mission.record.deaths() == []


@pytest.mark.slow
def test_start_of_a_task_orders_accesses(tmp_path: Path) -> None:
    assert explore(tmp_path, 'if (who) SAY("%u", (unsigned)lock);') == []


@pytest.mark.slow
@needs_cpp
def test_static_objects_and_mutexes_of_cpp_order_accesses(tmp_path: Path) -> None:
    compile_cpp(
        tmp_path,
        "TEST",
        """
        #include <mutex>
        #include <string>
        static std::mutex lock;
        static int counter;
        static const std::string &text() { static std::string made("a text that is not short at all"); return made; }
        static void fly()
        {
            std::lock_guard<std::mutex> holds(lock);
            SAY("%d %s", counter++, text().c_str());
        }
        static void child() { SAY("%zu", text().size()); fly(); }
        extern "C" void TEST_Main()
        {
            uint32_t id, run = RUN;
            CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 50, 0);
            CFE_ES_RunLoop(&run);
            OS_TaskDelay(100);
            SAY("%zu", text().size());
            fly();
            OS_TaskDelay(500);
        }
        """,
        "-fsanitize=thread",
        "-O1",
    )
    assert main(["explore", write_mission(tmp_path, "TEST"), "--for", "2", "--seeds", "12"]) == 0
