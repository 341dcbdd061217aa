"""Nodes of ROS 1 and ROS 2 in one mission: topics, services, and the same run on threads and greenlets."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import run_nodes

pytestmark = pytest.mark.slow
TALKER_1 = """
    import rospy
    from geometry_msgs.msg import PoseStamped
    rospy.init_node("talker1")
    pub = rospy.Publisher("/pose", PoseStamped, queue_size=5, latch=True)
    pose = PoseStamped()
    pose.header.frame_id = "map"
    pose.header.stamp = rospy.Time(5, 7)
    pose.pose.position.x = 1.5
    for turn in range(3):
        rospy.sleep(0.2)
        pub.publish(pose)
"""
TALKER_2 = """
    import rclpy
    from geometry_msgs.msg import PoseStamped
    rclpy.init()
    node = rclpy.create_node("talker2")
    pub = node.create_publisher(PoseStamped, "pose", 10)
    pose = PoseStamped()
    pose.header.frame_id = "odom"
    pose.pose.position.y = 2.5
    node.create_timer(0.2, lambda: pub.publish(pose))
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        print("interrupted", rclpy.ok())
    rclpy.shutdown()
"""
LISTENER_1 = """
    import rospy
    from geometry_msgs.msg import PoseStamped
    rospy.init_node("listener1")
    def hear(message):
        position = message.pose.position
        print(message._connection_header["callerid"], message.header.seq, message.header.frame_id, position.y)
    rospy.Subscriber("/pose", PoseStamped, hear)
    rospy.spin()
"""
LISTENER_2 = """
    import rclpy
    from rclpy.node import Node
    from rclpy.executors import ExternalShutdownException
    from geometry_msgs.msg import PoseStamped
    class Listener(Node):
        def __init__(self):
            super().__init__("listener2")
            self.create_subscription(PoseStamped, "pose", self.hear, 10)
        def hear(self, message):
            stamp = message.header.stamp
            print(message.header.frame_id, stamp.sec, stamp.nanosec, message.pose.position.x)
    rclpy.init()
    try:
        rclpy.spin(Listener())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
"""
SERVER_2 = """
    import rclpy
    from std_srvs.srv import SetBool
    rclpy.init()
    node = rclpy.create_node("server2")
    def switch(request, response):
        response.success, response.message = not request.data, "switched"
        return response
    node.create_service(SetBool, "switch", switch)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
"""
CALLER_1 = """
    import rospy
    from std_srvs.srv import SetBool
    rospy.init_node("caller1")
    rospy.wait_for_service("/switch")
    print(rospy.ServiceProxy("/switch", SetBool)(False).success)
"""
SERVER_1 = """
    import rospy
    from std_srvs.srv import SetBool, SetBoolResponse
    rospy.init_node("server1")
    def switch(request):
        if request.data:
            raise ValueError("stuck")
        return SetBoolResponse(True, "done")
    rospy.Service("/switch", SetBool, switch)
    rospy.spin()
"""
CALLER_2 = """
    import rclpy
    from std_srvs.srv import SetBool
    with rclpy.init():
        node = rclpy.create_node("caller2")
        client = node.create_client(SetBool, "switch")
        print(client.service_is_ready(), client.wait_for_service(timeout_sec=1.0))
        for data in (False, True):
            future = client.call_async(SetBool.Request(data=data))
            rclpy.spin_until_future_complete(node, future)
            print(future.result().message if future.exception() is None else future.exception())
"""


def test_message_of_ros_1_reaches_ros_2(tmp_path: Path) -> None:
    run = run_nodes(tmp_path, {"L2": LISTENER_2, "T1": TALKER_1})
    assert run.printed["listener2"] == ["map 5 7 1.5"] * 3
    assert run.finished


def test_message_of_ros_2_reaches_ros_1_with_its_counter(tmp_path: Path) -> None:
    run = run_nodes(tmp_path, {"L1": LISTENER_1, "T2": TALKER_2}, seconds=1.0)
    assert run.printed["listener1"][:2] == ["/talker2 1 odom 2.5", "/talker2 2 odom 2.5"]
    assert run.printed["talker2"] == ["interrupted False"]
    assert run.topics["/pose"].publishers == ("/talker2",)


def test_service_of_ros_2_answers_ros_1(tmp_path: Path) -> None:
    assert run_nodes(tmp_path, {"S2": SERVER_2, "C1": CALLER_1}).printed["caller1"] == ["True"]


def test_service_of_ros_1_answers_ros_2(tmp_path: Path) -> None:
    printed = run_nodes(tmp_path, {"C2": CALLER_2, "S1": SERVER_1}).printed["caller2"]
    assert printed == ["False True", "done", "error processing request: stuck"]


def test_mission_of_two_worlds_is_the_same_on_threads_and_greenlets(tmp_path: Path) -> None:
    nodes = {"L1": LISTENER_1, "L2": LISTENER_2, "T1": TALKER_1, "T2": TALKER_2, "S2": SERVER_2, "C1": CALLER_1}
    digests = set()
    for number, tasks in enumerate(("thread", "greenlet", "greenlet")):
        folder = tmp_path / str(number)
        folder.mkdir()
        digests.add(run_nodes(folder, nodes, tasks=tasks).digest)
    assert len(digests) == 1


def test_types_with_other_fields_do_not_meet(tmp_path: Path) -> None:
    talker = """
        import rospy
        from sensor_msgs.msg import Range
        rospy.init_node("talker1")
        pub = rospy.Publisher("/range", Range, queue_size=5)
        rospy.sleep(0.5)
        pub.publish(Range())
    """
    listener = """
        import rclpy
        from sensor_msgs.msg import Range
        rclpy.init()
        node = rclpy.create_node("listener2")
        node.create_subscription(Range, "range", print, 10)
        rclpy.spin_once(node, timeout_sec=1.0)
        print("nothing")
    """
    run = run_nodes(tmp_path, {"T1": talker, "L2": listener})
    assert run.printed["listener2"][-1] == "nothing"
    assert "has the type sensor_msgs/Range" in run.printed["listener2"][0]
