"""Tools that look at a task's Python frames see lines of C."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.extra.c.building import compile_c, needs_compiler, write_mission

pytestmark = needs_compiler

RACE = """
    static volatile int counter, done;
    static void add(const char *who)
    {
        for (int i = 0; i < 3; i++) {
            int seen = counter;
            SAY("%s adds", who);
            counter = seen + 1;
            OS_TaskDelay(10);
        }
        done++;
    }
    static void other(void) { add("child"); }
    void TEST_Main(void)
    {
        uint32_t id, run = RUN;
        CFE_EVS_Register(NULL, 0, 0);
        CFE_ES_CreateChildTask(&id, "ADDER", other, NULL, 16384, 50, 0);
        CFE_ES_RunLoop(&run);
        OS_TaskDelay(50);
        add("main");
        while (done < 2)
            OS_TaskDelay(10);
        CFE_EVS_SendEvent(1, counter == 6 ? 2 : 3, "counter %d of 6", counter);
        CFE_ES_ExitApp(EXIT);
    }
"""


@pytest.mark.slow
def test_lost_update_is_found_and_its_timeline_shows_lines_of_c(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    compile_c(tmp_path, "TEST", RACE)
    folder = write_mission(tmp_path, "TEST")
    assert main(["explore", folder, "--for", "2", "--seeds", "30"]) == 1
    shown = capsys.readouterr().out
    assert "ERROR event 1: counter 5 of 6" in shown
    assert 'SAY("%s adds", who);' in shown
    assert "PREEMPTED by ADDER" in shown


def test_deadlock_is_reported_with_the_waiting_lines_of_c(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compile_c(
        tmp_path,
        "TEST",
        """
        static uint32_t a, b;
        static void other(void)
        {
            OS_MutSemTake(b);
            OS_TaskDelay(20);
            OS_MutSemTake(a);
        }
        void TEST_Main(void)
        {
            uint32_t id, run = RUN;
            CFE_ES_RunLoop(&run);
            OS_MutSemCreate(&a, "A", 0);
            OS_MutSemCreate(&b, "B", 0);
            CFE_ES_CreateChildTask(&id, "OTHER", other, NULL, 16384, 60, 0);
            OS_TaskDelay(60);
            OS_MutSemTake(a);
            OS_TaskDelay(20);
            OS_MutSemTake(b);
        }
        """,
    )
    out = tmp_path / "found.json"
    assert main(["explore", write_mission(tmp_path, "TEST"), "--for", "2", "--seeds", "2", "--json", str(out)]) == 1
    assert "deadlock" in json.dumps(json.loads(out.read_text(encoding="utf-8")))
    assert "TEST" in capsys.readouterr().out
