"""Messages in the arrays of a message cost virtual time, like calls: they are made one by one in a real node, too."""

from __future__ import annotations

from pathlib import Path

import pytest

from rospy_shim.types.msgs import message_class
from tests.rospy_shim.missions import run_nodes

LISTENER = """
    import rospy
    from nav_msgs.msg import Path
    from std_msgs.msg import Float64MultiArray, Int64
    rospy.init_node('listener')
    def heard(message, kind):
        print(kind, (rospy.Time.now() - sent[kind]).to_nsec())
    sent = {}
    def sending(message):
        sent[('path', 'numbers')[message.data]] = rospy.Time.now()
    rospy.Subscriber('/sending', Int64, sending)
    rospy.Subscriber('/path', Path, heard, 'path')
    rospy.Subscriber('/numbers', Float64MultiArray, heard, 'numbers')
    rospy.spin()
"""

TALKER = """
    import rospy
    from geometry_msgs.msg import PoseStamped
    from nav_msgs.msg import Path
    from std_msgs.msg import Float64MultiArray, Int64
    rospy.init_node('talker')
    sending = rospy.Publisher('/sending', Int64, queue_size=10)
    path = rospy.Publisher('/path', Path, queue_size=10)
    numbers = rospy.Publisher('/numbers', Float64MultiArray, queue_size=10)
    rospy.sleep(0.1)
    for kind, publisher, message in (
        (0, path, Path(poses=[PoseStamped() for _ in range({count})])),
        (1, numbers, Float64MultiArray(data=[0.5] * {count})),
    ):
        sending.publish(kind)
        rospy.sleep(0.1)
        before = rospy.Time.now()
        publisher.publish(message)
        print((rospy.Time.now() - before).to_nsec())
        rospy.sleep(0.1)
"""


def _flight(folder: Path, count: int) -> tuple[list[int], list[int]]:
    """Virtual ns that publishing a path and an array of numbers took, and until they were heard."""
    folder.mkdir()
    run = run_nodes(folder, {"LISTENER": LISTENER, "TALKER": TALKER.replace("{count}", str(count))})
    return [int(line) for line in run.printed["talker"]], [int(line.split()[1]) for line in run.printed["listener"]]


def test_message_in_an_array_costs_one_call_to_send_and_two_to_receive(tmp_path: Path) -> None:
    few_sent, few_heard = _flight(tmp_path / "few", 1)
    many_sent, many_heard = _flight(tmp_path / "many", 101)
    assert many_sent[0] - few_sent[0] == 100_000
    assert many_heard[0] - few_heard[0] == 200_000


def test_numbers_cost_nothing(tmp_path: Path) -> None:
    few_sent, few_heard = _flight(tmp_path / "few", 1)
    many_sent, many_heard = _flight(tmp_path / "many", 101)
    assert many_sent[1] == few_sent[1]
    assert many_heard[1] == few_heard[1]


@pytest.mark.parametrize(
    ("name", "items"),
    [
        ("nav_msgs/Path", {"poses": 3}),
        ("visualization_msgs/InteractiveMarkerUpdate", {"markers": 1, "poses": 2}),
    ],
)
def test_items_are_counted_over_all_arrays(name: str, items: dict[str, int]) -> None:
    cls = message_class(name)
    message = cls(**{field: [None] * count for field, count in items.items()})
    assert cls.__count_items__(message) == sum(items.values())


def test_items_of_nested_messages_count() -> None:
    trajectory = message_class("trajectory_msgs/JointTrajectory")()
    trajectory.points = [message_class("trajectory_msgs/JointTrajectoryPoint")()] * 4
    outer = message_class("control_msgs/FollowJointTrajectoryGoal")(trajectory=trajectory)
    assert type(outer).__count_items__(outer) == 4


def test_type_without_message_arrays_has_no_counter() -> None:
    assert message_class("sensor_msgs/JointState").__count_items__ is None
