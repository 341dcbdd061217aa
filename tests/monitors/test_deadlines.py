"""Deadlines in the mission file: read with good errors, measured in virtual time, reported wherever problems are."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import read_mission
from cfepy.monitors.deadlines import AppDeadline, Check, DeadlineResult, TopicDeadline
from cfepy.monitors.durations import LongestWatch, Measure
from cfepy.monitors.record import DeadlineRecord
from cfepy.monitors.run_rules import demands_of
from cfepy.pilot import pilot
from cfepy.pilot.mission_check import check_mission
from cfepy.pilot.pilot import Flown
from cfepy.pilot.plan import RunPlan
from cfepy.status import UsageError
from cfepy.units import time_text
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

WORKER = "CFE_APP, /cf/worker.so, WORKER_AppMain, WORKER, 50, 16384, 0x0, 0;\n"
SENDER = "CFE_APP, /cf/sender.so, SENDER_AppMain, SENDER, 60, 16384, 0x0, 0;\n"

PERIODIC = """\
def WORKER_AppMain(cfe):
    cfe.es.wait_for_startup_sync(1000)
    count = 0
    while cfe.es.run_loop():
        cfe.os.task_delay(100)
        count += 1
        if count == 5:
            cfe.os.task_delay(30)
"""

BURSTS = """\
from cfepy.msg import init

def SENDER_AppMain(cfe):
    cfe.es.wait_for_startup_sync(1000)
    while cfe.es.run_loop():
        cfe.sb.transmit_msg(bytes(init(0x0A00, 20)))
        cfe.os.task_delay(%s)
"""

READER = """\
def WORKER_AppMain(cfe):
    pipe = cfe.sb.create_pipe(10, "WORKER_PIPE")
    cfe.sb.subscribe(0x0A00, pipe)
    cfe.es.wait_for_startup_sync(1000)
    while cfe.es.run_loop():
        if cfe.sb.receive_buffer(pipe, -1) is not None:
            kernel = cfe.es.kernel
            kernel.charge(%d)
            cfe.os.task_delay(%d)
