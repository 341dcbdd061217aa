"""Speed of encoding and decoding, in microseconds and relative to a plain loop with one struct call per value."""

from __future__ import annotations

import struct
import timeit
from collections.abc import Callable
from functools import partial
from typing import Any

from rospy_shim.types import genpy
from rospy_shim.types.msgs import message_class, shipped
from rospy_shim.types.msgs.reference import encode
from rospy_shim.types.msgs.spec import PRIMITIVES

_ROUNDS = 40
_ROUND_S = 0.003


def codec() -> dict[str, float]:
    """Return figures by name.

    Returns:
        for each message `<name>.pack_us` and `<name>.unpack_us`, and `<name>.ratio`: how many times faster than the
        plain loop a pack and an unpack are together.
    """
    figures: dict[str, float] = {}
    for name, message in _messages().items():
        cls = type(message)
        encoded = message.__pack__()
        pack, unpack = _microseconds(partial(cls.__pack__, message)), _microseconds(partial(cls.__unpack__, encoded))
        library = shipped()
        plain = _microseconds(partial(encode, library.spec(cls._type), library.spec, message))
        plain += _microseconds(partial(_decode, cls._type, encoded, 0))
        figures |= {f"{name}.pack_us": pack, f"{name}.unpack_us": unpack, f"{name}.ratio": plain / (pack + unpack)}
    return figures


def _messages() -> dict[str, Any]:
    seven = [0.1 * index for index in range(7)]
    header = message_class("std_msgs/Header")(1, genpy.Time(5, 6), "base_link")
    joints = [f"joint_{index}" for index in range(7)]
    return {
        "UInt32": message_class("std_msgs/UInt32")(7),
        "String": message_class("std_msgs/String")("sixteen letters."),
        "Float64MultiArray7": message_class("std_msgs/Float64MultiArray")(data=seven),
        "Twist": message_class("geometry_msgs/Twist")(),
        "PoseStamped": message_class("geometry_msgs/PoseStamped")(header=header),
        "JointState7": message_class("sensor_msgs/JointState")(header, joints, seven, seven, seven),
        "Odometry": message_class("nav_msgs/Odometry")(header=header, child_frame_id="base_link"),
        "LaserScan360": message_class("sensor_msgs/LaserScan")(header=header, ranges=[1.5] * 360),
        "Path100": message_class("nav_msgs/Path")(
            header, [message_class("geometry_msgs/PoseStamped")(header=header)] * 100
        ),
        "GoalStatusArray100": _statuses(header, 100),
        "Image64KiB": message_class("sensor_msgs/Image")(header=header, encoding="mono8", data=bytes(65536)),
    }


def _statuses(header: Any, count: int) -> Any:
    """Return an action server's status message for `count` goals."""
    goal, status = message_class("actionlib_msgs/GoalID"), message_class("actionlib_msgs/GoalStatus")
    goals = [goal(genpy.Time(5, number), f"/client-{number}-5.{number:09d}") for number in range(count)]
    statuses = [status(each, 2, "It was cancelled.") for each in goals]
    return message_class("actionlib_msgs/GoalStatusArray")(header, statuses)


def _microseconds(call: Callable[[], object]) -> float:
    """Return the best mean of many short rounds, without garbage collection, which missions run rarely."""
    calls = max(1, int(_ROUND_S * 3 / timeit.timeit(call, number=3)))
    return min(timeit.repeat(call, number=calls, repeat=_ROUNDS)) / calls * 1e6


def _decode(base: str, data: bytes, at: int) -> tuple[Any, int]:
    """Return the plain decoder, the mirror of `reference.encode`."""
    if base in PRIMITIVES:
        code = "<" + PRIMITIVES[base]
        return struct.unpack_from(code, data, at)[0], at + struct.calcsize(code)
    if base == "string":
        (size,) = struct.unpack_from("<I", data, at)
        return data[at + 4 : at + 4 + size].decode(), at + 4 + size
    if base in ("time", "duration"):
        kind = genpy.Time if base == "time" else genpy.Duration
        return kind(*struct.unpack_from("<II" if base == "time" else "<ii", data, at)), at + 8
    message = message_class(base)()
    for field in shipped().spec(base).fields:
        value, at = _decode_field(field, data, at)
        setattr(message, field.attribute, value)
    return message, at


def _decode_field(field: Any, data: bytes, at: int) -> tuple[Any, int]:
    if not field.is_array:
        return _decode(field.base, data, at)
    count = field.length
    if count is None:
        (count,), at = struct.unpack_from("<I", data, at), at + 4
    if field.base in ("uint8", "char"):
        return data[at : at + count], at + count
    values = []
    for _ in range(count):
        value, at = _decode(field.base, data, at)
        values.append(value)
    return values, at


if __name__ == "__main__":
    for figure, measured in codec().items():
        print(f"{figure:32} {measured:10.2f}")
