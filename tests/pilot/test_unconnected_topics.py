"""Topics that connect to nothing, as a run reports them."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.pilot import pilot
from cfepy.pilot.plan import RunPlan
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, talker.py, __main__, TALKER, 100, 16384, 0x0, 0;
    CFE_APP, hearer.py, __main__, HEARER, 110, 16384, 0x0, 0;
    !
"""
TALKER = """
    import rospy_shim as rospy
    from std_msgs.msg import Float64

    rospy.init_node("talker")
    publisher = rospy.Publisher("/speed", Float64, queue_size=1)
    rate = rospy.Rate(50)
    while not rospy.is_shutdown():
        publisher.publish(1.0)
        rate.sleep()
"""
HEARER = """
    import rospy_shim as rospy
    from std_msgs.msg import Float64, String

    rospy.init_node("hearer")
    {}
    rospy.spin()
"""


def loose_ends(folder: Path, hearer: str) -> list[str]:
    mission = write_mission(folder, STARTUP, talker=TALKER, hearer=HEARER.format(hearer))
    return pilot.fly(RunPlan((mission,), seconds=2.0)).results.loose_ends


@pytest.mark.parametrize(
    ("hearer", "lines"),
    [
        ('rospy.Subscriber("/speed", Float64, lambda message: None)', []),
        ("", ["published without a subscriber: /speed of /talker"]),
        (
            'rospy.Subscriber("/sped", Float64, print)',
            ["/sped: /hearer subscribed, but no node publishes; did you mean /speed?"],
        ),
        (
            'rospy.Subscriber("/robot/left/speed", Float64, print)',
            ["/robot/left/speed: /hearer subscribed, but no node publishes; did you mean /speed?"],
        ),
        (
            'rospy.Subscriber("/sped", String, print)',
            ["published without a subscriber: /speed of /talker"],
        ),
        (
            'rospy.Subscriber("/speed", String, print)',
            [
                "/speed: /hearer has the type std_msgs/String, but the topic has std_msgs/Float64, "
                "so it is not connected"
            ],
        ),
        ('rospy.Subscriber("/move/goal", Float64, print)', ["published without a subscriber: /speed of /talker"]),
    ],
)
def test_topic_that_connects_to_nothing_has_a_line(tmp_path: Path, hearer: str, lines: list[str]) -> None:
    assert loose_ends(tmp_path, hearer) == lines


def test_queue_that_loses_most_messages_has_a_line(tmp_path: Path) -> None:
    hearer = 'rospy.Subscriber("/speed", Float64, lambda message: rospy.sleep(0.5), queue_size=1)'
    (line,) = loose_ends(tmp_path, hearer)
    assert line.startswith("/speed: ")
    assert "subscribers are slower than /talker; publish less often, or raise queue_size" in line


def test_mission_without_nodes_has_none() -> None:
    assert pilot.fly(RunPlan(("lab",), seconds=1.0)).results.loose_ends == []
