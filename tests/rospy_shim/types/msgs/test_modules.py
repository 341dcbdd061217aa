"""The names in std_msgs.msg, std_srvs.srv and genpy for a node that imports them."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from cfepy.nodes import Universe
from cfepy.rtos import Kernel
from cfepy.status import UsageError
from cfepy.trace import Trace
from rospy_shim.types import genpy
from rospy_shim.types.msgs import load_package, make_module, message_class, service_class


def _module(name: str) -> Any:
    module = make_module(name)
    assert isinstance(module, ModuleType)
    assert module.__name__ == name
    return module


def test_message_module() -> None:
    msg = _module("std_msgs.msg")
    assert msg.String is message_class("std_msgs/String")
    assert msg.String.__module__ == "std_msgs.msg._String"
    assert "Float64MultiArray" in dir(msg)
    assert "UInt32" in msg.__all__
    with pytest.raises(AttributeError, match=r"'std_msgs\.msg' has no attribute 'Nope'"):
        _ = msg.Nope


def test_classes_are_created_on_first_use() -> None:
    msg = _module("geometry_msgs.msg")
    assert "Pose" not in vars(msg)
    assert msg.Pose().orientation.w == 0.0
    assert "Pose" in vars(msg)


def test_star_import_has_all_messages() -> None:
    msg = _module("rosgraph_msgs.msg")
    assert msg.__all__ == ["Clock", "Log", "TopicStatistics"]
    assert msg.Log.ERROR == 8


def test_private_modules_and_packages() -> None:
    assert _module("geometry_msgs").__path__ == []
    assert _module("geometry_msgs.msg._Pose").Pose is message_class("geometry_msgs/Pose")
    srv = _module("std_srvs.srv")
    assert srv.SetBool is service_class("std_srvs/SetBool")
    assert srv.SetBoolResponse is service_class("std_srvs/SetBool")._response_class
    assert srv.SetBoolRequest(data=True).__unpack__(b"\0").data is False
    assert _module("std_srvs.srv._Trigger").TriggerResponse.__module__ == "std_srvs.srv._Trigger"


@pytest.mark.parametrize(
    "name", ["numpy", "nope.msg", "std_msgs.srv", "std_msgs.msg._Nope", "std_msgs.x", "genpy.nope", "roslib"]
)
def test_other_names_are_not_provided(name: str) -> None:
    assert make_module(name) is None


def test_genpy() -> None:
    module = _module("genpy")
    assert module.Time is genpy.Time
    assert module.message.SerializationError is genpy.SerializationError
    assert module.rostime.Duration is genpy.Duration
    assert _module("genpy.message").strify_message(message_class("std_msgs/Bool")()) == "data: False"


def test_classes_by_name() -> None:
    message = _module("genpy.message")
    assert message.get_message_class("std_msgs/String") is message_class("std_msgs/String")
    assert message.get_message_class("Header") is message_class("std_msgs/Header")
    assert message.get_message_class("nope/X") is None
    assert message.get_service_class("std_srvs/Empty") is service_class("std_srvs/Empty")
    with pytest.raises(ValueError, match="missing package name"):
        message.get_message_class("String")


def test_fill_message_args() -> None:
    module = _module("genpy.message")
    polygon, twist = message_class("geometry_msgs/Polygon")(), message_class("geometry_msgs/Twist")()
    module.fill_message_args(polygon, [{"points": [{"x": 1}, [2, 3, 4]]}])
    assert [(point.x, point.z) for point in polygon.points] == [(1, 0.0), (2, 4)]
    module.fill_message_args(twist, [[1, 2, 3], {"z": 9}])
    assert (twist.linear.y, twist.angular.z) == (2, 9)
    header = message_class("std_msgs/Header")()
    module.fill_message_args(header, [{"stamp": "now"}], keys={"now": genpy.Time(7)})
    assert header.stamp == genpy.Time(7)
    with pytest.raises(genpy.MessageException, match=r"No field name \[linear\.q\]"):
        module.fill_message_args(twist, [{"linear": {"q": 1}}])
    with pytest.raises(genpy.MessageException, match="Not enough arguments"):
        module.fill_message_args(twist, [[1, 2], []])
    with pytest.raises(genpy.MessageException, match="incorrect number of elements: 1 != 36"):
        module.fill_message_args(message_class("geometry_msgs/PoseWithCovariance")(), [{"covariance": [1]}])
    assert module.get_printable_message_args(header) == "seq stamp frame_id"


def test_generate_dynamic() -> None:
    text = message_class("geometry_msgs/PoseStamped")._full_text
    made = _module("genpy.classes").classes_of_text("geometry_msgs/PoseStamped", text)
    assert made["geometry_msgs/PoseStamped"]._md5sum == message_class("geometry_msgs/PoseStamped")._md5sum
    assert made["geometry_msgs/PoseStamped"]._full_text == text


def test_modules_of_the_host_are_not_changed() -> None:
    _module("std_msgs.msg")
    assert not {"std_msgs", "std_msgs.msg", "genpy", "genpy.message"} & set(sys.modules)


def test_modules_of_the_codec_are_shared() -> None:
    assert make_module("rospy_shim.types.msgs.library") is sys.modules["rospy_shim.types.msgs.library"]
    assert make_module("rospy_shim.types.genpy") is genpy
    assert make_module("rospy_shim") is None


def test_inside_a_node(tmp_path: Path) -> None:
    script = tmp_path / "node.py"
    script.write_text(NODE, encoding="utf-8")
    with Kernel(context="thread", trace=Trace()) as kernel:
        universe = Universe(kernel, name="node", script=script, find_module=_factory)
        universe.spawn()
        kernel.run()
    assert universe.output == ['[node] data: "hi"', "[node] True", "[node] True", "[node] 1000000002"]


NODE = """
import copy, pickle
import genpy, std_msgs.msg
from sensor_msgs.msg import *
from std_msgs.msg import String
print(String("hi"))
message = JointState(name=["a"], position=[1.0])
print(copy.deepcopy(message) == message and std_msgs.msg.String is String)
print(pickle.loads(pickle.dumps(message)) == message)
print(pickle.loads(pickle.dumps(genpy.Time(1, 2))))
"""


def _factory(name: str) -> Callable[[Universe], ModuleType] | None:
    if name == "rospy_shim":
        shim = ModuleType(name)
        shim.__path__ = []
        return lambda universe: shim
    module = make_module(name)
    return None if module is None else lambda universe: module


def test_load_package() -> None:
    assert load_package("sensor_msgs").JointState is message_class("sensor_msgs/JointState")
    with pytest.raises(ModuleNotFoundError, match="nope"):
        load_package("nope")
    with pytest.raises(UsageError, match="unknown message type 'std_msgs/Nope'"):
        message_class("std_msgs/Nope")
