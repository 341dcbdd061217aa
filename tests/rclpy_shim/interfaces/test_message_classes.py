"""ROS 2 message classes: fields, defaults, checks, conversions, and the bytes that they share with ROS 1."""

from __future__ import annotations

import copy
from array import array
from typing import Any

import numpy
import pytest

from cfepy.status import UsageError
from rclpy_shim.interfaces import Interfaces
from rospy_shim.types.msgs import message_class, shipped
from rospy_shim.types.msgs.definition_sources import Definition, Texts

OTHERS = {
    "sensor_msgs/CameraInfo",
    "sensor_msgs/Range",
    "shape_msgs/SolidPrimitive",
    "stereo_msgs/DisparityImage",
    "visualization_msgs/Marker",
}
"""Types whose fields are not ROS 1's."""


@pytest.fixture(scope="module")
def interfaces() -> Interfaces:
    return Interfaces()


def own(text: str, **environ: str) -> Any:
    return Interfaces([Texts({"demo_msgs/Demo": Definition(text, "Demo.msg")})], environ).message_class(
        "demo_msgs/Demo"
    )


def test_fields_are_given_by_name(interfaces: Interfaces) -> None:
    message = interfaces.message_class("geometry_msgs/Point")(x=1.0, z=3.0)
    assert (message.x, message.y, message.z) == (1.0, 0.0, 3.0)


def test_positional_arguments_are_refused(interfaces: Interfaces) -> None:
    with pytest.raises(TypeError):
        interfaces.message_class("std_msgs/String")("hello")


def test_repr_is_as_in_rosidl(interfaces: Interfaces) -> None:
    message = interfaces.message_class("std_msgs/Header")(frame_id="map")
    assert repr(message) == ("std_msgs.msg.Header(stamp=builtin_interfaces.msg.Time(sec=0, nanosec=0), frame_id='map')")


def test_types_and_slots_are_as_in_rosidl(interfaces: Interfaces) -> None:
    cls = interfaces.message_class("sensor_msgs/PointField")
    assert cls.get_fields_and_field_types() == {
        "name": "string",
        "offset": "uint32",
        "datatype": "uint8",
        "count": "uint32",
    }
    assert cls.__slots__ == ["_name", "_offset", "_datatype", "_count", "_check_fields"]
    assert cls.FLOAT64 == 8
    assert (cls.__module__, cls.__name__) == ("sensor_msgs.msg._point_field", "PointField")


def test_defaults_of_the_definition_are_used(interfaces: Interfaces) -> None:
    assert interfaces.message_class("geometry_msgs/Quaternion")().w == 1.0
    message = own("string<=5 s 'abc'\nint32[] n [1, 2]\nfloat32[2] f [0.5, 1.5]\nbyte b 3")()
    assert (message.s, message.n, message.f.tolist(), message.b) == ("abc", array("i", [1, 2]), [0.5, 1.5], b"\3")
    assert own("string<=5 s 'abc'").S__DEFAULT == "abc"


def test_sequences_are_arrays_and_fixed_arrays_are_of_numpy(interfaces: Interfaces) -> None:
    joints = interfaces.message_class("sensor_msgs/JointState")(position=[1, 2])
    assert joints.position == array("d", [1.0, 2.0])
    covariance = interfaces.message_class("geometry_msgs/PoseWithCovariance")().covariance
    assert covariance.dtype == numpy.float64
    assert covariance.shape == (36,)


def test_value_of_a_wrong_type_is_refused_by_a_sequence(interfaces: Interfaces) -> None:
    with pytest.raises(TypeError):
        interfaces.message_class("sensor_msgs/JointState")(position=["a"])


@pytest.mark.parametrize(
    ("text", "value", "error"),
    [
        ("string x", 3, "The 'x' field must be of type 'str'"),
        ("string<=2 x", "abc", "The 'x' field must be string value not longer than 2"),
        ("bool x", 1, "The 'x' field must be of type 'bool'"),
        ("int8 x", 1.0, "The 'x' field must be of type 'int'"),
        ("int8 x", 128, r"The 'x' field must be an integer in \[-128, 127\]"),
        ("uint8 x", -1, r"The 'x' field must be an unsigned integer in \[0, 255\]"),
        ("float64 x", 1, "The 'x' field must be of type 'float'"),
        ("float32 x", 1e39, "The 'x' field must be a float in"),
        ("byte x", 1, "The 'x' field must be of type 'bytes' or 'ByteString' with length 1"),
        ("int32[<=2] x", [1, 2, 3], "The 'x' field must be a set or sequence with length <= 2"),
        ("int32[2] x", [1], "The 'x' field must be a set or sequence with length 2"),
        ("string[] x", "abc", "The 'x' field must be a set or sequence"),
        ("string[] x", [1], "The 'x' field must be a set or sequence and each value of type 'str'"),
        ("geometry_msgs/Point x", 1, "The 'x' field must be a sub message of type 'Point'"),
    ],
)
def test_checked_field_refuses_a_wrong_value(text: str, value: object, error: str) -> None:
    with pytest.raises(AssertionError, match=error):
        own(text)(check_fields=True, x=value)


