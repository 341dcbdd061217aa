"""The trace for Perfetto: it follows the rules of the Trace Event Format, and shows the run."""

from __future__ import annotations

import io
import json
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

import pytest

from cfepy.extra.reports.collector import Collector
from cfepy.extra.reports.perfetto import STEP_NS, PerfettoTrace
from tests.extra.reports import looked_at
from tests.extra.reports.conftest import Shown
from tests.mission.flights import write_mission

Event = dict[str, Any]


def tracks(events: list[Event], phases: str) -> dict[tuple[int, int], list[Event]]:
    found: dict[tuple[int, int], list[Event]] = defaultdict(list)
    for event in events:
        if event["ph"] in phases:
            found[event["pid"], event["tid"]].append(event)
    return found


def names(events: list[Event], what: str) -> dict[tuple[int, int], str]:
    return {(each["pid"], each["tid"]): each["args"]["name"] for each in events if each.get("name") == what}


def test_perfetto_trace_does_not_change_the_run(shown: Shown) -> None:
    assert shown.flown.trace == looked_at.fly(shown.mission).trace
    assert looked_at.perfetto(shown.mission)[0].trace == shown.flown.trace


@pytest.mark.parametrize("schedule", ["random:3", "pct:5:3", "random:1:any"])
def test_perfetto_trace_does_not_change_runs_under_other_schedules(shown: Shown, schedule: str) -> None:
    file = io.StringIO()
    plain = looked_at.fly(shown.mission, seconds=1.5, schedule=schedule)
    seen = looked_at.fly(shown.mission, PerfettoTrace(file), Collector(), seconds=1.5, schedule=schedule)
    assert plain.trace == seen.trace
    for events in tracks(json.loads(file.getvalue())["traceEvents"], "BE").values():
        assert [event["ph"] for event in events] == ["B", "E"] * (len(events) // 2)


def test_threads_and_greenlets_give_the_same_file(shown: Shown) -> None:
    file = io.StringIO()
    looked_at.fly(shown.mission, PerfettoTrace(file), tasks="greenlet")
    assert json.loads(file.getvalue())["traceEvents"] == shown.events


def test_every_slice_has_a_begin_and_an_end(shown: Shown) -> None:
    for events in tracks(shown.events, "BE").values():
        assert [event["ph"] for event in events] == ["B", "E"] * (len(events) // 2)


def test_times_rise_in_each_track(shown: Shown) -> None:
    for events in tracks(shown.events, "BEXi").values():
        times = [event["ts"] for event in events]
        assert times == sorted(times)
        assert len(set(times)) == len(times), "two things of a track at one place cannot be told apart"


def test_messages_lie_inside_the_slice_of_their_task(shown: Shown) -> None:
    inside = 0
    for events in tracks(shown.events, "BEX").values():
        is_open, until = False, -1.0
        for event in events:
            assert event["ts"] >= until, "slices of a track overlap"
            if event["ph"] == "X":
                inside += is_open
                until = event["ts"] + event["dur"] - 1e-6
            else:
                is_open = event["ph"] == "B"
    assert inside == sum(event["ph"] == "X" for event in shown.events) > 100


def test_every_arrow_connects_two_messages(shown: Shown) -> None:
    starts = {event["id"]: event for event in shown.events if event["ph"] == "s"}
    ends = {event["id"]: event for event in shown.events if event["ph"] == "f"}
    assert starts.keys() == ends.keys()
    assert len(starts) == sum(event["ph"] == "s" for event in shown.events) > 50
    slices = {(each["pid"], each["tid"], each["ts"]): each for each in shown.events if each["ph"] == "X"}
    for number, start in starts.items():
        end = ends[number]
        sent = slices[start["pid"], start["tid"], start["ts"]]
        received = slices[end["pid"], end["tid"], end["ts"]]
        assert end["bp"] == "e"
        assert start["cat"] == end["cat"]
        assert start["name"] == end["name"]
        assert sent["name"].replace("send", "receive") == received["name"]
        assert sent["args"]["sequence"] == received["args"]["sequence"]
        assert sent["args"]["virtual_ns"] <= received["args"]["virtual_ns"]


def test_every_received_message_has_an_arrow(shown: Shown) -> None:
    taken = sum(topic.delivered for topic in shown.flown.results.topics)
    assert sum(event["ph"] == "f" for event in shown.events) >= taken


def test_tracks_are_named_after_applications_and_tasks(shown: Shown) -> None:
    processes = {pid: name for (pid, _), name in names(shown.events, "process_name").items()}
    threads = names(shown.events, "thread_name")
    assert {"mission", "SLOW", "FLOOD", "TALK", "HEAR", "CFE_ES"} <= set(processes.values())
    for pid, tid in tracks(shown.events, "BEXi"):
        assert pid in processes
        assert (pid, tid) in threads
    of_slow = [name for (pid, _), name in threads.items() if processes[pid] == "SLOW"]
    assert of_slow == ["SLOW"]


def test_slices_have_their_virtual_time_and_are_moved_by_less_than_100_ns(shown: Shown) -> None:
    told = [event for event in shown.events if "virtual_ns" in event.get("args", {})]
    for event in told:
        ahead_ns = event["ts"] * 1000 - event["args"]["virtual_ns"]
        assert -0.5 <= ahead_ns < 20_000, event
    assert max(event["args"]["virtual_ns"] for event in told) > 2_900_000_000
    assert STEP_NS < 100


def test_counters_are_the_depths_of_pipes(shown: Shown) -> None:
    deepest: Counter[str] = Counter()
    for event in shown.events:
        if event["ph"] == "C":
            deepest[event["name"]] = max(deepest[event["name"]], event["args"]["waiting"])
    peaks = {f"pipe {pipe.name}": pipe.peak for pipe in shown.flown.results.pipes}
    assert deepest["pipe SLOW_PIPE"] == peaks["pipe SLOW_PIPE"] == 2


def test_events_drops_and_overruns_are_instants(shown: Shown) -> None:
    instants = [event for event in shown.events if event["ph"] == "i"]
    by_kind = Counter(event["cat"] for event in instants)
    results = shown.flown.results
    assert by_kind["events"] >= sum(results.events.values())
    assert by_kind["deadline"] == sum(each.overruns for each in results.deadlines) > 0
    assert by_kind["drop"] == sum(topic.dropped for topic in results.topics) > 0
    texts = [event["args"].get("text") for event in instants if event["cat"] == "events"]
    assert "an error <b>of its own</b>" in texts
    assert all(event["s"] in "gpt" for event in instants)


def test_markers_of_the_performance_log_are_paired(shown: Shown) -> None:
    depth: Counter[tuple[int, str]] = Counter()
    for event in shown.events:
        if event["ph"] in "be":
            depth[event["pid"], event["id"]] += 1 if event["ph"] == "b" else -1
            assert depth[event["pid"], event["id"]] in (0, 1)
    assert depth
    assert not any(depth.values())


def test_reset_is_shown_and_the_run_continues(tmp_path: Path) -> None:
    app = """\
    def AGAIN_AppMain(cfe):
        cfe.es.wait_for_startup_sync(1000)
        cfe.os.task_delay(300)
        if cfe.es.get_reset_type()[0] == 2:
            cfe.es.reset_cfe(1)
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
    """
    mission = write_mission(tmp_path, "CFE_APP, /cf/again.so, AGAIN_AppMain, AGAIN, 50, 8192, 0x0, 0;\n", again=app)
    flown, events = looked_at.perfetto(mission)
    assert len(flown.results.resets) == 1
    (reset,) = [event for event in events if event.get("cat") == "resets"]
    assert reset["s"] == "g"
    assert reset["args"]["virtual_ns"] == round(flown.results.resets[0].at_s * 1e9)
    pids = {pid for (pid, _), name in names(events, "process_name").items() if name == "AGAIN"}
    assert len(pids) == 1
    for slices in tracks(events, "BE").values():
        assert [event["ph"] for event in slices] == ["B", "E"] * (len(slices) // 2)
    after = [event for event in events if event["ph"] == "B" and event["pid"] in pids and event["ts"] > reset["ts"]]
    assert len(after) > 5
