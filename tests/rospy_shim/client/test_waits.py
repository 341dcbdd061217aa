"""The durations of rospy's own waits: they poll, and return late.

The times are recorded from rospy 1.15.15 with a master, to a hundredth of a second.
"""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes

TIMED = """
import rospy, time
from std_msgs.msg import String
from roscpp.srv import Empty
def timed(function, *arguments):
    begin = time.time()
    try:
        answer = function(*arguments)
        answer = getattr(answer, "data", answer)
    except Exception as error:
        answer = error
    print(f"{time.time() - begin:.2f} {answer}")
"""


def test_wait_for_service_polls_every_300_ms(tmp_path: Path) -> None:
    waits = """
rospy.init_node("waits")
for limit in (0.1, 0.5, 0.7, 1.0, -1, rospy.Duration(0.5), 0):
    timed(rospy.wait_for_service, "no", limit)
"""
    gone = "timeout exceeded while waiting for service /no"
    times = (0.3, 0.6, 0.9, 1.2, 0.0, 0.6)
    lines = run_nodes(tmp_path, {"WAITS": TIMED + waits}, seconds=6).printed["waits"]
    assert lines == [*(f"{time:.2f} {gone}" for time in times), "0.00 timeout must be non-zero"]


def test_service_offered_between_two_polls_is_found_at_the_next(tmp_path: Path) -> None:
    waits = """
rospy.init_node("waits")
timed(rospy.wait_for_service, "late", 2)
timed(rospy.wait_for_service, "late")
timed(rospy.ServiceProxy("later", Empty).wait_for_service, 0.8)
"""
    offers = """
rospy.init_node("offers")
rospy.sleep(0.35)
rospy.Service("late", Empty, print)
rospy.sleep(1.05)
rospy.Service("later", Empty, print)
rospy.spin()
"""
    lines = run_nodes(tmp_path, {"WAITS": TIMED + waits, "OFFERS": TIMED + offers}, seconds=4).printed["waits"]
    # The last check is 0.6 s after the first; the service starts 0.8 s after it.
    assert lines == ["0.60 None", "0.00 None", "0.90 timeout exceeded while waiting for service /later"]


def test_wait_for_message_polls_every_10_ms(tmp_path: Path) -> None:
    waits = """
rospy.init_node("waits")
timed(rospy.wait_for_message, "no", String, 0)
timed(rospy.wait_for_message, "no", String, 0.015)
timed(rospy.wait_for_message, "no", String, 0.1)
timed(rospy.wait_for_message, "words", String, 2)
"""
    talks = """
rospy.init_node("talks")
publisher = rospy.Publisher("words", String, queue_size=1)
rospy.sleep(0.535)
publisher.publish("a")
rospy.spin()
"""
    lines = run_nodes(tmp_path, {"WAITS": TIMED + waits, "TALKS": TIMED + talks}, seconds=3).printed["waits"]
    gone = "timeout exceeded while waiting for message on topic no"
    assert lines[:3] == [f"0.01 {gone}", f"0.02 {gone}", f"0.10 {gone}"]
    assert lines[3] == "0.41 a"  # 0.535 s less the 0.13 s before, at the next look
