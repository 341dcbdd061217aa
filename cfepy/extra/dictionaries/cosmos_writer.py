"""Command and telemetry text for COSMOS and OpenC3, of all packets of a mission.

Each item has its bit offset in the whole packet and its byte order, so nothing depends on the line before. Names in
nested structs are joined with "_", as in XTCE: `AppData[3].AppID` is APPDATA_3_APPID.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import groupby

from cfepy.extra.dictionaries.cosmos_reader import PADDING
from cfepy.extra.dictionaries.nasa_names import snake
from cfepy.ground import Dictionary, xtce_name
from cfepy.mission import MissionSpec
from cfepy.msg import CMD_HEADER_SIZE, Cell, Command, Layout, Measurement, Telemetry

BIG, LITTLE = "BIG_ENDIAN", "LITTLE_ENDIAN"
_ITEM = re.compile(r"(.*)\[(\d+)\]")
_TYPES = {"u": "UINT", "i": "INT", "f": "FLOAT", "b": "UINT"}
_SEQUENCE, _LENGTH_LESS = 0xC000, 7


def cosmos_text(spec: MissionSpec, dictionary: Dictionary) -> str:
    """Return the text of a file `cmd_tlm/NAME.txt`.

    Args:
        spec: the mission; its name is the target.
        dictionary: its packets; topics of ROS are left out.
    """
    target = snake(spec.name)
    lines = [f"# Packets of the mission {spec.name}, written by cfepy export cosmos"]
    for command in sorted(dictionary.commands.values(), key=lambda each: (each.msg_id, each.code or 0, each.name)):
        lines += ["", *_command(target, command)]
    found = [each for each in dictionary.telemetry.values() if isinstance(each, Telemetry)]
    for packet in sorted(found, key=lambda each: (each.msg_id, each.name)):
        lines += ["", *_telemetry(target, packet)]
    return "\n".join(lines) + "\n"


def _command(target: str, command: Command) -> Iterator[str]:
    yield f"COMMAND {target} {command.name} {LITTLE} {_quoted(command.text)}"
    yield f'  ID_PARAMETER CCSDS_STREAMID 0 16 UINT MIN MAX 0x{command.msg_id:04X} "MsgId" {BIG}'
    yield f'  PARAMETER CCSDS_SEQUENCE 16 16 UINT MIN MAX 0x{_SEQUENCE:04X} "Sequence flags and count" {BIG}'
    length = command.length - _LENGTH_LESS
    yield f'  PARAMETER CCSDS_LENGTH 32 16 UINT MIN MAX {length} "Length of the packet less {_LENGTH_LESS}" {BIG}'
    word = "PARAMETER" if command.code is None else "ID_PARAMETER"
    yield f'  {word} CCSDS_FC 48 8 UINT MIN MAX {command.code or 0} "Function code" {BIG}'
    yield f'  PARAMETER CCSDS_CHECKSUM 56 8 UINT MIN MAX 0 "Checksum" {BIG}'
    yield from _items(command.payload.cells(), "PARAMETER", 8 * CMD_HEADER_SIZE)
    yield from _end(command.payload, "PARAMETER", 8 * CMD_HEADER_SIZE)


def _telemetry(target: str, packet: Telemetry) -> Iterator[str]:
    yield f"TELEMETRY {target} {packet.name} {LITTLE} {_quoted(packet.text)}"
    yield f'  ID_ITEM CCSDS_STREAMID 0 16 UINT 0x{packet.msg_id:04X} "MsgId" {BIG}'
    yield f'  ITEM CCSDS_SEQUENCE 16 16 UINT "Sequence flags and count" {BIG}'
    yield f'  ITEM CCSDS_LENGTH 32 16 UINT "Length of the packet less {_LENGTH_LESS}" {BIG}'
    yield f'  ITEM CCSDS_SECONDS 48 32 UINT "Time, in s" {BIG}'
    yield f'  ITEM CCSDS_SUBSECONDS 80 16 UINT "Time, in 1/65536 s" {BIG}'
    yield from _items(packet.payload.cells(), "ITEM", 8 * packet.header_size)
    yield from _end(packet.payload, "ITEM", 8 * packet.header_size)


def _items(cells: Iterable[Cell], word: str, header: int) -> Iterator[str]:
    for _, group in groupby(cells, _array_of):
        run = list(group)
        arrays = _is_array(run)
        for cell in run[:1] if arrays else run:
            name = xtce_name(_array_of(cell) if arrays else cell.path).upper()
            kind = "STRING" if cell.type.startswith("char") else _TYPES[cell.type[0]]
            order = BIG if cell.big_endian or cell.width % 8 or cell.width == 8 else LITTLE
            start = header + cell.start
            if arrays:
                whole = cell.width * len(run)
                yield f'  ARRAY_{word} {name} {start} {cell.width} {kind} {whole} "" {order}'
                continue
            yield f'  {word} {name} {start} {cell.width} {kind}{_range(word, kind)} "" {order}'
            yield from _details(cell)


def _end(layout: Layout, word: str, header: int) -> Iterator[str]:
    """Yield the padding at the end of a packet, without which it would be too short."""
    end = max((cell.start + cell.width for cell in layout.cells()), default=0)
    if end < 8 * layout.size:
        start, bits = header + end, 8 * layout.size - end
        value = ' ""' if word == "PARAMETER" else ""
        kind = "BLOCK" if bits % 8 == 0 else f"UINT{_range(word, 'UINT')}"
        yield f'  {word} {PADDING} {start} {bits} {kind}{value if bits % 8 == 0 else ""} "Padding" {BIG}'


def _range(word: str, kind: str) -> str:
    """Return the lowest, highest and default value of a parameter."""
    if word != "PARAMETER":
        return ""
    return ' ""' if kind == "STRING" else " MIN MAX 0"


def _details(cell: Cell) -> Iterator[str]:
    if cell.names is not None and not cell.names.flags:
        for label, value in cell.names.values.items():
            yield f"    STATE {_word(label)} {value}"
    measured = cell.measurement
    if measured is None:
        return
    if measured.unit:
        yield f"    UNITS {_quoted(measured.unit)} {_quoted(measured.unit)}"
    if measured.polynomial:
        yield "    POLY_READ_CONVERSION " + " ".join(repr(float(each)) for each in measured.polynomial)
    yield from _segments(measured)
    limits = [limit for name in ("red", "yellow") for limit in measured.limits(name)]
    if None not in limits:
        red_low, red_high, yellow_low, yellow_high = limits
        yield f"    LIMITS DEFAULT 1 ENABLED {red_low} {yellow_low} {yellow_high} {red_high}"


def _segments(measured: Measurement) -> Iterator[str]:
    for (low, first), (high, last) in zip(measured.points, measured.points[1:], strict=False):
        slope = (last - first) / (high - low)
        yield f"    SEG_POLY_READ_CONVERSION {low!r} {first - slope * low!r} {slope!r}"


def _array_of(cell: Cell) -> str:
    match = _ITEM.fullmatch(cell.path)
    return cell.path if match is None else match[1]


def _is_array(run: list[Cell]) -> bool:
    """Return whether cells are the numbers of one array, one behind the other."""
    first = run[0]
    plain = first.names is None and first.measurement is None and not first.type.startswith("char")
    starts = [first.start + number * first.width for number in range(len(run))]
    return len(run) > 1 and plain and [cell.start for cell in run] == starts


def _quoted(text: str) -> str:
    return '"' + re.sub(r"\s+", " ", text.replace("\\", "/").replace('"', "'")) + '"'


def _word(text: str) -> str:
    return text if re.fullmatch(r"\w+", text) else _quoted(text)
