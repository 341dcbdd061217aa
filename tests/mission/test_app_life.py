"""Applications that end, fail, restart and hang, in whole missions."""

from __future__ import annotations

import _thread
from pathlib import Path

import pytest

from cfepy.es.records import RUNNING
from cfepy.mission import Mission
from cfepy.rtos.context import drain
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

APP = "CFE_APP, {0}, {0}_main, {1}, 50, 16384, 0x0, {2};\n"

CRASHING = """
    COUNT = 0

    def crash_main(cfe):
        global COUNT
        COUNT += 1
        cfe.evs.register()
        cfe.evs.send_info(1, f"start {COUNT}")
        pipe = cfe.sb.create_pipe(3, "CRASH_PIPE")
        cfe.sb.subscribe(0x1882, pipe)
        cfe.es.run_loop()
        cfe.os.task_delay(700)
        raise ValueError("a wheel fell off")
"""


def fly(folder: str, seconds: float, tasks: str = "thread", **options: object) -> Mission:
    mission = Mission(folder, console=Console(quiet=True), tasks=tasks, **options)  # type: ignore[arg-type]
    try:
        mission.run_for(seconds)
    finally:
        mission.close()
    return mission


def text_of(mission: Mission) -> str:
    return "\n".join(mission.console.lines)


def test_app_that_dies_is_restarted_with_fresh_variables(tmp_path: Path) -> None:
    folder = write_mission(tmp_path, APP.format("crash", "CRASH", 0) + "!", crash=CRASHING)
    mission = fly(folder, 20)
    text = text_of(mission)
    assert mission.cfe.es.history["CRASH"].restarts >= 1
    assert mission.cfe.es.history["CRASH"].deaths >= 2
    assert "start 1" in text
    assert "start 2" not in text
    assert "CFE_ES_RestartApp: Restart Application CRASH Initiated" in text
    assert "Restart Application CRASH Completed, AppID=1114119" in text
    assert not mission.record.resets


def test_traceback_shows_only_lines_of_the_app(tmp_path: Path) -> None:
    folder = write_mission(tmp_path, APP.format("crash", "CRASH", 0) + "!", crash=CRASHING)
    lines = fly(folder, 2).console.lines
    begin = lines.index("Traceback (most recent call last):")
    end = next(number for number, line in enumerate(lines) if line.startswith("ValueError"))
    files = [line for line in lines[begin:end] if line.lstrip().startswith("File ")]
    assert len(files) == 1
    assert "crash.py" in files[0]
    assert "ValueError: a wheel fell off (crash.py:13)" in text_of(fly(folder, 2))


def test_exception_action_1_resets_the_processor(tmp_path: Path) -> None:
    folder = write_mission(tmp_path, APP.format("crash", "CRASH", 1) + "!", crash=CRASHING)
    mission = fly(folder, 20)
    first = mission.record.resets[0]
    assert first.reason == "CRASH: ValueError: a wheel fell off (crash.py:13)"
    assert first.fault
    assert first.at_ns < 3_000_000_000
    assert "CFE_PSP: Exiting cFE with PROCESSOR Reset status." in mission.console.lines


def test_app_that_returns_has_exited(tmp_path: Path) -> None:
    source = """
        def short_main(cfe):
            cfe.evs.register()
            cfe.es.run_loop()
    """
    mission = fly(write_mission(tmp_path, APP.format("short", "SHORT", 0) + "!", short=source), 4)
    assert "Exit Application SHORT Completed." in text_of(mission)
    assert mission.cfe.es.app_named("SHORT") is None


LEAKY = """
    import time

    def leaky_main(cfe):
        es, os, sb = cfe.es, cfe.os, cfe.sb
        cfe.evs.register()
        pipe = sb.create_pipe(5, "LEAKY")
        sb.subscribe(0x1882, pipe)
        os.queue_create("LEAKY_Q", 3, 8)
        os.bin_sem_create("LEAKY_B", 0)
        os.count_sem_create("LEAKY_C", 0)
        os.mut_sem_create("LEAKY_M")
        es.pool_create(1000)
        cfe.tbl.register("LeakyTable", 64)
        es.create_child_task("LEAKY_CHILD", lambda: os.task_delay(10_000_000), 4096, 60)
        while es.run_loop():
            sb.receive_buffer(pipe, 100)
"""


