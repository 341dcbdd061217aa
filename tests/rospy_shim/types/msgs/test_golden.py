"""Shipped types against the results of real genpy 0.6.16: md5sum, definition, bytes and text."""

from __future__ import annotations

import io
from typing import Any

import numpy
import pytest

from rospy_shim.types.msgs import message_class, service_class, shipped
from rospy_shim.types.msgs.reference import encode
from tests.rospy_shim.golden_msgs import build, md5sums, recorded

MESSAGES = [pytest.param(each, id=each["type"]) for each in recorded()["messages"]]
SERVICES = [pytest.param(each, id=each["type"]) for each in recorded()["services"]]
STANDARD = [
    "Bool",
    "Byte",
    "Char",
    "ColorRGBA",
    "Duration",
    "Empty",
    "Float32",
    "Float64",
    "Int16",
    "Int32",
    "Int64",
    "Int8",
    "String",
    "Time",
    "UInt16",
    "UInt32",
    "UInt64",
    "UInt8",
]


def _squeezed(text: str) -> list[str]:
    """Return lines without white space, which differs between ROS's files and ours and enters no md5sum."""
    return [line for line in ("".join(line.split()) for line in text.split("\n")) if line]


@pytest.mark.parametrize("message", MESSAGES)
def test_identity(message: dict[str, Any]) -> None:
    cls = message_class(message["type"])
    assert cls._md5sum == message["md5sum"]
    assert cls._type == message["type"]
    assert cls.__slots__ == message["slots"]
    assert cls._slot_types == message["slot_types"]
    assert cls._has_header == message["has_header"]
    assert _squeezed(cls._full_text) == _squeezed(message["full_text"])


def test_text_of_a_type_without_comments_ends_like_its_file() -> None:
    """As in Debian's packages std_msgs 0.5.13 and tf2_msgs 0.7.6."""
    without = ("Bool", "Char", "Empty", "Float32", "Float64", "Int32", "Int64", "UInt32", "UInt64")
    assert [name for name in STANDARD if not message_class(f"std_msgs/{name}")._full_text.endswith("\n")] == [*without]
    assert message_class("std_msgs/Int32")._full_text == "int32 data"
    assert message_class("std_msgs/Empty")._full_text == ""
    assert message_class("std_msgs/ColorRGBA")._full_text == "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"
    assert message_class("tf2_msgs/TF2Error")._full_text.startswith("uint8 NO_ERROR = 0\nuint8 LOOKUP_ERROR = 1\n")


@pytest.mark.parametrize("message", MESSAGES)
def test_bytes_and_text(message: dict[str, Any]) -> None:
    library = shipped()
    cls = message_class(message["type"])
    spec = library.spec(message["type"])
    for case in message["cases"]:
        ours = build(library, message["type"], case["value"])
        golden = bytes.fromhex(case["hex"])
        assert ours.__pack__() == golden
        assert encode(spec, library.spec, ours) == golden
        assert str(ours) == case["str"]
        assert cls.__unpack__(golden).__pack__() == golden
        assert cls.__unpack__(b"prefix" + golden, 6) == cls().deserialize(golden)


@pytest.mark.parametrize("message", MESSAGES)
def test_genpy_interface(message: dict[str, Any]) -> None:
    library = shipped()
    cls = message_class(message["type"])
    for case in message["cases"]:
        golden = bytes.fromhex(case["hex"])
        buff, again, with_numpy = io.BytesIO(), cls(), cls()
        build(library, message["type"], case["value"]).serialize(buff)
        assert buff.getvalue() == golden
        assert again.deserialize(golden) is again
        assert again.__pack__() == golden
        with_numpy.deserialize_numpy(golden, numpy)
        if any(kind.startswith("bool[") for kind in cls._slot_types):
            continue  # genpy reads a list there, and cannot write one
        buff = io.BytesIO()
        with_numpy.serialize_numpy(buff, numpy)
        assert buff.getvalue() == golden


@pytest.mark.parametrize("service", SERVICES)
def test_services(service: dict[str, Any]) -> None:
    cls = service_class(service["type"])
    assert cls._md5sum == service["md5sum"]
    assert cls._request_class is message_class(service["request"]["type"])
    assert cls._response_class is message_class(service["response"]["type"])


def test_md5sums_of_all_messages() -> None:
    library, golden = shipped(), md5sums("msg")
    assert {name: library.md5sum(name) for name in golden} == golden


def test_md5sums_of_all_services() -> None:
    golden = md5sums("srv")
    assert {name: service_class(name)._md5sum for name in golden} == golden


@pytest.mark.slow
def test_every_shipped_type_has_a_class() -> None:
    library = shipped()
    for package in library.packages():
        for name in library.names(package) or ():
            cls = library.message_class(f"{package}/{name}")
            assert cls.__unpack__(cls().__pack__()).__pack__() == cls().__pack__()
