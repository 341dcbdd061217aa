"""Faults on ROS topics: whole messages, segments of long ones, fields; nodes that come back after a crash."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cfepy.faults import FaultInjector, FaultPlan
from cfepy.mission import Mission
from cfepy.mission.launch import read_launch
from cfepy.writing.console import Console
from tests.faults.worlds import fly, row

STARTUP = """
    CFE_APP, talker.py,   __main__, TALKER,   100, 8192, 0x0, 0;
    CFE_APP, listener.py, __main__, LISTENER, 90,  8192, 0x0, 0;
    !
"""
TALKER = """
    import rospy
    from std_msgs.msg import UInt8MultiArray, UInt32
    rospy.init_node("talker")
    numbers = rospy.Publisher("/numbers", UInt32, queue_size=10)
    images = rospy.Publisher("/images", UInt8MultiArray, queue_size=10)
    rospy.sleep(1)
    rate = rospy.Rate(10)
    for number in range(15):
        numbers.publish(number)
        images.publish(UInt8MultiArray(data=bytes([number]) * 100_000))
        rate.sleep()
"""
LISTENER = """
    import rospy
    from std_msgs.msg import UInt8MultiArray, UInt32
    rospy.init_node("listener")
    rospy.Subscriber("/numbers", UInt32, lambda message: print("number", message.data))
    rospy.Subscriber("/images", UInt8MultiArray, lambda message: print("image", sorted(set(message.data))))
    rospy.spin()
