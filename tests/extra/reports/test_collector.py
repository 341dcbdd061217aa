"""The collected data of a run is true, and does not grow with its length."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.extra.reports import bins
from cfepy.extra.reports.bins import Bins, Histogram
from cfepy.extra.reports.collector import MOST_OF_A_KIND, Collector
from cfepy.extra.reports.noteworthy import mark_of
from tests.extra.reports import looked_at
from tests.extra.reports.conftest import Shown
from tests.mission.flights import write_mission

TIMES = st.lists(st.integers(0, 10**12), min_size=1, max_size=200)


@given(TIMES)
def test_bins_keep_the_count_when_they_fold(times: list[int]) -> None:
    found = Bins()
    for time in times:
        found.add(time)
    assert len(found.counts) <= bins.MOST_BINS
    assert sum(found.counts) == len(times)
    assert all(found.counts[time // found.width_ns] for time in times)


@given(TIMES)
def test_run_lengths_decode_to_the_counts(times: list[int]) -> None:
    found = Bins()
    for time in times:
        found.add(time)
    coded = found.runs(4 * found.width_ns)
    plain = [value for at in range(0, len(coded), 2) for value in [coded[at]] * coded[at + 1]]
    assert plain == found.counts
    assert sum(plain) == len(times)


@given(st.lists(st.tuples(st.integers(0, 10**9), st.integers(0, 10**7)), min_size=1, max_size=30))
def test_spans_are_counted_to_the_ns(spans: list[tuple[int, int]]) -> None:
    found = Bins()
    for start, length in spans:
        found.add_span(start, start + min(length, 50 * found.width_ns))
    widest = found.width_ns
    assert sum(found.counts) <= sum(length for _, length in spans)
    assert all(count <= widest * len(spans) for count in found.counts)


def test_span_is_counted_in_each_of_its_bins() -> None:
    found = Bins()
    found.add_span(500, 3200)
    assert found.counts == [500, 1000, 1000, 200]


@given(TIMES, st.floats(0.01, 1))
def test_percentiles_are_within_a_64th_of_the_exact_ones(times: list[int], share: float) -> None:
    found = Histogram()
    for time in times:
        found.add(time)
    rank = next(index for index in range(1, len(times) + 1) if index >= share * len(times))
    exact = sorted(times)[rank - 1]
    (percentile,) = found.percentiles([share])
    assert exact * (1 - 1 / 64) <= percentile <= exact
    assert found.most_ns == max(times)
    assert found.count == len(times)
    assert sum(found.octaves().values()) == len(times)


def test_short_times_are_exact() -> None:
    found = Histogram()
    for time in range(100):
        found.add(time)
    assert found.percentiles([0.5, 0.95, 0.99]) == [49, 94, 98]


def test_every_message_is_counted(shown: Shown) -> None:
    for topic in shown.flown.results.topics:
        seen = shown.collector.topics.get(topic.msg_id)
        assert (0 if seen is None else sum(seen.sent.counts)) == topic.sent, topic.name
        assert (0 if seen is None else seen.latency.count) == topic.delivered, topic.name


def test_latency_is_the_waiting_time_of_a_message(shown: Shown) -> None:
    """The receiver sleeps 120 ms after each tenth message, while one comes every 50 ms."""
    (chat,) = [topic.msg_id for topic in shown.flown.results.topics if topic.name == "/chat"]
    latency = shown.collector.topics[chat].latency
    assert 60_000_000 < latency.most_ns < 130_000_000
    median, highest = latency.percentiles([0.5, 0.95])
    assert median < 1_000_000 < highest


def test_drops_are_counted_by_message_and_pipe(shown: Shown) -> None:
    (dropped,) = [topic for topic in shown.flown.results.topics if topic.dropped]
    assert {(drop.msg_id, drop.pipe): count for drop, count in shown.collector.drops.items()} == {
        (dropped.msg_id, "SLOW_PIPE"): dropped.dropped
    }


def test_processor_time_equals_the_time_of_the_report(shown: Shown) -> None:
    end_ns = shown.flown.mission.kernel.now
    for app in shown.flown.results.apps:
        busy_ns = sum(shown.collector.apps[app.name].busy.counts)
        assert busy_ns == pytest.approx(app.cpu_share * end_ns, abs=20_000), app.name


def test_all_events_and_console_lines_are_collected(shown: Shown) -> None:
    collector, results = shown.collector, shown.flown.results
    assert collector.event_count >= sum(results.events.values())
    assert [line.text for line in collector.lines] == shown.flown.mission.console.lines
    assert all(line.at_ns <= shown.flown.mission.kernel.now for line in collector.lines)


def test_overruns_are_marks(shown: Shown) -> None:
    missed = [mark for mark in shown.collector.marks if mark.kind == "deadline"]
    assert len(missed) == sum(each.overruns for each in shown.flown.results.deadlines)


def test_many_marks_of_one_kind_leave_room_for_others(tmp_path: Path) -> None:
    """Thousands of overruns, and then a reset."""
    app = """\
    def WORKER_AppMain(cfe):
        cfe.es.wait_for_startup_sync(1000)
        for _ in range(MOST):
            cfe.os.task_delay(1)
        if cfe.es.get_reset_type()[0] == 2:
            cfe.es.reset_cfe(1)
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
    """.replace("MOST", str(2 * MOST_OF_A_KIND))
    yaml = "deadlines: {apps: {WORKER: {period: 1 s, jitter: 1 ms}}}\n"
    startup = "CFE_APP, /cf/worker.so, WORKER_AppMain, WORKER, 50, 8192, 0x0, 0;\n"
    collector = Collector()
    looked_at.fly(write_mission(tmp_path, startup, worker=app, mission_yaml=yaml), collector)
    assert collector.mark_counts["deadline"] > 2 * MOST_OF_A_KIND
    kinds = Counter(mark.kind for mark in collector.marks)
    assert kinds == {"deadline": MOST_OF_A_KIND, "reset": 1}


@pytest.mark.parametrize(
    ("line", "mark"),
    [
        ("DEADLINE 1.500000 ARM response 2 ms: 3 ms", ("deadline", "ARM response 2 ms: 3 ms")),
        ("cfepy fault lost: drops /odom", ("fault", "lost: drops /odom")),
        ("invariant 'arm' (mission.yaml:3) at 1.0 s: no", ("invariant", "'arm' (mission.yaml:3) at 1.0 s: no")),
        ("[node] DEADLINE 1.5 nobody", None),
    ],
)
def test_special_console_lines_become_marks(line: str, mark: tuple[str, str] | None) -> None:
    assert mark_of(line) == mark
