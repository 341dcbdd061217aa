"""Every shipped message type against what real genpy 0.6.16 made of it: md5sum, definition, bytes and text."""

from __future__ import annotations

import io
from typing import Any

import numpy
import pytest

from rospy_shim.msgs import service_class, shipped
from rospy_shim.msgs.reference import encode
from tests.rospy_shim.golden_msgs import build, library_of, recorded

MESSAGES = [pytest.param(each, id=each["type"]) for each in recorded()]

# Types that no recording has; the values are those that `rosmsg md5` and `rossrv md5` print.
MORE_MD5SUMS = {
    "sensor_msgs/Illuminance": "8cf5febb0952fca9d650c3d11a81a188",
    "sensor_msgs/RelativeHumidity": "8730015b05955b7e992ce29a2678d90f",
    "sensor_msgs/JoyFeedback": "f4dcd73460360d98f36e55ee7f2e46f1",
    "sensor_msgs/JoyFeedbackArray": "cde5730a895b1fc4dee6f91b754b213d",
    "sensor_msgs/LaserEcho": "8bc5ae449b200fba4d552b4225586696",
    "sensor_msgs/MultiEchoLaserScan": "6fefb0c6da89d7c8abe4b339f5c2f8fb",
    "nav_msgs/GetMapAction": "e611ad23fbf237c031b7536416dc7cd7",
    "trajectory_msgs/MultiDOFJointTrajectory": "ef145a45a5f47b77b7f5cdde4b16c942",
    "tf2_msgs/LookupTransformAction": "7ee01ba91a56c2245c610992dbaa3c37",
}
SERVICE_MD5SUMS = {
    "std_srvs/Empty": "d41d8cd98f00b204e9800998ecf8427e",
    "std_srvs/SetBool": "09fb03525b03e7ea1fd3992bafd87e16",
    "std_srvs/Trigger": "937c9679a518e3a18d831e57125ea522",
    "rospy_tutorials/AddTwoInts": "6a2e34150c00229791cc89ff309fff21",
    "roscpp/GetLoggers": "32e97e85527d4678a8f9279894bb64b0",
    "roscpp/SetLoggerLevel": "51da076440d78ca1684d36c868df61ea",
    "nav_msgs/GetMap": "6cdd0a18e0aff5b0a3ca2326a89b54ff",
    "nav_msgs/GetPlan": "421c8ea4d21c6c9db7054b4bbdf1e024",
    "nav_msgs/LoadMap": "22e647fdfbe3b23c8c9f419908afaebd",
    "nav_msgs/SetMap": "c36922319011e63ed7784112ad4fdd32",
    "sensor_msgs/SetCameraInfo": "bef1df590ed75ed1f393692395e15482",
    "tf2_msgs/FrameGraph": "437ea58e9463815a0d511c7326b686b0",
}


def _squeezed(text: str) -> list[str]:
    """Lines without white space, which differs between ROS's files and ours and enters no md5sum."""
    return [line for line in ("".join(line.split()) for line in text.split("\n")) if line]


@pytest.mark.parametrize("message", MESSAGES)
def test_identity(message: dict[str, Any]) -> None:
    cls = library_of(message["type"]).message_class(message["type"])
    assert cls._md5sum == message["md5sum"]
    assert cls._type == message["type"]
    assert cls.__slots__ == message["slots"]
    assert cls._slot_types == message["slot_types"]
    assert cls._has_header == message["has_header"]
    assert _squeezed(cls._full_text) == _squeezed(message["full_text"])


@pytest.mark.parametrize("message", MESSAGES)
def test_bytes_and_text(message: dict[str, Any]) -> None:
    library = library_of(message["type"])
    cls = library.message_class(message["type"])
    spec = library.spec(message["type"])
    for case in message["cases"]:
        ours = build(library, message["type"], case["value"])
        golden = bytes.fromhex(case["hex"])
        assert ours._pack() == golden
        assert encode(spec, library.spec, ours) == golden
        assert str(ours) == case["str"]
        assert cls._unpack(golden)._pack() == golden
        assert cls._unpack(b"prefix" + golden, 6) == cls().deserialize(golden)


@pytest.mark.parametrize("message", MESSAGES)
def test_genpy_interface(message: dict[str, Any]) -> None:
    library = library_of(message["type"])
    cls = library.message_class(message["type"])
    for case in message["cases"]:
        golden = bytes.fromhex(case["hex"])
        buff, again, with_numpy = io.BytesIO(), cls(), cls()
        build(library, message["type"], case["value"]).serialize(buff)
        assert buff.getvalue() == golden
        assert again.deserialize(golden) is again
        assert again._pack() == golden
        with_numpy.deserialize_numpy(golden, numpy)
        buff = io.BytesIO()
        with_numpy.serialize_numpy(buff, numpy)
        assert buff.getvalue() == golden


@pytest.mark.parametrize("full_name", MORE_MD5SUMS)
def test_types_without_recording(full_name: str) -> None:
    assert shipped().md5sum(full_name) == MORE_MD5SUMS[full_name]


@pytest.mark.parametrize("full_name", SERVICE_MD5SUMS)
def test_services(full_name: str) -> None:
    cls = service_class(full_name)
    assert cls._md5sum == SERVICE_MD5SUMS[full_name]
    assert cls._request_class._type == full_name + "Request"
    assert cls._response_class._type == full_name + "Response"


def test_every_shipped_type_makes_a_class() -> None:
    library = shipped()
    for package in library.packages():
        for name in library.names(package) or ():
            cls = library.message_class(f"{package}/{name}")
            assert cls._unpack(cls()._pack())._pack() == cls()._pack()