def test_fields_are_checked_if_the_environment_asks_for_it() -> None:
    assert own("int8 x")(x=1000).x == 1000
    with pytest.raises(AssertionError):
        own("int8 x", ROS_PYTHON_CHECK_FIELDS="1")(x=1000)


def test_checked_message_refuses_unknown_names() -> None:
    with pytest.raises(AssertionError, match="Invalid arguments passed to constructor: y"):
        own("int8 x")(check_fields=True, y=1)


def test_message_that_cannot_be_packed_names_the_field() -> None:
    with pytest.raises(AssertionError, match="The 'x' field must be an integer"):
        own("int8 x")(x=1000).__pack__()


@pytest.mark.parametrize("cut", [1, 5, 11])
def test_bytes_that_end_early_are_an_error(cut: int) -> None:
    cls = own("int32[] a\nuint8[] b\nbyte[] c\nfloat64[1] d")
    octets = cls(a=[1], b=[2], c=[b"\3"]).__pack__()
    with pytest.raises(ValueError, match=f"{len(octets) - cut} bytes are not a message of type demo_msgs/Demo"):
        cls.__unpack__(octets[:-cut])


def test_message_survives_its_bytes_copy_and_comparison() -> None:
    cls = own("bool[] a\nbyte[2] b\nwstring c\nuint8[3] d\nint16[] e\nstring[] f\ngeometry_msgs/Point[] g\nstring type")
    message = cls(a=[True], b=[b"a", b"b"], c="ü", d=[1, 2, 3], e=[-1], f=["x", "y"], type="t")
    assert cls.__unpack__(message.__pack__()) == message
    assert copy.deepcopy(message) == message
    assert message != cls()


def test_types_with_the_fields_of_ros_1_have_its_md5sum(interfaces: Interfaces) -> None:
    for name in ("std_msgs/Header", "geometry_msgs/PoseStamped", "sensor_msgs/Image", "nav_msgs/Odometry"):
        assert interfaces.message_class(name)._md5sum == shipped().md5sum(name)
    assert interfaces.service_class("std_srvs/SetBool")._md5sum == shipped().service_class("std_srvs/SetBool")._md5sum


@pytest.mark.parametrize("name", sorted(OTHERS))
def test_types_with_other_fields_have_another_md5sum(interfaces: Interfaces, name: str) -> None:
    assert interfaces.message_class(name)._md5sum != shipped().md5sum(name)


def test_bytes_are_as_in_ros_1(interfaces: Interfaces) -> None:
    pose = interfaces.message_class("geometry_msgs/PoseStamped")()
    pose.header.stamp.sec, pose.header.stamp.nanosec, pose.header.frame_id = 5, 7, "map"
    pose.pose.position.x = 1.5
    old = message_class("geometry_msgs/PoseStamped").__unpack__(pose.__pack__())
    assert (old.header.stamp.to_nsec(), old.header.frame_id, old.pose.position.x) == (5_000_000_007, "map", 1.5)


def test_service_has_its_parts(interfaces: Interfaces) -> None:
    service = interfaces.service_class("std_srvs/SetBool")
    assert repr(service.Request(data=True)) == "std_srvs.srv.SetBool_Request(data=True)"
    with pytest.raises(NotImplementedError, match="Service classes can not be instantiated"):
        service()


def test_module_offers_classes_by_name(interfaces: Interfaces) -> None:
    module: Any = interfaces.module("std_srvs.srv")
    assert module.SetBool_Request is module.SetBool.Request
    inner: Any = interfaces.module("std_msgs.msg._string")
    assert inner.String is interfaces.message_class("std_msgs/String")
    with pytest.raises(AttributeError, match=r"module 'std_srvs\.srv' has no attribute 'Nothing'"):
        _ = module.Nothing
    assert interfaces.module("nothing_msgs.msg") is None
    assert interfaces.module("std_msgs.srv") is None


def test_type_that_contains_itself_is_an_error() -> None:
    with pytest.raises(UsageError, match="contains itself"):
        own("Demo inner")


def test_unknown_type_is_an_error(interfaces: Interfaces) -> None:
    with pytest.raises(UsageError, match="unknown message type 'std_msgs/Nothing' of ROS 2"):
        interfaces.message_class("std_msgs/Nothing")


@pytest.mark.slow
def test_all_included_types_survive_their_bytes(interfaces: Interfaces) -> None:
    for package in interfaces.packages():
        for name in interfaces.names(package, "msg"):
            message = interfaces.message_class(f"{package}/{name}")()
            assert type(message).__unpack__(message.__pack__()) == message
        for name in interfaces.names(package, "srv"):
            request = interfaces.service_class(f"{package}/{name}").Request()
            assert type(request).__unpack__(request.__pack__()) == request
