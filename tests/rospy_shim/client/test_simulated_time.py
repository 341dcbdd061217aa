"""Simulated time: /use_sim_time and /clock, sleeping on it, and its reset to an earlier time."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes

HEAD = """
import threading, time
import rospy
from rosgraph_msgs.msg import Clock

rospy.set_param("/use_sim_time", True)
rospy.init_node("probe", disable_signals=True)
clock = rospy.Publisher("/clock", Clock, queue_size=10)
time.sleep(0.2)

def at(seconds):
    clock.publish(Clock(rospy.Time(0, round(seconds * 1000) * 1_000_000)))
    time.sleep(0.01)

def start(function):
    found = []
    def body():
        try:
            found.append(function())
        except rospy.ROSException as error:
            found.append(type(error).__name__)
    threading.Thread(target=body, daemon=True).start()
    time.sleep(0.01)
    return found
"""


def run(tmp_path: Path, body: str) -> list[str]:
    result = run_nodes(tmp_path, {"PROBE": HEAD + body})
    return result.printed.get("probe", result.lines)


def test_time_follows_clock(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
print(rospy.Time.now().to_nsec(), rospy.rostime.is_wallclock())
at(12.5)
print(rospy.get_time(), rospy.get_rostime(), time.time() > 1e6)
rospy.rostime.switch_to_wallclock()
print(abs(rospy.get_time() - time.time()) < 1, rospy.rostime.is_wallclock())
rospy.rostime._set_rostime(rospy.Time(3))
print(rospy.Time.now().to_sec())
""",
    )
    assert lines == ["0 False", "12.5 12500000000 True", "True True", "3.0"]


def test_sleep_begins_with_the_first_clock_and_notices_jumps(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
slept = start(lambda: (rospy.sleep(1.0), rospy.get_time())[1])
for seconds in (10.0, 10.5, 11.0):
    print(slept)
    at(seconds)
print(slept)
back = start(lambda: rospy.sleep(5.0))
at(3.0)
over = start(lambda: rospy.sleep(5.0))
rospy.signal_shutdown("enough")
time.sleep(0.1)
print(back, over)
""",
    )
    assert lines == ["[]", "[]", "[]", "[11.0]", "['ROSTimeMovedBackwardsException'] ['ROSInterruptException']"]


def test_rate_and_timer(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
at(5.0)
plain, kept = start(rospy.Rate(10).sleep), start(rospy.Rate(10, reset=True).sleep)
at(2.0)
print(plain, kept)
events = []
ends = rospy.Timer(rospy.Duration(0.1), lambda event: events.append(event.current_real.to_sec()))
stays = rospy.Timer(rospy.Duration(0.1), lambda event: None, reset=True)
threading.excepthook = lambda arguments: print(arguments.exc_type.__name__)
time.sleep(0.01)
for step in range(1, 7):
    at(2.0 + step * 0.05)
print(events)
at(1.0)
print(ends.is_alive(), stays.is_alive())
""",
    )
    assert lines == [
        "['ROSTimeMovedBackwardsException'] [None]",
        "[2.1, 2.2, 2.3]",
        "ROSTimeMovedBackwardsException",
        "False True",
    ]


def test_condition_and_log_format(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
def wait():
    with rospy.rostime.get_rostime_cond():
        return rospy.rostime.get_rostime_cond().wait(5.0)
told = start(wait)
at(7.25)
print(told)
rospy.loginfo("now")
began = time.time()
try:
    rospy.wait_for_message("/nothing", Clock, timeout=0.5)
except rospy.ROSException:
    print(round(time.time() - began, 2))
""",
    )
    assert lines[0] == "[True]"
    assert lines[1].endswith(", 7.250000]: now")
    assert lines[2] == "0.5"
