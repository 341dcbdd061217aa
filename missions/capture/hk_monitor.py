#!/usr/bin/env python3
"""Housekeeping monitor: a ROS node that reads a cFE housekeeping packet.

The combined packet that the HK application puts together arrives here byte for byte: a 16-byte telemetry header
(CCSDS primary header and cFE time stamp, big-endian), then the fields that HK's copy table has collected from core
services and from the arm's ROS topics (little-endian). README.md has the table that belongs to `FIELDS`.

Subscribes: `/cfe/hk/combined_pkt1` (std_msgs/UInt8MultiArray, the bytes of one combined packet)
Parameters: ~log_period 5 s
"""

from __future__ import annotations

import struct
from typing import NamedTuple

import rospy
from std_msgs.msg import UInt8MultiArray


class Field(NamedTuple):
    """One value in the packet: its name, byte offset from the start of the packet and `struct` code."""

    name: str
    offset: int
    code: str


FIELDS = (
    Field("ES commands", 16, "B"),
    Field("ES errors", 17, "B"),
    Field("EVS commands", 18, "B"),
    Field("EVS errors", 19, "B"),
    Field("SB commands", 20, "B"),
    Field("SB errors", 21, "B"),
    Field("SB without subscriber", 22, "B"),
    Field("SB send errors", 23, "B"),
    Field("events sent", 24, "H"),
    Field("SB pipe overflows", 26, "H"),
    Field("SB limit errors", 28, "H"),
    Field("TIME commands", 30, "B"),
    Field("TIME errors", 31, "B"),
    Field("arm samples", 32, "I"),
    Field("arm peak current [A]", 36, "f"),
    Field("arm peak speed [rad/s]", 40, "f"),
    Field("arm hottest motor [C]", 44, "f"),
)
PACKET_SIZE = 48  # bytes
_HEADER = struct.Struct(">HHHIH")  # stream id, sequence, length - 7, seconds, upper half of the subseconds
_PAYLOADS = tuple((field, struct.Struct("<" + field.code)) for field in FIELDS)


class HkMonitor:
    """Keeps the latest packet, and counts received packets and gaps in their sequence."""

    def __init__(self) -> None:
        self.packet = b""
        self.received = 0
        self.missing = 0
        self.malformed = 0
        self._next_count: int | None = None

    def on_packet(self, message: UInt8MultiArray) -> None:
        packet = bytes(message.data)
        if len(packet) != PACKET_SIZE:
            self.malformed += 1
            rospy.logerr_throttle(10.0, f"combined packet has {len(packet)} bytes instead of {PACKET_SIZE}")
            return
        _, sequence, _, _, _ = _HEADER.unpack_from(packet)
        count = sequence & 0x3FFF  # the upper two bits are segmentation flags
        if self._next_count is not None:
            self.missing += (count - self._next_count) & 0x3FFF
        self._next_count = (count + 1) & 0x3FFF
        self.received += 1
        self.packet = packet

    def report(self, _event: object = None) -> None:
        """Log the latest values that are not zero."""
        if not self.packet:
            rospy.loginfo("housekeeping: no packet yet")
            return
        stream, _, _, seconds, fraction = _HEADER.unpack_from(self.packet)
        values = ((field.name, code.unpack_from(self.packet, field.offset)[0]) for field, code in _PAYLOADS)
        rospy.loginfo(
            "housekeeping 0x%04X at %.3f s, %d received, %d missing, %d malformed: %s",
            stream,
            seconds + fraction / 65536,
            self.received,
            self.missing,
            self.malformed,
            ", ".join(f"{name} {value:g}" for name, value in values if value),
        )


def main() -> None:
    rospy.init_node("hk_monitor")
    monitor = HkMonitor()
    rospy.Subscriber("/cfe/hk/combined_pkt1", UInt8MultiArray, monitor.on_packet, queue_size=10)
    rospy.Timer(rospy.Duration(float(rospy.get_param("~log_period", 5.0))), monitor.report)
    rospy.on_shutdown(monitor.report)
    rospy.spin()


if __name__ == "__main__":
    main()
