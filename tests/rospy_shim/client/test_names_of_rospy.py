"""Modules and names of rospy that programs use beside its functions."""

from __future__ import annotations

import textwrap
from pathlib import Path

from tests.rospy_shim.missions import run_nodes


def test_modules_that_import_rospy_shows(tmp_path: Path) -> None:
    source = """
    import rospy, types
    print(*(name for name in dir(rospy) if isinstance(getattr(rospy, name), types.ModuleType)))
    print(rospy.timer.TimerEvent.__name__, rospy.core.logerror == rospy.logerr, rospy.client.TIMEOUT_READY)
    import rospy.numpy_msg
    print(callable(rospy.numpy_msg.numpy_msg))
    """
    assert run_nodes(tmp_path, {"NODE": textwrap.dedent(source)}).printed["NODE"] == [
        "client core exceptions impl msg msproxy names rostime service timer topics",
        "TimerEvent True 15.0",
        "True",
    ]


def test_slips_of_an_error_branch_raise_as_on_ros(tmp_path: Path) -> None:
    source = """
    import genpy, rosbag, rospy, tf2_ros
    for place, name in (
        (rospy, "logerror"), (rospy, "logwarning"), (rospy, "wait_for_param"), (rosbag.bag, "Any"), (rosbag, "play"),
        (rospy.Publisher, "shutdown"), (rospy.Time, "from_nanoseconds"), (tf2_ros, "Pose"), (genpy, "annotations"),
    ):
        try:
            getattr(place, name)
        except AttributeError as error:
            print(error)
    try:
        import rosbag.play
    except ModuleNotFoundError as error:
        print(error)
    import rospy.topics, rosbag.bag
    print(rospy.topics.loginfo == rospy.loginfo, rosbag.bag.struct.calcsize("<I"), rosbag.bag.Bag.__module__)
    """
    module = "module {!r} has no attribute {!r}"
    assert run_nodes(tmp_path, {"NODE": textwrap.dedent(source)}).printed["NODE"] == [
        module.format("rospy", "logerror"),
        module.format("rospy", "logwarning"),
        module.format("rospy", "wait_for_param"),
        module.format("rosbag.bag", "Any"),
        module.format("rosbag", "play"),
        "type object 'Publisher' has no attribute 'shutdown'",
        "type object 'Time' has no attribute 'from_nanoseconds'",
        module.format("tf2_ros", "Pose"),
        module.format("genpy", "annotations"),
        "No module named 'rosbag.play'",
        "True 4 rosbag.bag",
    ]


def test_import_of_rospy_imports_its_message_packages(tmp_path: Path) -> None:
    source = """
    import rospy, std_msgs, roscpp, rosgraph_msgs
    print(std_msgs.msg.Bool().data, roscpp.srv.Empty()._type, rosgraph_msgs.msg.Log.ERROR)
    """
    result = run_nodes(tmp_path, {"NODE": textwrap.dedent(source)})
    assert result.printed["NODE"] == ["False roscpp/Empty 8"]


def test_key_error_has_the_requested_parameter_name(tmp_path: Path) -> None:
    source = """
    import rospy
    rospy.init_node("node")
    for function in (rospy.get_param, rospy.get_param_cached, rospy.delete_param):
        for name in ("~own", "near/by", "/far"):
            try:
                function(name)
            except KeyError as error:
                print(*error.args)
    """
    result = run_nodes(tmp_path, {"NODE": textwrap.dedent(source)})
    assert result.printed["node"] == ["~own", "near/by", "/far"] * 3


def test_import_rospy_shows_the_modules_of_rospy_impl(tmp_path: Path) -> None:
    source = """
    import rospy
    print(rospy.impl.rosout.RosOutHandler.__module__, rospy.impl.registration.Registration.PUB)
    print([name for name in dir(rospy.impl) if not name.startswith("_")])
    """
    result = run_nodes(tmp_path, {"NODE": textwrap.dedent(source)})
    modules = "init masterslave paramserver registration rosout simtime statistics tcpros tcpros_base tcpros_pubsub"
    assert result.printed["NODE"] == [
        "rospy.impl.rosout pub",
        str([*modules.split(), "tcpros_service", "transport", "validators"]),
    ]


def test_sentinel_for_no_default_can_be_passed_on(tmp_path: Path) -> None:
    asks = """
        import rospy
        rospy.init_node("asks")

        def value_of(name, default=rospy.client._unspecified):
            return rospy.get_param(name, default)

        print(value_of("absent", 3), hasattr(rospy, "_unspecified"))
        print(isinstance(rospy.get_param("absent", rospy.client._Unspecified()), rospy.client._Unspecified))
        try:
            value_of("absent")
        except KeyError as error:
            print(error)
    """
    assert run_nodes(tmp_path, {"ASKS": asks}).printed["asks"] == ["3 False", "True", "'absent'"]
