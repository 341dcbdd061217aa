"""Nodes that do nothing, as a run reports them."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.pilot import pilot
from cfepy.pilot.plan import RunPlan
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, first.py, __main__, FIRST, 100, 16384, 0x0, 0;
    CFE_APP, second.py, __main__, SECOND, 110, 16384, 0x0, 0;
    !
"""
NODE = """
    import rospy_shim as rospy

    rospy.init_node("{}")
    rospy.spin()
"""


def loose_ends(folder: Path, first: str, second: str) -> list[str]:
    mission = write_mission(folder, STARTUP, first=NODE.format(first), second=NODE.format(second))
    return pilot.fly(RunPlan((mission,), seconds=2.0)).results.loose_ends


def test_node_whose_name_another_takes_has_a_line(tmp_path: Path) -> None:
    assert loose_ends(tmp_path, "arm", "arm") == [
        "/arm: the node of FIRST was shut down when the node of SECOND took its name; give one of them another name"
    ]


def test_nodes_with_names_of_their_own_have_none(tmp_path: Path) -> None:
    assert loose_ends(tmp_path, "arm", "leg") == []


SOURCES = """
    import rospy_shim as rospy
    from geometry_msgs.msg import PointStamped
    from std_msgs.msg import String

    rospy.init_node("sources")
    left = rospy.Publisher("/left", PointStamped, queue_size=10)
    right = rospy.Publisher("/right", PointStamped, queue_size=10)
    plain = rospy.Publisher("/plain", String, queue_size=10)
    rate = rospy.Rate(10)
    sent = []
    while not rospy.is_shutdown():
        message = PointStamped()
        message.header.stamp = rospy.Time.now()
        left.publish(message)
        sent.append(message.header.stamp)
        message.header.stamp += rospy.Duration.from_sec({later})
        if len(sent) > {behind}:
            message.header.stamp = sent[-1 - {behind}] + rospy.Duration.from_sec({later})
            right.publish(message)
        plain.publish("no stamp")
        rate.sleep()
"""
FUSION = """
    import rospy_shim as rospy
    from geometry_msgs.msg import PointStamped
    from message_filters import ApproximateTimeSynchronizer, Subscriber, TimeSynchronizer
    from std_msgs.msg import String

    rospy.init_node("fusion")
    left, right = Subscriber("/left", PointStamped), Subscriber("/right", PointStamped)
    absent, plain = Subscriber("/absent", PointStamped), Subscriber("/plain", String)
    both = {}
    both.registerCallback(lambda *messages: None)
    rospy.spin()
"""


@pytest.mark.parametrize(
    ("later", "behind", "synchronizer", "why"),
    [
        (0, 0, "TimeSynchronizer([left, right], 10)", None),
        (
            0.03,
            0,
            "TimeSynchronizer([left, right], 10)",
            "the TimeSynchronizer of /left and /right never called back: the stamps differ by 30 ms or more, "
            "but must be equal; copy the stamp, or use an ApproximateTimeSynchronizer",
        ),
        (0.03, 0, "ApproximateTimeSynchronizer([left, right], 10, 0.05)", None),
        (
            0.03,
            0,
            "ApproximateTimeSynchronizer([left, right], 10, 0.02)",
            "the ApproximateTimeSynchronizer of /left and /right never called back: the stamps differ by 30 ms or "
            "more, but must differ by less than slop=0.02 s; raise slop",
        ),
        (
            0,
            0,
            "ApproximateTimeSynchronizer([left, right], 10, 0)",
            "the ApproximateTimeSynchronizer of /left and /right never called back: the stamps differ by 0 ms or "
            "more, but must differ by less than slop=0 s; raise slop",
        ),
        (
            0,
            5,
            "TimeSynchronizer([left, right], 3)",
            "the TimeSynchronizer of /left and /right never called back: queue_size=3 is too small, so a message is "
            "dropped before its match comes; raise queue_size",
        ),
        (0, 5, "TimeSynchronizer([left, right], 10)", None),
        (
            0,
            0,
            "TimeSynchronizer([left, absent], 10)",
            "the TimeSynchronizer of /left and /absent never called back: no message came on /absent",
        ),
        (
            0,
            0,
            "ApproximateTimeSynchronizer([left, plain], 10, 0.1)",
            "the ApproximateTimeSynchronizer of /left and /plain never called back: messages of /plain have no "
            "header; set allow_headerless=True",
        ),
        (0, 0, "ApproximateTimeSynchronizer([left, plain], 10, 0.1, allow_headerless=True)", None),
    ],
)
def test_synchronizer_that_never_calls_back_has_a_line(
    tmp_path: Path, later: float, behind: int, synchronizer: str, why: str | None
) -> None:
    sources = SOURCES.format(later=later, behind=behind)
    mission = write_mission(tmp_path, STARTUP, first=sources, second=FUSION.format(synchronizer))
    found = pilot.fly(RunPlan((mission,), seconds=2.0)).results.loose_ends
    assert [line for line in found if line.startswith("/fusion")] == ([f"/fusion: {why}"] if why else [])


def test_synchronizer_without_callback_has_a_line(tmp_path: Path) -> None:
    fusion = FUSION.format("TimeSynchronizer([left, right], 10)").replace("both.registerCallback", "print")
    mission = write_mission(tmp_path, STARTUP, first=SOURCES.format(later=0, behind=0), second=fusion)
    assert pilot.fly(RunPlan((mission,), seconds=2.0)).results.loose_ends[-1] == (
        "/fusion: the TimeSynchronizer of /left and /right never called back: it has no callback; call registerCallback"
    )
