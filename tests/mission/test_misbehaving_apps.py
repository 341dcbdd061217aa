"""Misbehaving applications and libraries: the mission continues, reports the error, and its digest stays the same."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.pilot.results import Results, mark
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

APP = "CFE_APP, app, Main, APP, 50, 16384, 0x0, 0;\n"
LIBRARY = "CFE_LIB, app, Init, LIBRARY, 0, 0, 0x0, 0;\n"
READY = "    cfe.evs.register()\n    cfe.es.run_loop()\n    cfe.os.task_delay(700)\n"


def fly(folder: Path, source: str, startup: str = APP, seconds: float = 3.0, tasks: str = "thread") -> Mission:
    write_mission(folder, startup + "!")
    (folder / "app.py").write_text(source, encoding="utf-8")
    with Mission(str(folder), console=Console(quiet=True), tasks=tasks) as mission:
        mission.run_for(seconds)
    return mission


def text_of(mission: Mission) -> str:
    return "\n".join(mission.console.lines)


def error_of(mission: Mission) -> str | None:
    results = Results.of(mission, mark(mission, 1), mission.trace.digest())
    return next(app.error for app in results.apps if app.name == "APP")


@pytest.mark.parametrize("statement", ["import sys; sys.exit(3)", "raise GeneratorExit", "1 / 0"])
def test_module_that_cannot_be_executed_fails_its_startup_line(tmp_path: Path, statement: str) -> None:
    mission = fly(tmp_path, f"{statement}\ndef Main(cfe): pass")
    assert mission.booted is not None
    assert "CFE_ES_LoadModule: Could not load file:" in text_of(mission)


@pytest.mark.parametrize("statement", ["raise ValueError('spring')", "import sys; sys.exit(4)"])
def test_library_with_a_failed_init_is_not_loaded(tmp_path: Path, statement: str) -> None:
    mission = fly(tmp_path, f"def Init(cfe):\n    {statement}", LIBRARY)
    assert mission.booted is not None
    assert "CFE_ES_LoadLibrary: Load Shared Library Init Error = 0xffffffff" in text_of(mission)
    assert not list(mission.cfe.es.libs)


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("async def Main(cfe):\n    pass", "Main of /cf/app.so is async: calling it runs nothing"),
        ("def Main(cfe):\n    yield", "Main of /cf/app.so is a generator (it has a yield): calling it runs nothing"),
        ("def Main():\n    pass", "Main of /cf/app.so must take one argument, the handle of the services"),
        ("def Main(cfe, more):\n    pass", "write `def Main(cfe):`"),
    ],
)
def test_invalid_entry_point_is_refused(tmp_path: Path, source: str, said: str) -> None:
    mission = fly(tmp_path, source)
    assert said in text_of(mission)
    assert "APP" not in mission.cfe.es.history


def test_any_exception_ends_only_its_app(tmp_path: Path) -> None:
    mission = fly(tmp_path, f"class Own(BaseException): pass\ndef Main(cfe):\n{READY}    raise Own('mine')\n")
    assert not mission.record.resets
    assert error_of(mission) == "Own: mine"  # also after the restart, and however that one ends


@pytest.mark.parametrize("body", ["raise KeyError", "return 5"])
def test_exception_without_a_text_is_reported(tmp_path: Path, body: str) -> None:
    source = f"class Own(Exception):\n    def __str__(self): {body}\n\ndef Main(cfe):\n{READY}    raise Own\n"
    mission = fly(tmp_path, source)
    assert "app_0_1.Own: <exception str() failed>" in text_of(mission)
    assert error_of(mission) == "Own: its text is not available"


def test_text_outside_utf8_is_kept_in_the_error(tmp_path: Path) -> None:
    mission = fly(
        tmp_path, f"def Main(cfe):\n{READY}    cfe.es.write_to_sys_log('\\ud800')\n    raise OSError('\\ud800')"
    )
    assert error_of(mission) == "OSError: \ud800"


def test_module_keeps_its_name_in_every_run_and_is_removed(tmp_path: Path) -> None:
    source = f"def Main(cfe):\n    cfe.os.printf(__name__)\n{READY}    raise ValueError\n"
    before = set(sys.modules)
    runs = [fly(tmp_path, source, seconds=5) for _ in range(2)]
    assert "cfepy_app_0_1" in text_of(runs[0])
    assert runs[0].trace.digest() == runs[1].trace.digest()
    assert set(sys.modules) <= before


def test_restarts_leave_no_modules_behind(tmp_path: Path) -> None:
    write_mission(tmp_path, APP + "!", app=f"def Main(cfe):\n{READY}    raise ValueError\n")
    with Mission(str(tmp_path), console=Console(quiet=True)) as mission:
        mission.run_for(20)
        assert mission.cfe.es.history["APP"].restarts > 1
        assert len([name for name in sys.modules if name.startswith("cfepy_app_")]) == 2  # the place, and the last one


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_runaway_recursion_ends_with_the_same_traceback_on_threads_and_greenlets(tmp_path: Path, tasks: str) -> None:
    if tasks == "greenlet":
        pytest.importorskip("greenlet")
    mission = fly(tmp_path, f"def deeper(): deeper()\ndef Main(cfe):\n{READY}    deeper()\n", tasks=tasks)
    assert "[Previous line repeated 47 more times]" in text_of(mission)


def test_traceback_hides_frames_of_cfepy_in_its_chain(tmp_path: Path) -> None:
    source = f"""