"""


def ros(folder: Path, *faults: dict[str, Any], tasks: str = "thread") -> Mission:
    return fly(folder, *faults, seconds=5, startup=STARTUP, talker=TALKER, listener=LISTENER, tasks=tasks)


def numbers(mission: Mission) -> list[int]:
    return [int(line.split()[-1]) for line in mission.console.lines if "] number " in line]


def images(mission: Mission) -> list[str]:
    return [line.split("image ")[1] for line in mission.console.lines if "] image " in line]


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_topics_are_struck_by_name_and_pattern(tmp_path: Path, tasks: str) -> None:
    mission = ros(tmp_path, {"drop": "/numbers", "number": 3}, {"duplicate": "/num*", "number": 5}, tasks=tasks)
    assert numbers(mission)[:6] == [0, 1, 3, 4, 4, 5]
    assert row(mission, "drop-1")["details"] == ["drops /numbers #3 sent by TALKER"]


def test_drop_for_one_node_loses_one_message(tmp_path: Path) -> None:
    mission = ros(tmp_path, {"drop": "/numbers", "number": 3, "from": "TALKER", "to": "LISTENER"})
    assert numbers(mission)[:3] == [0, 1, 3]


def test_node_is_selected_by_its_ros_name(tmp_path: Path) -> None:
    yaml = "nodes: {TALKER: {name: talker}, LISTENER: {name: ear, namespace: /left}}"
    drop = {"drop": "/numbers", "number": 1, "from": "/talker", "to": "/left/ear"}
    crash = {"crash": "/left/ear", "at": 2.5}
    mission = fly(
        tmp_path, drop, crash, seconds=4, startup=STARTUP, talker=TALKER, listener=LISTENER, mission_yaml=yaml
    )
    assert row(mission, "drop-1")["times"] == 1
    assert mission.ros.ended["LISTENER"].status == 139


def test_a_field_of_a_ros_message(tmp_path: Path) -> None:
    mission = ros(
        tmp_path,
        {"corrupt": "/numbers", "number": 2, "fields": {"data": 77}},
        {"corrupt": "/numbers", "number": 3, "fields": {"date": 77}},
        {"corrupt": "/numbers", "number": 4, "fields": {"data": "x"}},
    )
    assert numbers(mission)[:4] == [0, 77, 2, 3]
    nevers = [each["never"] for each in mission.record.rows("faults")]
    assert nevers[0] is None
    assert "cannot set date" in nevers[1]
    assert "/numbers: " in nevers[2]


def test_parts_of_fields(tmp_path: Path) -> None:
    talker = """
        import rospy
        from geometry_msgs.msg import PoseStamped
        from sensor_msgs.msg import JointState
        rospy.init_node("talker")
        joints = rospy.Publisher("/joints", JointState, queue_size=1)
        poses = rospy.Publisher("/pose", PoseStamped, queue_size=1)
        rospy.sleep(1)
        joints.publish(JointState(name=["a", "b"], position=[1.0, 2.0]))
        poses.publish(PoseStamped())
    """
    listener = """
        import rospy
        from geometry_msgs.msg import PoseStamped
        from sensor_msgs.msg import JointState
        rospy.init_node("listener")
        rospy.Subscriber("/joints", JointState, lambda m: print("joints", m.name, m.position))
        rospy.Subscriber("/pose", PoseStamped, lambda m: print("pose", m.header.frame_id, m.pose.position.x))
        rospy.spin()
    """
    joints = {"corrupt": "/joints", "fields": {"position[1]": 7.5, "name[0]": "long name"}}
    pose = {"corrupt": "/pose", "fields": {"pose.position.x": -1.0, "header.frame_id": "nowhere"}}
    mission = fly(tmp_path, joints, pose, startup=STARTUP, talker=talker, listener=listener)
    said = [line for line in mission.console.lines if line.startswith("[listener]")]
    assert said == ["[listener] joints ['long name', 'b'] (1.0, 7.5)", "[listener] pose nowhere -1.0"]


def test_long_message_is_dropped_as_a_whole(tmp_path: Path) -> None:
    mission = ros(tmp_path, {"drop": "/images", "number": 2})
    assert images(mission)[:3] == ["[0]", "[2]", "[3]"]
    assert row(mission, "drop-1")["times"] == 1
    assert sum(topic.lost for topic in mission.ros.graph.topics.values()) == 0


def test_segment_of_a_long_message_is_dropped(tmp_path: Path) -> None:
    mission = ros(tmp_path, {"drop": "/images", "number": 6, "unit": "segment"})
    assert images(mission)[:3] == ["[0]", "[2]", "[3]"]
    assert mission.ros.graph.topics["/images"].lost == 1


@pytest.mark.parametrize(
    ("fault", "seen"),
    [
        ({"duplicate": "/images"}, ["[0]", "[1]", "[1]", "[2]"]),
        ({"delay": "/images", "by": 0.15}, ["[0]", "[2]", "[1]", "[3]"]),
        ({"reorder": "/images"}, ["[0]", "[2]", "[1]", "[3]"]),
        ({"reorder": "/images", "to": "LISTENER"}, ["[0]", "[2]", "[1]", "[3]"]),
        ({"duplicate": "/images", "to": "LISTENER"}, ["[0]", "[1]", "[1]", "[2]"]),
        ({"corrupt": "/images", "bytes": {"2000": 200}}, ["[0]", "[1, 200]", "[2]", "[3]"]),
    ],
)
def test_long_message_is_duplicated_delayed_and_reordered(
    tmp_path: Path, fault: dict[str, Any], seen: list[str]
) -> None:
    assert images(ros(tmp_path, fault | {"number": 2}))[:4] == seen


def test_field_of_a_segment_cannot_be_set(tmp_path: Path) -> None:
    mission = ros(tmp_path, {"corrupt": "/images", "fields": {"data": []}, "number": 2})
    assert "is sent in segments" in row(mission, "corrupt-1")["never"]
    assert images(mission)[:3] == ["[0]", "[1]", "[2]"]


def test_crashed_node_of_a_launch_file_is_restarted(tmp_path: Path) -> None:
    (tmp_path / "beat.py").write_text(
        "#!/usr/bin/env python3\nimport rospy\nrospy.init_node('beat')\nprint('begins')\nrospy.spin()\n",
        encoding="utf-8",
    )
    (tmp_path / "beat.py").chmod(0o755)
    launch = tmp_path / "beat.launch"
    (tmp_path / "package.xml").write_text("<package><name>beats</name></package>", encoding="utf-8")
    launch.write_text(
        '<launch><node pkg="beats" type="beat.py" name="beat" respawn="true" output="screen"/></launch>',
        encoding="utf-8",
    )
    injector = FaultInjector(FaultPlan.from_dict({"faults": [{"crash": "BEAT", "at": 2}]}))
    with Mission(read_launch(launch, {}), console=Console(quiet=True), attachments=[injector]) as mission:
        mission.run_for(4)
        lines = mission.console.lines
        assert sum("begins" in line for line in lines) == 2
        assert any("exit status 139 and is restarted" in line for line in lines)
