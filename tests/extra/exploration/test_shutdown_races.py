"""A node that shuts down while its callbacks begin: no schedule shows a failure of cfepy itself."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.attachment import Attachment
from cfepy.extra.exploration.trial import Trial
from cfepy.mission import Mission
from cfepy.pilot.plan import RunPlan
from cfepy.schedules import Schedule
from tests.extra.exploration import missions

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
def test_subscription_served_while_it_is_closed_does_not_fail(tmp_path: Path) -> None:
    """Its task must not give the pipe back before the other one is done with it."""
    folder = missions.write(tmp_path, {"PLANNER": PLANNER, "COMMANDER": COMMANDER})
    trial = Trial(RunPlan((str(folder),), seconds=1.0, tasks="greenlet"))
    verdicts = (trial.run(Schedule.parse(f"pct:{seed}:3:41:from=600ms")) for seed in range(300))
    assert [verdict.failures for verdict in verdicts if verdict.failures] == []


UNREGISTERED = """
    import rospy
    from std_msgs.msg import Int32

    rospy.init_node("probe")
    numbers = rospy.Publisher("numbers", Int32, queue_size=5)
    subscriber = rospy.Subscriber("numbers", Int32, lambda message: rospy.get_time())
    rospy.sleep(0.1)
    numbers.publish(1)
    subscriber.unregister()
    rospy.sleep(0.2)
    rospy.spin()
"""


class Tasks(Attachment):
    """Which tasks there are at the end."""

    def begin(self, mission: Mission) -> None:
        self._mission = mission

    def conclude(self) -> None:
        self.names = [task.name for task in self._mission.kernel.tasks]


@pytest.mark.slow
def test_subscription_that_ends_while_its_task_is_busy_leaves_no_task(tmp_path: Path) -> None:
    """The request to end comes after the task has checked for it, and before the task waits for a message."""
    trial = Trial(RunPlan((str(missions.write(tmp_path, {"PROBE": UNREGISTERED})),), seconds=1.0, tasks="greenlet"))
    for seed in range(200):
        tasks = Tasks()
        assert trial.run(Schedule.parse(f"random:{seed}:from=600ms"), [tasks]).failures == ()
        assert [name for name in tasks.names if name.startswith("PROBE.numbers")] == [], seed