"""


def mission(folder: Path, deadlines: str, startup: str = WORKER, **sources: str) -> str:
    sources.setdefault("worker", PERIODIC)
    return write_mission(folder, startup, mission_yaml=deadlines, **sources)


def fly(folder: Path, deadlines: str, startup: str = WORKER, seconds: float = 3.0, **sources: str) -> Flown:
    return pilot.fly(RunPlan((mission(folder, deadlines, startup, **sources),), seconds=seconds))


def only(flown: Flown) -> DeadlineResult:
    (result,) = flown.results.deadlines
    return result


def worst(result: DeadlineResult) -> float:
    assert result.worst_s is not None
    return result.worst_s


def first(result: DeadlineResult, flown: Flown) -> float:
    """When it was first missed, in s since the mission was OPERATIONAL."""
    assert result.first_at_s is not None
    assert flown.results.booted_s is not None
    return result.first_at_s - flown.results.booted_s


# -- the mission file --------------------------------------------------------------------------------------------------


def test_deadlines_are_read_with_their_units(tmp_path: Path) -> None:
    text = """\
    deadlines:
      apps:
        WORKER: {response: 500 us, period: 20 Hz, jitter: 0 s, task: WORKER}
      topics:
        /odom: {latency: 2.5ms, at_least_every: 1 s, at_most_every: 100 Hz}
        "0x0A00": {latency: 100 ns}
    """
    found = demands_of(read_mission(mission(tmp_path, text))).deadlines
    assert found.apps == (AppDeadline("WORKER", 500_000, 50_000_000, 0, "WORKER"),)
    assert found.topics == (
        TopicDeadline("/odom", 2_500_000, 1_000_000_000, 10_000_000),
        TopicDeadline("0x0A00", 100),
    )


@pytest.mark.parametrize(
    ("entry", "says"),
    [
        ("apps: {WORKER: {response: 2}}", "2: deadlines.apps.WORKER.response: must be a time with a unit"),
        ("apps: {WORKER: {response: 2 parsec}}", "with a unit, such as 500 us"),
        ("apps: {WORKER: {response: 0 ms}}", "must be from 1 ns"),
        ("apps: {WORKER: {period: 0 Hz, jitter: 1 ms}}", "deadlines.apps.WORKER.period: must be from"),
        ("apps: {WORKER: {period: 5 ms}}", "missing jitter of the period"),
        ("apps: {WORKER: {response: 1 ms, jitter: 1 ms}}", "requires a period"),
        ("apps: {WORKER: {}}", "missing response or period"),
        ("apps: {WORKER: {latency: 1 ms}}", "unknown field; expected response, period, jitter or task"),
        ("topics: {/odom: {}}", "requires latency, at_least_every or at_most_every"),
        ("topics: {/odom: {rate: 1 Hz}}", "unknown field"),
        ("topics: {/odom: {at_least_every: 1 ms, at_most_every: 2 ms}}", "must not be shorter than at_most_every"),
        ("topics: {0xZZ: {latency: 1 ms}}", "is not a MsgId"),
        ("nodes: {}", "expected apps or topics"),
        ("apps: 3", "must be a mapping"),
    ],
)
def test_invalid_deadline_is_reported_with_its_line(tmp_path: Path, entry: str, says: str) -> None:
    path = mission(tmp_path, f"deadlines:\n  {entry}\n")
    with pytest.raises(UsageError) as caught:
        demands_of(read_mission(path))
    assert caught.value.line == 2
    assert says in str(caught.value)
    (finding,) = [each for each in check_mission(path) if each.file.name == "mission.yaml"]
    assert finding.line == 2
    assert finding.text in str(caught.value)


def test_check_reports_unknown_applications(tmp_path: Path) -> None:
    text = "deadlines:\n  apps:\n    WORKR: {response: 1 ms}\n    CFE_ES: {response: 1 ms}\n"
    (finding,) = check_mission(mission(tmp_path, text))
    assert finding.line == 3
    assert finding.text == "deadlines.apps.WORKR: unknown application WORKR; did you mean WORKER?"


@pytest.mark.parametrize(
    ("time", "text"), [(0, "0 ns"), (999, "999 ns"), (2_500, "2.5 us"), (10_000_000, "10 ms"), (1_500_000_000, "1.5 s")]
)
def test_times_are_shown_with_a_suitable_unit(time: int, text: str) -> None:
    assert time_text(time) == text


# -- applications ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "kept", "missed"),
    [("latency", 10, 11), ("at_least_every", 10, 11), ("at_most_every", 10, 9), ("period", 12, 13), ("period", 8, 7)],
)
def test_time_equal_to_the_limit_is_not_an_overrun(kind: str, kept: int, missed: int) -> None:
    check = Check("WORKER", kind, 10, 2)
    assert check.measure(kept)
    assert not check.measure(missed)


def test_single_jump_of_a_period_is_one_overrun(tmp_path: Path) -> None:
    flown = fly(tmp_path, "deadlines: {apps: {WORKER: {period: 100 ms, jitter: 5 ms}}}\n")
    result = only(flown)
    assert result.overruns == 1
    assert result.checked > 20
    assert worst(result) == pytest.approx(0.03)
    assert first(result, flown) == pytest.approx(0.53, abs=0.11)


def test_period_within_its_jitter_has_no_overrun(tmp_path: Path) -> None:
    result = only(fly(tmp_path, "deadlines: {apps: {WORKER: {period: 100 ms, jitter: 70 ms}}}\n"))
    assert result.overruns == 0
    assert result.problem is None
    assert result.first_at_s is None


@pytest.mark.parametrize(("limit", "overruns"), [("2 ms", True), ("4 ms", False)])
def test_response_is_the_time_from_one_wait_to_the_next(tmp_path: Path, limit: str, overruns: bool) -> None:
    text = f"deadlines: {{apps: {{WORKER: {{response: {limit}}}}}}}\n"
    result = only(fly(tmp_path, text, WORKER + SENDER, worker=READER % (3_000_000, 1), sender=BURSTS % 100))
    assert result.checked > 40
    assert worst(result) == pytest.approx(0.003, abs=1e-6)
    assert bool(result.overruns) == overruns


def test_response_includes_the_wait_for_the_processor(tmp_path: Path) -> None:
    """The response begins when the message comes, not when the task gets the processor."""
    hog = """\
    def HOG_AppMain(cfe):
        cfe.es.wait_for_startup_sync(1000)
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
            cfe.es.kernel.charge(40_000_000)
    """
    text = "deadlines: {apps: {WORKER: {response: 10 ms}}}\n"
    startup = "CFE_APP, /cf/hog.so, HOG_AppMain, HOG, 10, 16384, 0x0, 0;\n" + WORKER
    result = only(fly(tmp_path, text, startup, hog=hog))
    assert result.overruns > 3
    assert 0.02 < worst(result) <= 0.041


def test_time_before_operational_is_not_measured(tmp_path: Path) -> None:
    slow_start = "def WORKER_AppMain(cfe):\n    cfe.os.task_delay(10)\n    cfe.es.kernel.charge(500_000_000)\n" + (
        "    cfe.os.task_delay(10)\n    cfe.es.wait_for_startup_sync(1000)\n"
        "    while cfe.es.run_loop():\n        cfe.os.task_delay(10)\n"
    )
    result = only(fly(tmp_path, "deadlines: {apps: {WORKER: {response: 1 ms}}}\n", worker=slow_start))
    assert result.checked > 100
    assert result.overruns == 0


def test_response_includes_the_wait_for_a_mutex(tmp_path: Path) -> None:
    worker = """\
    def child(cfe, mutex):
        while True:
            cfe.os.mut_sem_take(mutex)
            cfe.os.task_delay(30)
            cfe.os.mut_sem_give(mutex)
            cfe.os.task_delay(70)

    def WORKER_AppMain(cfe):
        mutex = cfe.os.mut_sem_create("held")
        cfe.es.create_child_task("HOLDER", lambda: child(cfe, mutex), 4096, 60)
        cfe.es.wait_for_startup_sync(1000)
        while cfe.es.run_loop():
            cfe.os.task_delay(20)
            cfe.os.mut_sem_take(mutex)
            cfe.os.mut_sem_give(mutex)
    """
    text = "deadlines: {apps: {WORKER: {response: 15 ms, task: WORKER}}}\n"
    result = only(fly(tmp_path, text, worker=worker))
    assert 0 < result.overruns < result.checked
    assert worst(result) == pytest.approx(0.03, abs=0.011)


ACROSS_OPERATIONAL = """\
    def WORKER_AppMain(cfe):
        cfe.es.run_loop()
        cfe.os.task_delay(10)
        while cfe.es.kernel.now < 700_000_000:
            cfe.psp.compute(10)
        while cfe.es.run_loop():
            cfe.os.task_delay(10)
