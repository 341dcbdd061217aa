"""A node that shuts down while its callbacks begin: no schedule shows a failure that is cfepy's own."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.exploration.trial import Trial
from cfepy.pilot.plan import RunPlan
from cfepy.rtos import Schedule
from tests.exploration import missions

COMMANDER = """
    import rospy
    from std_msgs.msg import Float32

    rospy.init_node("commander")
    goal = rospy.Publisher("goal", Float32, queue_size=1, latch=True)
    goal.publish(4.2)
    rospy.spin()
"""
PLANNER = """
    import threading
    import rospy
    from std_msgs.msg import Float32

    rospy.init_node("planner")
    arrived = threading.Event()
    rospy.Subscriber("goal", Float32, lambda message: arrived.set())
    arrived.wait(0.2)
"""


@pytest.mark.slow
def test_a_subscription_that_is_served_while_it_is_closed(tmp_path: Path) -> None:
    """Its task must not give the pipe back before the other one is done with it."""
    folder = missions.write(tmp_path, {"PLANNER": PLANNER, "COMMANDER": COMMANDER})
    trial = Trial(RunPlan((str(folder),), seconds=1.0, tasks="greenlet"))
    verdicts = (trial.run(Schedule.parse(f"pct:{seed}:3:41:from=600ms")) for seed in range(300))
    assert [verdict.failures for verdict in verdicts if verdict.failures] == []
