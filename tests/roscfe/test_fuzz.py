"""Packets that are not messages: truncated, lengthened, with impossible counts, with changed bytes.

The program has the sanitizers for addresses and for undefined behaviour in it, which end it at the first wrong access.
"""

from __future__ import annotations

import random
import struct
from pathlib import Path

import pytest

from cfepy.extra.convert.message_headers import Profile
from dev.roscfe.building import needs_cpp
from dev.roscfe.random_messages import LIBRARY, all_types
from dev.roscfe.roundtrip import Program, frames_of, hash_of
from rospy_shim.types.msgs.spec import PRIMITIVES

pytestmark = [pytest.mark.slow, needs_cpp]
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize=vptr", "-fno-sanitize-recover=all")
ANGLED = (  # arrays in arrays, texts in them, items of all sizes
    *("diagnostic_msgs/DiagnosticArray", "sensor_msgs/PointCloud2", "visualization_msgs/MarkerArray"),
    *("trajectory_msgs/MultiDOFJointTrajectory", "nav_msgs/OccupancyGrid", "actionlib_msgs/GoalStatusArray"),
)
COUNTS = (0xFFFFFFFF, 0x80000000, 0x7FFFFFFF, 0x10000, 0xFFFF, 256, 25, 7, 3, 1)
SIZES = {kind: struct.calcsize("<" + code) for kind, code in PRIMITIVES.items()} | {"time": 8, "duration": 8}
EMPTY_ITEMS = 65536
TIMES_THE_BYTES = 16
"""Bytes that reading may take from the heap, for each byte of the packet. A text of four bytes is a std::string of 32
on 64 bits, and a vector that is read into again may take twice what it needs."""


def mutated(frame: bytes, draw: random.Random) -> bytes:
    """Return a frame with a fault in it."""
    octets = bytearray(frame)
    fault = draw.randrange(6)
    at = draw.randrange(len(octets) + 1)
    if fault == 0:
        del octets[at:]
    elif fault == 1:
        octets += draw.randbytes(draw.randint(1, 9))
    elif fault == 2 and len(octets) >= 4:
        at = draw.randrange(len(octets) - 3)
        count = draw.choice([*COUNTS, len(octets) - at - 4, len(octets) - at - 3])
        octets[at : at + 4] = struct.pack("<I", count & 0xFFFFFFFF)
    elif fault == 3:
        del octets[at : at + draw.randint(1, 8)]
    elif fault == 4:
        octets[at:at] = draw.randbytes(draw.randint(1, 8))
    else:
        octets = bytearray(draw.randbytes(len(octets)))
    return bytes(octets)


def packets(full_name: str, count: int) -> list[bytes]:
    """Return mutated messages of a type. A few have more than one fault."""
    draw = random.Random(hash_of(full_name))
    found = []
    for frame in frames_of(full_name, count):
        for _ in range(draw.choice((1, 1, 1, 2, 3))):
            frame = mutated(frame, draw)
        found.append(frame)
    return found


class Walker:
    """Walks over the bytes of a message by its definition, making nothing. Raises ValueError if they are not a message.

    genpy cannot be used: it iterates over an array of fixed arrays as often as a packet demands, even without bytes.
    """

    def __init__(self, octets: bytes) -> None:
        self._octets = octets
        self._at = 0

    def whole(self, full_name: str) -> None:
        """Walk over a message that takes all bytes."""
        self._message(full_name)
        if self._at != len(self._octets):
            raise ValueError("bytes are left")

    def _message(self, full_name: str) -> None:
        for each in LIBRARY.spec(full_name).fields:
            count = 1 if not each.is_array else self._count() if each.length is None else each.length
            if each.base in SIZES:
                self._skip(count * SIZES[each.base])
                continue
            for _ in range(min(count, EMPTY_ITEMS + 1)):
                if each.base == "string":
                    self._skip(self._count())
                else:
                    self._message(each.base)
            if count > EMPTY_ITEMS:
                raise ValueError("more items than there can be in a test's packet")

    def _count(self) -> int:
        self._skip(4)
        return int.from_bytes(self._octets[self._at - 4 : self._at], "little")

    def _skip(self, count: int) -> None:
        self._at += count
        if self._at > len(self._octets):
            raise ValueError("bytes are missing")


def is_message(full_name: str, octets: bytes) -> bool:
    """Return whether a packet is a message, no byte more or less."""
    try:
        Walker(octets).whole(full_name)
    except ValueError:
        return False
    return True


@pytest.mark.parametrize("profile", [Profile.HOST, Profile.STRICT])
def test_hostile_packets(tmp_path: Path, profile: Profile) -> None:
    types = [*all_types()[::18], *ANGLED]
    program = Program(tmp_path, types, profile, "-O1", "-g", *SANITIZERS)
    read = 0
    for name in types:
        given = packets(name, 60)
        for packet, answer in zip(given, program.answers(name, given), strict=True):
            assert not answer.good or answer.octets == packet, (name, packet)
            assert answer.allocated <= len(packet) * TIMES_THE_BYTES + EMPTY_ITEMS, (name, packet)
            if profile is Profile.HOST:
                assert answer.good == is_message(name, packet), (name, packet)
            else:
                assert answer.allocated == 0, (name, packet)
                assert not answer.good or is_message(name, packet), (name, packet)
            read += answer.good
    assert read > 250, "most faults leave no message, but some do"