def Main(cfe):
{READY}
    try:
        cfe.es.restart_app(cfe.es.get_app_id())
        while True:
            cfe.os.task_delay(100)
    finally:
        raise ValueError("while it was ended")
"""
    mission = fly(tmp_path, source, seconds=9)
    text = text_of(mission)
    assert "while it was ended" in text
    assert "kernel.py" not in text
    assert not mission.record.resets  # it was being ended anyway
    assert mission.cfe.es.history["APP"].restarts >= 1


@pytest.mark.parametrize("time", ["0.25", "float('nan')"])
def test_the_clock_stays_a_whole_number(tmp_path: Path, time: str) -> None:
    mission = fly(tmp_path, f"def Main(cfe):\n{READY}    cfe.os.task_delay({time})\n")
    assert type(mission.kernel.now) is int
    assert "time must be an int, not " in text_of(mission)


@pytest.mark.parametrize("statement", ["raise ValueError('tick')", "import sys; sys.exit()"])
def test_timer_with_a_failed_callback_stops(tmp_path: Path, statement: str) -> None:
    source = f"""
def Main(cfe):
    def tick(timer_id):
        {statement}
{READY}
    timer = cfe.os.timer_create("TICK", tick)
    cfe.os.timer_set(timer, 1000, 1000)
    while cfe.es.run_loop():
        cfe.os.task_delay(100)
"""
    mission = fly(tmp_path, source, seconds=2)
    assert mission.cfe.es.history["APP"].deaths == 1


def test_callback_of_a_timer_cannot_send_because_it_belongs_to_no_application(tmp_path: Path) -> None:
    """As on NASA's cFE: a message needs a buffer, and a buffer an application."""
    source = f"""
from cfepy.msg import command
from cfepy.status import CFE_SB_BUF_ALOC_ERR, CfeError

def Main(cfe):
    def tick(timer_id):
        try:
            cfe.sb.transmit_msg(command(0x1890, 0))
        except CfeError as error:
            assert error.status == CFE_SB_BUF_ALOC_ERR
            cfe.os.printf("refused\\n")
{READY}
    timer = cfe.os.timer_create("TICK", tick)
    cfe.os.timer_set(timer, 1000, 0)
    while cfe.es.run_loop():
        cfe.os.task_delay(100)
"""
    mission = fly(tmp_path, source, seconds=2)
    assert mission.cfe.es.history["APP"].deaths == 0
    assert "refused" in text_of(mission)
    assert "CFE_ES_GetTaskInfo: Task ID Not Active: 0" in text_of(mission)


@pytest.mark.parametrize("in_timer", [False, True])
def test_apps_that_die_at_the_same_time_are_all_restarted(tmp_path: Path, in_timer: bool) -> None:
    fail = "    1 / 0\n"
    if in_timer:
        fail = (
            "    timer = cfe.os.timer_create(f'T{cfe.es.get_app_id()}', lambda timer: 1 / 0)\n"
            "    cfe.os.timer_set(timer, 100_000, 0)\n    cfe.os.task_delay(100_000)\n"
        )
    names = ("APP", "APP2", "APP3")
    startup = "".join(APP.replace("APP, 50", f"{name}, 50") for name in names)
    source = "def Main(cfe):\n" + READY.replace("700", "20_000") + fail
    mission = fly(tmp_path, source, startup, seconds=35)
    history = mission.cfe.es.history
    assert [(history[name].deaths, history[name].restarts) for name in names] == [(1, 1)] * 3
    assert ("in TaskID 0:" in text_of(mission)) == in_timer  # a time base is not a task of OSAL's


FAILING_HANDLERS = {
    "delete": "    def fail():\n        1 / 0\n    cfe.os.task_install_delete_handler(fail)\n",
    "event": "    cfe.os.register_event_handler(lambda event, object_id, data: 1 / (event != 3))\n",
}


@pytest.mark.parametrize("kind", FAILING_HANDLERS)
def test_failed_handlers_do_not_prevent_the_end(tmp_path: Path, kind: str) -> None:
    source = (
        "def Main(cfe):\n" + READY.replace("700", "1") + FAILING_HANDLERS[kind] + "    cfe.os.task_delay(100_000)\n"
    )
    write_mission(tmp_path, APP + "!", app=source)
    with Mission(str(tmp_path), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        mission.processor.psp.restart(1, "the test wants it")
        mission.run_for(2)
        assert mission.processor.booted is not None
        assert len(mission.record.resets) == 1


def test_failed_delete_handler_is_an_error_of_its_application(tmp_path: Path) -> None:
    source = (
        "def Main(cfe):\n" + READY.replace("700", "1") + FAILING_HANDLERS["delete"] + "    cfe.os.task_delay(100_000)\n"
    )
    write_mission(tmp_path, APP + "!", app=source)
    with Mission(str(tmp_path), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        mission.cfe.es.delete_app(mission.cfe.es.get_app_id_by_name("APP"))
        mission.run_for(9)
        assert "APP: task APP died of an exception" in text_of(mission)
        assert mission.cfe.es.app_named("APP") is None
        assert not mission.record.resets