@pytest.mark.parametrize(
    ("tasks", "count"),
    [
        *(("thread", 25), ("greenlet", 25)),
        *(pytest.param(tasks, 100, marks=pytest.mark.slow) for tasks in ("thread", "greenlet")),
    ],
)
def test_many_restarts_leave_nothing_behind(tmp_path: Path, tasks: str, count: int) -> None:
    folder = write_mission(tmp_path, APP.format("leaky", "LEAKY", 0) + "!", leaky=LEAKY)
    drain()
    threads = _thread._count()
    mission = Mission(folder, console=Console(quiet=True), tasks=tasks)
    with mission:
        mission.run_for(2)
        es = mission.cfe.es
        before = held(mission)
        for number in range(count):
            app = es.app_named("LEAKY")
            assert app is not None, number
            assert app.state == RUNNING
            es.restart_app(app.app_id)
            mission.run_for(8)
        assert es.history["LEAKY"].restarts == count
        assert held(mission) == before
    drain()
    assert _thread._count() == threads


def held(mission: Mission) -> dict[str, int]:
    """Return the number of objects of every kind."""
    cfe = mission.cfe
    return {
        "tasks": len(mission.kernel.tasks),
        "apps": len(cfe.es.apps),
        "pools": len(cfe.es.pools),
        "pipes": len(cfe.sb.pipes),
        "subscriptions": cfe.sb.subscriptions,
        "memory": mission.memory.used,
        "ready": len(mission.kernel.ready),
    }


def test_mission_is_closed_while_an_app_refuses_to_end(tmp_path: Path) -> None:
    source = """
        def stubborn_main(cfe):
            while True:
                try:
                    cfe.os.task_delay(10)
                except BaseException:
                    pass
    """
    mission = fly(write_mission(tmp_path, APP.format("stubborn", "STUBBORN", 0) + "!", stubborn=source), 2)
    assert [task.name for task in mission.kernel.stuck] == ["STUBBORN"]


@pytest.mark.parametrize("name", ["a_talker_without_suffix", "a_script_with_a_long_name.py"])
def test_node_scripts_may_have_any_file_name(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text(
        "#!/usr/bin/env python\nprint(__name__, __file__.rpartition('/')[2])\n", encoding="utf-8"
    )
    startup = f"CFE_APP, {name}, __main__, TALKER, 60, 16384, 0, 0;\n!"
    with fly(write_mission(tmp_path, startup), 1) as mission:
        assert f"[TALKER] __main__ {name}" in text_of(mission)
        assert "Could not load file" not in text_of(mission)


def test_script_without_suffix_is_preferred_to_one_with_suffix(tmp_path: Path) -> None:
    (tmp_path / "talker").write_text("print('the one that is meant')\n", encoding="utf-8")
    (tmp_path / "talker.py").write_text("print('another one')\n", encoding="utf-8")
    with fly(write_mission(tmp_path, "CFE_APP, talker, __main__, TALKER, 60, 16384, 0, 0;\n!"), 1) as mission:
        assert "[TALKER] the one that is meant" in text_of(mission)


NOBODYS = """
    from cfepy.osal import NOBODY
    from cfepy.status import CfeError

    def work(cfe):
        try:
            cfe.es.get_app_id()
        except CfeError as error:
            cfe.es.write_to_sys_log(f"no application: {error.hex}")
        for call in (lambda: cfe.evs.send_info(1, "hello"), lambda: cfe.tbl.register("TABLE", 8)):
            try:
                call()
            except CfeError as error:
                cfe.es.write_to_sys_log(f"refused: {error.hex}")
        cfe.sb.create_pipe(1, "PIPE")
        cfe.os.task_delay(2000)
        raise ValueError("a stray pointer")

    def maker_main(cfe):
        nested = lambda: cfe.os.task_create("NESTED", lambda: work(cfe), 4096, 120)
        cfe.os.task_create("WORKER", nested, 4096, 110, owner=NOBODY)
        cfe.os.task_delay(100)
        cfe.es.exit_app()
"""


@pytest.mark.parametrize("action", [0, 1])
def test_exception_in_a_task_without_an_application_resets_the_processor(tmp_path: Path, action: int) -> None:
    folder = write_mission(tmp_path, APP.format("maker", "MAKER", action) + "!", maker=NOBODYS)
    mission = fly(folder, 20)
    first = mission.record.resets[0]
    assert first.reason == "task NESTED: ValueError: a stray pointer (maker.py:17)"
    assert first.fault
    text = text_of(mission)
    assert "no application: 0xC4000001" in text  # CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert "refused: 0xC2000003" in text  # CFE_EVS_APP_ILLEGAL_APP_ID
    assert "refused: 0xC4000001" in text
    assert "Exit Application MAKER Completed" in text  # before, and its tasks went on
    assert "system: task NESTED died of an exception" in text
    assert "CFE_ES_RunExceptionScan: Processor Reset count not reached (0/2)" in text
    assert "CFE_ES_RunExceptionScan: Maximum Processor Reset count reached (2)" in text
    assert not [task for task in mission.kernel.tasks if task.name == "NESTED"]
