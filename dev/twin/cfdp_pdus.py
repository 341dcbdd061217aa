"""Hand-made PDUs of CFDP (CCSDS 727.0-B-5), valid and invalid, as the ground may send them to CF."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from random import Random

GROUND, CRAFT = 23, 25
METADATA, END, ACKNOWLEDGE, FINISHED, MISSING = 7, 4, 6, 5, 8
"""Directive codes."""
NO_ERROR, CANCELLED = 0x00, 0xF0
MODULAR = 0
"""The type of checksum."""


def pdu(body: bytes, number: int, *, is_data: bool = False, acknowledged: bool = False, to: int = CRAFT) -> bytes:
    """Return a PDU to the receiver of a file, with ids of one byte."""
    flags = 0x20 | 0x10 * is_data | 0x04 * (not acknowledged)
    return struct.pack(">BHBBBB", flags, len(body), 0, GROUND, number & 0xFF, to) + body


def checksum(data: bytes) -> int:
    """CFDP's modular checksum: the sum of words of four bytes."""
    padded = data + bytes(-len(data) % 4)
    return sum(int.from_bytes(padded[at : at + 4], "big") for at in range(0, len(padded), 4)) & 0xFFFFFFFF


def transfer(random: Random, number: int) -> Iterator[bytes]:
    """Yield the PDUs of a small file's uplink. One of them may be wrong, missing, repeated or too short."""
    acknowledged = random.random() < 0.5
    data = random.randbytes(random.choice((0, 1, 7, 100, 700)))
    source, target = b"up.dat", random.choice((b"/ram/up.dat", b"/ram/up2.dat", b"/nowhere/up.dat", b"", b"/ram"))
    names = bytes([len(source)]) + source + bytes([len(target)]) + target
    whole = checksum(data) ^ (random.random() < 0.15)
    size = len(data) + random.choice((0, 0, 0, 0, 1, -1 if data else 0))
    bodies = [(struct.pack(">BBI", METADATA, MODULAR, len(data)) + names, False)]
    bodies += [(struct.pack(">I", at) + data[at : at + 300], True) for at in range(0, len(data), 300)]
    bodies += [(struct.pack(">BBII", END, random.choice((NO_ERROR,) * 5 + (CANCELLED,)), whole, size), False)]
    chance = random.random()
    place = random.randrange(len(bodies))
    if chance < 0.15:
        del bodies[place]
    elif chance < 0.3:
        bodies.insert(place, bodies[place])
    elif chance < 0.4:
        bodies[place] = bodies[place][0][: random.randrange(6)], bodies[place][1]
    to = random.choice((CRAFT,) * 9 + (GROUND,))
    for body, is_data in bodies:
        yield pdu(body, number, is_data=is_data, acknowledged=acknowledged, to=to)