"""


def test_response_that_began_before_operational_is_not_measured(tmp_path: Path) -> None:
    flown = fly(tmp_path, "deadlines: {apps: {WORKER: {response: 1 ms}}}\n", worker=ACROSS_OPERATIONAL)
    result = only(flown)
    assert flown.results.booted_s is not None
    assert 0.1 < flown.results.booted_s < 0.7, "the long response ends after OPERATIONAL"
    assert result.checked > 100
    assert result.overruns == 0


def test_wait_that_began_before_operational_is_not_measured(tmp_path: Path) -> None:
    waiter = """\
    def WAITER_AppMain(cfe):
        cfe.es.run_loop()
        cfe.os.task_delay(20)
        while cfe.es.run_loop():
            cfe.os.task_delay(10)
    """
    startup = WORKER + "CFE_APP, /cf/waiter.so, WAITER_AppMain, WAITER, 60, 16384, 0x0, 0;\n"
    watch = LongestWatch(Measure.parse("wait:WAITER"))
    folder = mission(tmp_path, "", startup, worker=ACROSS_OPERATIONAL, waiter=waiter)
    pilot.fly(RunPlan((folder,), seconds=2.0), attachments=[watch])
    assert watch.longest is not None
    assert watch.longest.time_ns < 10_000_000


# -- topics ------------------------------------------------------------------------------------------------------------


def test_latency_is_the_time_from_sending_to_receiving(tmp_path: Path) -> None:
    text = 'deadlines: {topics: {"0x0A00": {latency: 60 ms}}}\n'
    flown = fly(tmp_path, text, WORKER + SENDER, worker=READER % (0, 150), sender=BURSTS % 100)
    result = only(flown)
    assert result.overruns > 3
    assert worst(result) > 0.06


def test_latency_of_a_message_from_before_operational_is_not_measured(tmp_path: Path) -> None:
    sender = BURSTS.replace("    cfe.es.wait_for_startup_sync(1000)\n", "    cfe.es.run_loop()\n") % 20
    flown = fly(
        tmp_path,
        'deadlines: {topics: {"0x0A00": {latency: 1 ms}}}\n',
        WORKER + SENDER,
        worker=READER % (0, 0),
        sender=sender,
    )
    result = only(flown)
    sent = next(row.sent for row in flown.results.topics if row.msg_id == 0x0A00)
    assert 100 < result.checked < sent
    assert result.overruns == 0
    assert worst(result) < 0.001


def test_late_message_is_an_overrun_at_its_due_time(tmp_path: Path) -> None:
    text = 'deadlines: {topics: {"0x0A00": {at_least_every: 250 ms}}}\n'
    sender = BURSTS % "100 if cfe.time.get_met()[0] % 2 else 600"
    flown = fly(tmp_path, text, WORKER + SENDER, worker=READER % (0, 1), sender=sender, seconds=5.0)
    result = only(flown)
    assert 1 <= result.overruns <= 8
    assert worst(result) == pytest.approx(0.6)


def test_missing_message_is_one_overrun(tmp_path: Path) -> None:
    flown = fly(tmp_path, "deadlines: {topics: {/nobody: {at_least_every: 1 s}}}\n")
    result = only(flown)
    assert (result.checked, result.overruns) == (1, 1)
    assert 1 <= first(result, flown) <= 1.2


def test_early_message_is_an_overrun(tmp_path: Path) -> None:
    text = 'deadlines: {topics: {"0x0A00": {at_most_every: 5 Hz}}}\n'
    flown = fly(tmp_path, text, WORKER + SENDER, worker=READER % (0, 1), sender=BURSTS % 100)
    result = only(flown)
    assert result.overruns == result.checked > 10
    assert worst(result) == pytest.approx(0.1)


def test_ros_topic_has_deadlines_by_name_until_the_shutdown(tmp_path: Path) -> None:
    talk = """\
    import rospy
    from std_msgs.msg import String
    rospy.init_node("talk")
    rospy.on_shutdown(lambda: rospy.sleep(1.5))
    publisher = rospy.Publisher("/chat", String, queue_size=5)
    rate = rospy.Rate(20)
    while not rospy.is_shutdown():
        publisher.publish(String("hello"))
        rate.sleep()
    """
    hear = """\
    import rospy
    from std_msgs.msg import String
    rospy.init_node("hear")
    rospy.Subscriber("/chat", String, lambda message: None)
    rospy.spin()
    """
    text = "deadlines: {topics: {/chat: {latency: 1 ms, at_least_every: 60 ms, at_most_every: 40 ms}}}\n"
    startup = (
        "CFE_APP, /cf/talk, __main__, TALK, 60, 16384, 0x0, 0;\nCFE_APP, /cf/hear, __main__, HEAR, 61, 16384, 0x0, 0;\n"
    )
    flown = fly(tmp_path, text, startup, talk=talk, hear=hear)
    assert [each.overruns for each in flown.results.deadlines] == [0, 0, 0]
    assert all(each.checked > 40 for each in flown.results.deadlines)
    unheard = fly(tmp_path, text, startup.splitlines()[0] + "\n", talk=talk)
    latency, *others = unheard.results.deadlines
    assert latency.checked == 0
    assert all(each.checked > 40 and each.overruns == 0 for each in others)  # published even if not received


# -- reports -----------------------------------------------------------------------------------------------------------


def test_first_ten_overruns_have_a_line_and_all_have_one_problem(tmp_path: Path) -> None:
    text = 'deadlines: {topics: {"0x0A00": {at_most_every: 1 s}}}\n'
    path = mission(tmp_path, text, WORKER + SENDER, worker=READER % (0, 1), sender=BURSTS % 100)
    lines: list[str] = []
    flown = pilot.fly(RunPlan((path,), seconds=3.0), console=Console(sink=lines.append))
    told = [line for line in lines if line.startswith("DEADLINE ")]
    assert len(told) == 10 < only(flown).overruns
    assert told[0].endswith(" 0x0A00 at_most_every 1 s: 100 ms from one message to the next")
    assert told[-1].endswith("(later ones are in the trace)")
    count = only(flown).overruns
    (problem,) = flown.results.problems
    assert problem.startswith(
        f"0x0A00 missed its deadline at_most_every 1 s {count} times, at worst with 100 ms, first"
    )
    assert flown.results.to_dict()["deadlines"][0]["overruns"] == count
    assert len(flown.mission.record.part(DeadlineRecord).overruns) == count


def test_every_overrun_is_in_the_trace_and_the_run_is_deterministic(tmp_path: Path) -> None:
    text = "deadlines: {apps: {WORKER: {period: 100 ms, jitter: 5 ms}}}\n"
    with_them = [fly(tmp_path, text).trace for _ in range(2)]
    path = mission(tmp_path, text)
    threads = pilot.fly(RunPlan((path,), seconds=3.0, tasks="thread")).trace
    assert with_them[0] == with_them[1] == threads != fly(tmp_path, "name: plain\n").trace


def test_met_deadlines_do_not_change_the_trace(tmp_path: Path) -> None:
    kept = fly(tmp_path, "name: same\ndeadlines: {apps: {WORKER: {period: 100 ms, jitter: 70 ms}}}\n")
    none = fly(tmp_path, "name: same\n")
    assert kept.trace == none.trace
    assert none.results.deadlines == []


def test_deadlines_start_again_after_a_reset(tmp_path: Path) -> None:
    worker = """\
    def WORKER_AppMain(cfe):
        cfe.es.wait_for_startup_sync(1000)
        cfe.os.task_delay(100)
        if cfe.es.get_reset_type()[0] == 2:
            cfe.es.reset_cfe(1)
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
    """
    flown = fly(tmp_path, "deadlines: {apps: {WORKER: {period: 100 ms, jitter: 1 ms}}}\n", worker=worker)
    assert len(flown.results.resets) == 1
    assert only(flown).overruns == 0
    assert only(flown).checked > 10
