"""rospy's clock, Rate, sleep and Timer on virtual time."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes


def run(tmp_path: Path, body: str, **options: object) -> list[str]:
    """Run one node. Returns its output."""
    result = run_nodes(tmp_path, {"PROBE": "import rospy\n" + body}, **options)  # type: ignore[arg-type]
    return [line for lines in result.printed.values() for line in lines] or result.lines


def test_time_is_not_available_before_init_node(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
for function in (rospy.get_rostime, rospy.Time.now, rospy.get_time, lambda: rospy.Rate(10),
                 lambda: rospy.loginfo_throttle(1, "x"), rospy.spin):
    try:
        function()
    except rospy.ROSInitException as error:
        print(error)
rospy.sleep(0.01)
print(rospy.is_shutdown())
""",
    )
    assert lines == [
        *["time is not initialized. Have you called init_node()?"] * 5,
        "client code must call rospy.init_node() first",
        "False",
    ]


def test_rate_keeps_its_grid_catches_up_and_restarts(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
rospy.init_node("probe")
rate = rospy.Rate(50)
start = rospy.Time.now()
ticks = []
for busy in (0, 0.015, 0.03, 0, 0, 0.1, 0, 0):
    rospy.sleep(busy)
    rate.sleep()
    ticks.append(round((rospy.Time.now() - start).to_sec() / 0.01))
print(ticks)
print(rate.sleep_dur, rate.remaining().to_sec() > 0, type(rate.remaining()).__name__, rospy.Rate(-1).sleep_dur)
""",
    )
    assert lines == ["[2, 4, 7, 8, 10, 20, 22, 24]", "20000000 True Duration -1000000000"]


def test_all_clock_functions_show_one_time(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
import time, datetime
rospy.init_node("probe")
before = rospy.get_time()
rospy.sleep(rospy.Duration(0.5))
time.sleep(0.25)
print(round(rospy.get_time() - before, 3), abs(time.time() - rospy.get_time()) < 1e-3)
print(rospy.rostime.is_wallclock(), rospy.Time.from_sec(1.5), rospy.Time.from_seconds(2.5))
rospy.sleep(-1)
try:
    rospy.sleep("a")
except TypeError as error:
    print(error)
""",
    )
    assert lines == [
        "0.75 True",
        "True 1500000000 2500000000",
        "'<' not supported between instances of 'str' and 'int'",
    ]


def test_timer_is_a_thread_and_dies_of_an_exception(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
import threading
rospy.init_node("probe")
timer = rospy.Timer(rospy.Duration(1), print)
print(isinstance(timer, threading.Thread), timer.daemon, timer.shutdown())
count = []
def fail(event):
    count.append(event)
    raise ValueError("in a timer")
dying = rospy.Timer(rospy.Duration(0.05), fail)
rospy.sleep(0.5)
print(len(count), dying.is_alive(), count[0].last_real, type(count[0]).__name__)
""",
    )
    assert lines[0] == "True True None"
    assert lines[-1] == "1 False None TimerEvent"
    assert any("in a timer" in line for line in lines[1:-1])


def test_slow_timer_callbacks_do_not_accumulate(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
rospy.init_node("probe")
seen = []
def slow(event):
    seen.append(event)
    if len(seen) == 1:
        rospy.sleep(0.45)
timer = rospy.Timer(rospy.Duration(0.1), slow)
rospy.sleep(0.82)
timer.shutdown()
print(len(seen), round(seen[1].last_duration, 3), (seen[2].current_expected - seen[1].current_expected))
""",
    )
    assert lines == ["4 0.45 100000000"]


def test_timers_and_threads_run_alike_on_threads_and_greenlets(tmp_path: Path) -> None:
    script = """
import rospy
from std_msgs.msg import Float64
rospy.init_node("probe")
publisher = rospy.Publisher("x", Float64, queue_size=3)
rospy.Subscriber("x", Float64, lambda m: rospy.loginfo("x is %.3f", m.data))
rospy.Timer(rospy.Duration(0.07), lambda event: publisher.publish(rospy.get_time() % 100))
rospy.spin()
"""
    digests = set()
    for tasks in ("thread", "greenlet"):
        folder = tmp_path / tasks
        folder.mkdir()
        result = run_nodes(folder, {"PROBE": script}, tasks=tasks)
        assert len(result.printed["probe"]) > 20
        digests.add(result.digest)
    assert len(digests) == 1
