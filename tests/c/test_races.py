"""Data races in compiled applications: accesses are scheduling points, and those that nothing orders are told."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.c.building import compile_c, compile_cpp, needs_compiler, needs_cpp, write_mission

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
    """The failures that an exploration finds; each has a kind and a text."""
    compile_c(folder, "TEST", START.replace("@", code), "-fsanitize=thread", "-O0", "-w")
    out = folder / "found.json"
    main(["explore", write_mission(folder, "TEST"), "--for", "2", "--seeds", "12", "--json", str(out), *options])
    found = json.loads(out.read_text())
    return list(found["failures"])


def test_accesses_that_nothing_orders_are_told_with_both_places(tmp_path: Path) -> None:
    [found] = explore(tmp_path, "counter++;")
    assert found["kind"] == "data race"
    assert found["text"] == (
        "counter: read in add (TEST.c:26) of TEST, write in add (TEST.c:26) of ADDER: nothing orders them"
    )


def test_a_run_under_a_given_schedule_tells_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compile_c(tmp_path, "TEST", START.replace("@", "counter++;"), "-fsanitize=thread", "-O0", "-w")
    folder = write_mission(tmp_path, "TEST")
    assert main(["run", folder, "--for", "2", "--quiet", "--schedule", "random:1"]) == 1
    told = capsys.readouterr().err
    assert "cfepy: data race at " in told
    assert "counter: read in add (TEST.c:26) of " in told
    assert main(["run", folder, "--for", "2", "--quiet"]) == 0


def test_the_race_is_found_wherever_the_memory_is(tmp_path: Path) -> None:
    for code in (
        "static char *heap; if (who) heap = malloc(4); else heap[1]++;",
        "static struct { char one, two; short both; } all; if (who) all.two = 1; else memset(&all, 0, sizeof all);"
        ' struct { char one, two; short both; } copy = {all.one, all.two, 0}; SAY("%d", copy.two);',
        "static char from[8], to[8]; if (who) memcpy(to, from, sizeof to); else to[3] = 1;",
    ):
        assert {each["kind"] for each in explore(tmp_path, code)} == {"data race"}


def test_others_run_between_accesses(tmp_path: Path) -> None:
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


@pytest.mark.parametrize("how", ORDERED)
def test_accesses_that_are_ordered_are_not(tmp_path: Path, how: str) -> None:
    assert explore(tmp_path, ORDERED[how]) == []


def test_the_start_of_a_task_orders(tmp_path: Path) -> None:
    assert explore(tmp_path, 'if (who) SAY("%u", (unsigned)lock);') == []


@needs_cpp
def test_static_objects_and_mutexes_of_cpp_order(tmp_path: Path) -> None:
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
