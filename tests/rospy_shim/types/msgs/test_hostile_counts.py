"""Impossible counts: a packet never makes the decoder build more than its bytes pay for.

genpy iterates over an array of messages as often as the packet says. An exception are messages of octets alone: it
takes the available ones, down to none. Here such a packet is refused as genpy refuses one whose bytes end.
"""

from __future__ import annotations

import random
import struct
import tracemalloc
from typing import Any

import numpy
import pytest

from dev.roscfe.random_messages import all_types
from rospy_shim.types import genpy
from rospy_shim.types.msgs import from_full_text, message_class
from rospy_shim.types.msgs.classes import MessageClass
from tests.roscfe.test_fuzz import ANGLED, is_message, packets

LINE = "\n" + "=" * 80 + "\nMSG: pkg/"
PAIR = LINE + "Pair\nuint8[2] a\nchar[1] b\nOctets[2] c\nNothing d\nfloat64[0] e" + LINE + "Octets\nuint8[4] id"
PAIRS = from_full_text("pkg/Pairs", "Pair[] items" + PAIR + LINE + "Nothing\n").message_class("pkg/Pairs")
NOTHINGS = from_full_text(
    "pkg/Nothings", "Rows[] rows" + LINE + "Rows\nNothing[] items\nNothing[7] more" + LINE + "Nothing\n"
).message_class("pkg/Nothings")
MOST = 65_536
BYTES = 2048
"""That decoding may take from the heap for each byte of a packet: a std_msgs/Empty[] of four bytes is a list, a message
that is nothing but such arrays an object of many."""


def count(number: int) -> bytes:
    return struct.pack("<I", number)


def decode(cls: MessageClass, data: Any, way: int) -> Any:
    """Return the result of one of the four ways to decode bytes."""
    if way == 0:
        return cls.__unpack__(b"123" + data, 3)
    if way == 1:
        return cls().deserialize(data)
    return cls().deserialize_numpy(data, numpy) if way == 2 else cls().deserialize(bytearray(data))


@pytest.mark.parametrize("way", range(4))
def test_items_of_octets_are_limited_by_the_remaining_bytes(way: int) -> None:
    whole = count(3) + bytes(range(33))
    assert len(decode(PAIRS, whole, way).items) == 3
    assert decode(PAIRS, whole, way).__pack__() == whole
    for data in (whole[:-1], count(200_000), count(4) + bytes(33)):
        with pytest.raises(genpy.DeserializationError, match=r"^unpack requires a buffer of \d+ bytes$"):
            decode(PAIRS, data, way)


@pytest.mark.parametrize("way", range(4))
def test_items_without_bytes_are_limited_in_a_message(way: int) -> None:
    most = count(2) + count(MOST // 2) * 2
    assert [len(row.items) for row in decode(NOTHINGS, most, way).rows] == [MOST // 2] * 2
    for data in (count(2) + count(MOST) + count(1), count(1) + count(0xFFFFFFFF)):
        with pytest.raises(genpy.DeserializationError, match=r"^more than 65,536 items that take no bytes$"):
            decode(NOTHINGS, data, way)


def test_largest_count_in_a_map_feature_is_refused() -> None:
    """geographic_msgs/MapFeature has an array of octets[16]."""
    feature = message_class("geographic_msgs/MapFeature")
    with pytest.raises(genpy.DeserializationError, match="68719476720 bytes"):
        feature.__unpack__(bytes(16) + count(0xFFFFFFFF) + bytes(40))


def test_truncated_message_is_not_read_from_its_middle() -> None:
    """The rest of this path from its second pose on would be a valid, empty path."""
    path = message_class("nav_msgs/Path")
    pose = message_class("geometry_msgs/PoseStamped")
    whole = path(poses=[pose(), pose()]).__pack__()
    for cut in range(len(whole)):
        with pytest.raises(genpy.DeserializationError):
            path.__unpack__(whole[:cut])


@pytest.mark.slow
def test_damaged_packets_allocate_only_for_their_bytes() -> None:
    chance = random.Random(20261123)
    tracemalloc.start()
    try:
        for name in [*all_types()[::9], *ANGLED]:
            cls = message_class(name)
            for way in (0, 1):
                decode(cls, cls().__pack__(), way)  # objects made once for a type do not count
            for packet in packets(name, 15):
                tracemalloc.reset_peak()
                before = tracemalloc.get_traced_memory()[0]
                try:
                    message = decode(cls, packet, chance.randrange(2))
                except genpy.DeserializationError:
                    message = None
                used = tracemalloc.get_traced_memory()[1] - before
                assert used < 200_000 + BYTES * len(packet), (name, packet, used)
                assert message is not None or not is_message(name, packet), (name, packet)
    finally:
        tracemalloc.stop()
