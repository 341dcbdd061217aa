"""Random packets of declared layouts, for tools that read and write them beside cfepy."""

from __future__ import annotations

import math
import struct
from random import Random
from typing import Literal

from cfepy.ground.values import flat, named_fields
from cfepy.ground.xtce import xtce_name
from cfepy.msg import TLM_HEADER_SIZE, Cell, Command, Layout, Telemetry, ValueNames, telemetry

TEXT = 'abcXYZ019 _/.\u00e9\u20ac<&"'
FLOATS = (0.0, -0.0, math.inf, -math.inf, 1.0, 1e-40)
UNSEGMENTED = 0xC000
SEQUENCES = 0x4000
PART = Layout("Part", [("a", "u8"), ("b", "f64"), ("c", "char[3]")])
ALL_TYPES = Layout(
    "AllTypes",
    [
        *((kind, kind) for kind in ("bool", "u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f32", "f64")),
        ("text", "char[20]"),
        ("array", "u16[4]"),
        ("table", "u8[2][3]"),
        ("texts", "char[4][3]"),
        ("parts", (PART, 2)),
        ("state", ValueNames("u8", SHORT=0, LONG=1)),
        ("signed_state", ValueNames("i32", BELOW=-5, ZERO=0, ABOVE=70000)),
        ("mask", ValueNames("u16", flags=True, ERROR=1, CRITICAL=2)),
        ("last", "u8"),
    ],
)
"""A field of every type that a layout can have."""
DECLARED = (Telemetry("ALL_TYPES_TLM", 0x0890, ALL_TYPES), Command("ALL_TYPES", 0x1890, 3, ALL_TYPES, 'of <all> & "é"'))


def random_payload(layout: Layout, random: Random) -> bytes:
    """Return bytes of a layout: numbers of the whole range, texts with a NUL behind them, named values if there are
    names.

    Args:
        layout: layout of the payload.
        random: source of randomness, also for padding.
    """
    payload = bytearray(random.randbytes(layout.size))
    order: Literal["little", "big"] = "big" if layout.on_the_wire else "little"
    for cell in layout.cells():
        payload[cell.offset : cell.offset + cell.size] = _random_cell(cell, order, random)
    return bytes(payload)


def _random_cell(cell: Cell, order: Literal["little", "big"], random: Random) -> bytes:
    if cell.type.startswith("char"):
        text = "".join(random.choices(TEXT, k=random.randrange(cell.size))).encode()[: cell.size - 1]
        return text.decode(errors="ignore").encode().ljust(cell.size, b"\0")
    if cell.type == "bool":
        return bytes([random.randrange(2)])
    if cell.type in ("f32", "f64"):
        value = random.choice((*FLOATS, random.uniform(-1e6, 1e6), random.gauss(0, 1)))
        return struct.pack((">" if order == "big" else "<") + cell.type.replace("f32", "f").replace("f64", "d"), value)
    return _random_number(cell, random).to_bytes(cell.size, order, signed=cell.type[0] == "i")


def _random_number(cell: Cell, random: Random) -> int:
    if cell.names is not None and not cell.names.flags:
        return random.choice(list(cell.names.values.values()))
    bits = 8 * cell.size
    low, high = (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) if cell.type[0] == "i" else (0, 2**bits - 1)
    return random.choice((low, high, random.randint(low, high)))


def random_telemetry(declared: Telemetry, sequence: int, random: Random) -> bytes:
    """Return a telemetry packet of random values and a random time.

    Args:
        declared: the packet.
        sequence: its sequence count.
        random: decides.
    """
    packet = bytearray(telemetry(declared.msg_id, random_payload(declared.payload, random)))
    if declared.first is not None:
        packet[TLM_HEADER_SIZE] = declared.first
    packet[2:4] = (UNSEGMENTED | sequence % SEQUENCES).to_bytes(2, "big")
    packet[6:12] = random.randbytes(6)
    return bytes(packet)


def telemetry_values(declared: Telemetry, packet: bytes) -> dict[str, object]:
    """Return the payload values that a reader of our XTCE must find in a packet."""
    values = xtce_values(declared.name, declared.payload, packet[TLM_HEADER_SIZE:])
    if declared.first is not None:
        del values[next(iter(values))]
    return values


def xtce_values(name: str, layout: Layout, payload: bytes) -> dict[str, object]:
    """Return the expected values of a payload by a reader of our XTCE, by parameter; enumerations have their names.

    Args:
        name: of the packet; "" for the arguments of a command.
        layout: of the payload.
        payload: the bytes.
    """
    named, start = named_fields(layout), f"{xtce_name(name)}_" if name else ""
    return {
        start + xtce_name(path): named[path].text(value) if path in named and not named[path].flags else value
        for path, value in flat(layout.unpack(payload)).items()
    }
