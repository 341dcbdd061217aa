"""Compare packets of electronic data sheets with NASA's EdsLib: random values packed and random bytes unpacked by both.

EdsLib is not part of cfepy. Build it (nasa/EdsLib, with its Python binding), and let its tool make the database of the
same data sheets. Then, with the folder of the database in LD_LIBRARY_PATH:

    python -m dev.eds_packets FOLDER_OF_EDSLIB_SO NAME_OF_DATABASE FILE.xml ... --count 100000

It ends with status 1 if a packet differs. Unsigned numbers of 64 bits are compared without their sign, because EdsLib's
binding reads every number as a signed one.
"""

from __future__ import annotations

import argparse
import random
import struct
import sys
from pathlib import Path
from typing import Any

from cfepy.extra.dictionaries import DataSheets, read_document, wire_layout
from cfepy.extra.dictionaries.packets import DeclaredPacket
from cfepy.msg import BitLayout, FieldPlace

HEADER = ("CCSDS", "Sec")
COMPUTED = ("CCSDS.Length", "Sec.Checksum")
LETTERS = "abcXYZ019_/."
LENGTH_AT, CODE_AT, CHECKSUM_AT, LENGTH_LESS = 4, 6, 7, 7


class Comparison:
    """The packets of one database.

    Args:
        edslib: the module of EdsLib.
        database: name of its database.
        draw: draws values and bytes.
    """

    def __init__(self, edslib: Any, database: str, draw: random.Random) -> None:
        self._edslib = edslib
        self._database = edslib.Database(database)
        self._draw = draw
        self.values = 0

    def packed(self, packet: DeclaredPacket, name: str, layout: BitLayout) -> str:
        """Pack random values; returns a difference, or "" if both have the same bytes."""
        theirs = self._edslib.DatabaseEntry(self._database, name)()
        mine: dict[Any, Any] = {}
        header = self._header(packet)
        for place in layout.places:
            value = header.get(place.path) if place.steps[0] in HEADER else self._value(place)
            if value is None:
                continue
            _set(theirs, place.steps, value)
            holder = mine
            for step in place.steps[:-1]:
                holder = holder.setdefault(step, {})
            holder[place.steps[-1]] = value
        self.values += len(layout.places)
        made = bytearray(layout.pack(_with_lists(mine)))
        _settle(made, packet)
        expected = bytes(self._edslib.PackedObject(theirs))
        return "" if made == expected else f"packed {made.hex()}, EdsLib {expected.hex()}"

    def unpacked(self, packet: DeclaredPacket, name: str, layout: BitLayout) -> str:
        """Unpack random bytes; returns a difference, or "" if both have the same values."""
        data = bytearray(self._draw.randbytes(layout.size))
        data[:LENGTH_AT] = struct.pack(">HH", packet.msg_id, 0xC000 | self._draw.randrange(1 << 14))
        if packet.is_command:
            data[CODE_AT] = packet.code or 0
        _settle(data, packet)
        theirs = self._edslib.DatabaseEntry(self._database, name)(self._edslib.PackedObject(bytes(data)))
        mine = layout.unpack(data)
        self.values += len(layout.places)
        for place in layout.places:
            value, expected = _get(mine, place.steps), _get(theirs, place.steps)
            if place.path not in COMPUTED and not _is_same(place, value, expected, data):
                return f"{place.path} is {value!r}, EdsLib {expected!r}"
        return ""

    def _header(self, packet: DeclaredPacket) -> dict[str, int]:
        return {
            "CCSDS.VersionId": 0,
            "CCSDS.SecHdrFlags": 3 if packet.is_command else 1,
            "CCSDS.AppId": packet.msg_id & 0x7FF,
            "CCSDS.SeqFlag": 3,
            "CCSDS.Sequence": self._draw.randrange(1 << 14),
            "Sec.FunctionCode": packet.code or 0,
            "Sec.Seconds": self._draw.randrange(1 << 32),
            "Sec.Subseconds": self._draw.randrange(1 << 16),
        }

    def _value(self, place: FieldPlace) -> Any:
        draw = self._draw
        if place.kind == "char":
            return "".join(draw.choice(LETTERS) for _ in range(draw.randrange(place.bits // 8 + 1)))
        if place.kind == "bool":
            return draw.random() < 0.5
        if place.kind == "f":
            value = draw.uniform(-1e6, 1e6)
            return struct.unpack(">f", struct.pack(">f", value))[0] if place.bits == 32 else value
        if place.names is not None and draw.random() < 0.9:
            return draw.choice(list(place.names.values.values()))
        half = 1 << (place.bits - 1)
        low, high = (-half, half - 1) if place.kind == "i" else (0, 2 * half - 1)
        return draw.choice((low, high, draw.randint(low, high), draw.randint(low, high)))


def _set(target: Any, steps: tuple[str | int, ...], value: Any) -> None:
    holder = _get(target, steps[:-1])
    if isinstance(steps[-1], int):
        holder[steps[-1]] = value
    else:
        setattr(holder, steps[-1], value)


def _get(value: Any, steps: tuple[str | int, ...]) -> Any:
    for step in steps:
        value = value[step] if isinstance(step, int) or isinstance(value, dict) else getattr(value, step)
    return value


def _with_lists(value: Any) -> Any:
    if not isinstance(value, dict):
        return value
    if value and all(isinstance(step, int) for step in value):
        return [_with_lists(value[step]) for step in sorted(value)]
    return {step: _with_lists(inner) for step, inner in value.items()}


def _settle(data: bytearray, packet: DeclaredPacket) -> None:
    """Write length and checksum as the ground does; EdsLib computes them itself."""
    struct.pack_into(">H", data, LENGTH_AT, len(data) - LENGTH_LESS)
    if packet.is_command:
        data[CHECKSUM_AT] = 0
        checksum = 0xFF
        for byte in data:
            checksum ^= byte
        data[CHECKSUM_AT] = checksum


def _is_same(place: FieldPlace, mine: Any, theirs: Any, data: bytes | bytearray) -> bool:
    if place.kind == "char":
        text = bytes(data[place.start // 8 : (place.start + place.bits) // 8]).partition(b"\0")[0]
        return not text.isascii() or bool(str(theirs) == mine)  # the binding refuses other texts
    if place.kind == "f":
        return struct.pack(">d", float(theirs)) == struct.pack(">d", mine) or bool(mine != mine)
    if isinstance(theirs, str) and place.names is not None:
        return bool(place.names.number(theirs) == mine)
    number = int(theirs)
    if place.kind == "u" and place.bits == 64 and number < 0:
        number += 1 << 64
    return bool(number == int(mine))


def main() -> int:
    """Compare, and print the figures."""
    parser = argparse.ArgumentParser(prog="python -m dev.eds_packets", description=__doc__)
    parser.add_argument("edslib", help="folder of EdsLib.so")
    parser.add_argument("database", help="name of the database, such as cfs for cfs_eds_db.so")
    parser.add_argument("sheets", nargs="+", type=Path, help="the data sheets of the database")
    parser.add_argument("--count", type=int, default=100_000, help="packets")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    sys.path.insert(0, arguments.edslib)
    import EdsLib  # type: ignore[import-not-found]

    sheets = DataSheets([read_document(file) for file in arguments.sheets])
    content = sheets.content()
    names = {f"{name.replace('/', '_')}_t": name for name in sheets.types.names()}
    packets = [(each, names[each.whole.name], wire_layout(each.whole)) for each in content.packets if each.whole]
    comparison = Comparison(EdsLib, arguments.database, random.Random(arguments.seed))
    differences = 0
    for number in range(arguments.count):
        packet, name, layout = packets[number // 2 % len(packets)]
        compare = comparison.unpacked if number % 2 else comparison.packed
        difference = compare(packet, name, layout)
        if difference:
            differences += 1
            print(f"{packet.name}: {difference}")
    print(f"{len(packets)} packets, {arguments.count:,} cases, {comparison.values:,} values, {differences} different")
    return int(differences > 0)


if __name__ == "__main__":
    sys.exit(main())
