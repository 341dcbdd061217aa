"""The numbers of a run, from a mission whose traffic is known."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.pilot.results import AppResult, Results, TopicResult, mark
from cfepy.rtos import AUTO, task_kind
from cfepy.writing.console import Console

APP = """
def Sender(cfe):
    cfe.evs.register()
    pipe = cfe.sb.create_pipe(2, "MINE")
    cfe.sb.subscribe_ex(0x0890, pipe, 0, 10)
    cfe.sb.subscribe_ex(0x0891, pipe, 0, 1)
    cfe.es.wait_for_startup_sync(10000)
    for _ in range(5):
        cfe.sb.transmit_msg(cfe.msg.telemetry(0x0890, b"1234"))
    cfe.sb.receive_buffer(pipe, 0)
    cfe.sb.transmit_msg(cfe.msg.telemetry(0x0891, b"1234"))
    cfe.sb.transmit_msg(cfe.msg.telemetry(0x0891, b"1234"))
    cfe.sb.transmit_msg(cfe.msg.telemetry(0x0892, b"1234"))
    while cfe.es.run_loop(1):
        cfe.os.task_delay(100)

def Restarts(cfe):
    cfe.evs.register()
    cfe.es.run_loop(1)
    cfe.os.task_delay(200)
    cfe.es.restart_app(cfe.es.get_app_id())
    while cfe.es.run_loop(1):
        cfe.os.task_delay(100)

def Leaves(cfe):
    cfe.es.run_loop(1)
    cfe.os.task_delay(200)
    cfe.os.task_exit()
"""
WALL_NS = 500_000_000


def results_of(folder: Path, *entry_points: str, seconds: float = 3) -> Results:
    (folder / "apps.py").write_text(APP, encoding="utf-8")
    lines = [f"CFE_APP, apps, {name}, {name.upper()}, 50, 8192, 0, 0;\n" for name in entry_points]
    (folder / "startup.scr").write_text("".join(lines) + "!\n", encoding="utf-8")
    with Mission(str(folder), seed=4, console=Console(quiet=True)) as mission:
        mission.run_for(seconds)
        at = mark(mission, WALL_NS)
        trace = mission.trace.digest()
    return Results.of(mission, at, trace)


def topic(results: Results, msg_id: int) -> TopicResult:
    return next(topic for topic in results.topics if topic.msg_id == msg_id)


def test_messages_are_counted_with_the_reason_of_drops(tmp_path: Path) -> None:
    results = results_of(tmp_path, "Sender")
    full = topic(results, 0x0890)
    assert (full.sent, full.delivered, full.waiting, full.dropped_pipe_full, full.dropped_limit) == (5, 1, 1, 3, 0)
    limited = topic(results, 0x0891)
    assert (limited.sent, limited.waiting, limited.dropped_limit, limited.dropped) == (2, 1, 1, 1)
    unwanted = topic(results, 0x0892)
    assert (unwanted.sent, unwanted.no_subscriber, unwanted.dropped) == (1, 1, 0)
    assert results.booted_s is not None
    assert full.rate_hz == pytest.approx(5 / (3 - results.booted_s), abs=0.001)


def test_pipes(tmp_path: Path) -> None:
    pipe = next(pipe for pipe in results_of(tmp_path, "Sender").pipes if pipe.name == "MINE")
    assert (pipe.app, pipe.depth, pipe.peak, pipe.dropped) == ("SENDER", 2, 2, 4)


def test_restarts_are_counted(tmp_path: Path) -> None:
    results = results_of(tmp_path, "Restarts", seconds=10)
    app = next(app for app in results.apps if app.name == "RESTARTS")
    assert app.restarts > 1  # it asks for the next one each time
    assert (app.deaths, app.core) == (0, False)
    assert results.problems == []


def test_application_whose_main_task_has_exited_is_ended(tmp_path: Path) -> None:
    """ES itself still takes it for RUNNING, as NASA's does."""
    results = results_of(tmp_path, "Leaves")
    assert [app.state for app in results.apps if app.name == "LEAVES"] == ["ENDED"]


def test_missing_app_is_not_started(tmp_path: Path) -> None:
    results = results_of(tmp_path, "Missing")
    assert [app.state for app in results.apps if app.name == "MISSING"] == ["NOT STARTED"]
    assert results.script_problems == ["MISSING could not be started"]


def test_results_have_times_and_counters_of_the_run(tmp_path: Path) -> None:
    results = results_of(tmp_path, "Sender")
    assert (results.virtual_s, results.wall_s, results.speed) == (3.0, 0.5, 6.0)
    assert (results.seed, results.board, results.tasks) == (4, "linux", task_kind(AUTO).name)
    assert results.events["INFORMATION"] > 20
    assert results.sb["MsgLimitErrorCounter"] == 1
    assert results.sb["PipeOverflowErrorCounter"] == 3


def test_results_are_serializable_as_json(tmp_path: Path) -> None:
    results = results_of(tmp_path, "Sender")
    assert json.loads(json.dumps(results.to_dict()))["topics"][0]["msg_id"] == results.topics[0].msg_id


def test_finished_mission_leaves_no_modules(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text("CFE_APP, hk, HK_AppMain, HK, 50, 16384, 0, 0;\n!", encoding="utf-8")
    before = set(sys.modules)
    with Mission(str(tmp_path), console=Console(quiet=True)) as mission:
        mission.run_for(1)
    assert [name for name in set(sys.modules) - before if name.startswith("cfepy_app")] == []


@pytest.mark.parametrize(
    ("share", "text"),
    [(0, "0.00%"), (1e-9, "<0.0001%"), (4.2e-6, "0.0004%"), (0.00042, "0.0420%"), (0.0123, "1.23%"), (1, "100.00%")],
)
def test_small_share_of_the_cpu_is_greater_than_zero(share: float, text: str) -> None:
    assert AppResult("APP", "RUNNING", share, 0, 0, None, False).cpu_text == text
