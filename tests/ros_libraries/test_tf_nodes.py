"""Nodes that exchange transforms, on a running mission."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import Run, run_nodes

TELLS = """
    import rospy, tf, tf2_ros
    from geometry_msgs.msg import Quaternion, TransformStamped

    rospy.init_node("tells")
    fixed = TransformStamped(child_frame_id="laser")
    fixed.header.frame_id = "base"
    fixed.transform.translation.z = 0.5
    fixed.transform.rotation = Quaternion(*tf.transformations.quaternion_from_euler(0, 0, 0))
    tf2_ros.StaticTransformBroadcaster().sendTransform(fixed)
    broadcaster = tf.TransformBroadcaster()
    rate = rospy.Rate(10)
    rospy.sleep(0.25)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        broadcaster.sendTransform((1, 2, 0), (0, 0, 0, 1), now, "base", "map")
        rate.sleep()
"""
ASKS = """
    import rospy, tf2_ros, tf2_geometry_msgs
    from geometry_msgs.msg import PointStamped
    from tf2_msgs.srv import FrameGraph

    rospy.init_node("asks")
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)
    try:
        buffer.lookup_transform("map", "laser", rospy.Time(0))
    except tf2_ros.LookupException as error:
        print(error)
    start = rospy.Time.now()
    found = buffer.lookup_transform("map", "laser", rospy.Time(0), rospy.Duration(1.0))
    print("waited", 0.1 < (rospy.Time.now() - start).to_sec() < 0.5, found.transform.translation.y)
    point = PointStamped()
    point.header.frame_id = "laser"
    point.header.stamp = rospy.Time.now()
    print(buffer.transform(point, "map", rospy.Duration(0.5)).point.x)
    frames = rospy.ServiceProxy("~tf2_frames", FrameGraph)().frame_yaml
    print([line.strip() for line in frames.splitlines() if "broadcaster" in line])
    start = rospy.Time.now()
    print(buffer.can_transform("map", "moon", rospy.Time(0), rospy.Duration(0.5), return_debug_tuple=True))
    print("gave up", 0.5 <= (rospy.Time.now() - start).to_sec() < 0.52)
    tf2_ros.Buffer()  # a second one finds the service taken
    print("done")
"""
OLD = """
    import rospy, tf
    rospy.init_node("old")
    listener = tf.TransformListener()
    listener.waitForTransform("/map", "/laser", rospy.Time(0), rospy.Duration(2.0))
    print(listener.lookupTransform("/map", "/laser", rospy.Time(0))[0][:2])
"""

SERVES = """
    import rospy, tf2_ros
    rospy.init_node("serves")
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)
    server = tf2_ros.BufferServer(buffer, "/frames")
    rospy.spin()
"""
ASKS_THE_SERVER = """
    import rospy, tf2_ros
    from actionlib_msgs.msg import GoalStatus
    from tf2_msgs.msg import LookupTransformGoal
    rospy.init_node("asks")
    client = tf2_ros.BufferClient("/frames")
    print(client.wait_for_server(rospy.Duration(2)))
    now = rospy.Time(0)
    print(client.lookup_transform("map", "laser", now, rospy.Duration(1)).transform.translation.y)
    print(client.lookup_transform_full("map", now, "laser", now, "base").transform.translation.z)
    print(client.can_transform("map", "laser", now), client.can_transform_full("map", now, "moon", now, "base"))
    start = rospy.Time.now()
    try:
        client.lookup_transform("map", "moon", now, rospy.Duration(0.5))
    except tf2_ros.LookupException as error:
        print(error, 0.5 <= (rospy.Time.now() - start).to_sec() < 0.6)
    client.client.send_goal(LookupTransformGoal("map", "moon", now, rospy.Duration(60), now, "", False))
    rospy.sleep(0.1)
    client.client.cancel_goal()
    print(client.client.wait_for_result(rospy.Duration(1)), client.client.get_state() == GoalStatus.PREEMPTED)
"""


def fly(folder: Path, tasks: str = "thread") -> Run:
    folder.mkdir(exist_ok=True)
    return run_nodes(folder, {"TELLS": TELLS, "ASKS": ASKS, "OLD": OLD}, seconds=3.0, tasks=tasks)


def test_transforms_are_sent_received_and_waited_for(tmp_path: Path) -> None:
    printed = fly(tmp_path).printed
    assert printed["asks"] == [
        '"map" passed to lookupTransform argument target_frame does not exist. ',
        "waited True 2.0",
        "1.0",
        "[\"broadcaster: '/tells'\", \"broadcaster: '/tells'\"]",
        "(0, 'canTransform: source_frame moon does not exist.')",
        "gave up True",
        "done",
    ]
    assert printed["old"] == ["[1.0, 2.0]"]


def test_run_with_transforms_is_the_same_each_time(tmp_path: Path) -> None:
    assert fly(tmp_path / "a").digest == fly(tmp_path / "b", "greenlet").digest


def test_transforms_are_requested_from_the_buffer_of_another_node(tmp_path: Path) -> None:
    printed = run_nodes(tmp_path, {"TELLS": TELLS, "SERVES": SERVES, "ASKS": ASKS_THE_SERVER}, seconds=5.0).printed
    assert printed["asks"] == [
        "True",
        "2.0",
        "0.5",
        "True False",
        '"moon" passed to lookupTransform argument source_frame does not exist.  True',
        "True True",
    ]


def test_chain_has_the_frames_that_tf2_lists(tmp_path: Path) -> None:
    script = """
        import rospy, tf
        from geometry_msgs.msg import TransformStamped
        rospy.init_node("N")
        transformer, at = tf.Transformer(), rospy.Time(1)
        for parent, child in ("ra", "ab", "ac", "bd", "bg", "de", "xy"):
            made = TransformStamped(child_frame_id=child)
            made.header.frame_id, made.header.stamp, made.transform.rotation.w = parent, at, 1
            transformer.setTransform(made)
        for target, source, fixed in ("ccc", "ecr", "ceb", "cbb", "geg", "yca", "?ca", "c?a", "ca?", "???", "rec"):
            try:
                print("".join(transformer.chain(target, at, source, at, fixed)))
            except tf.ConnectivityException as error:
                print(str(error).partition("because")[0])
        try:
            transformer.chain(None, at, "c", at, "a")
        except TypeError as error:
            print(error)
    """
    lost = "Could not find a connection between '{}' and '{}' "
    assert run_nodes(tmp_path, {"N": script}).printed["N"] == [
        *("", "carabde", "edbarc", "barc", "edbg"),
        *(lost.format(*names) for names in ("ya", ("NO_PARENT", "a"), ("a", "NO_PARENT"), ("NO_PARENT", "a"))),
        *("", "edbacar", "argument 1 must be str, not None"),
    ]
