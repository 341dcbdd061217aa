"""JSON files for NASA's cFS Test Framework (CTF), one for each MsgId, in the form of its CCDD exports."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import Any

from cfepy.ground import Dictionary, names_of
from cfepy.mission import MissionSpec
from cfepy.msg import Cell, Command, Layout, Telemetry

_TYPES = {"u": "uint", "i": "int", "f": "float"}
_INDEX = re.compile(r"(.*)\[\d+\]")


def ctf_files(spec: MissionSpec, dictionary: Dictionary) -> dict[str, str]:
    """Return the texts of the files by their names.

    Args:
        spec: the mission.
        dictionary: its packets; topics of ROS are left out.
    """
    names = names_of(spec)
    files: dict[str, str] = {}
    by_id: dict[int, list[Command]] = {}
    for command in dictionary.commands.values():
        by_id.setdefault(command.msg_id, []).append(command)
    for msg_id, commands in sorted(by_id.items()):
        mid = f"{names.get(msg_id, _unnamed(commands[0]))}_MID"
        document: dict[str, Any] = {"cmd_mid_name": mid, "cmd_mid": f"0x{msg_id:04X}", "cmd_description": ""}
        document["cmd_codes"] = [_code(each) for each in sorted(commands, key=lambda each: each.code or 0)]
        files[f"{mid}_interface.json"] = _text(document)
    for packet in dictionary.telemetry.values():
        if isinstance(packet, Telemetry):
            files[f"{packet.name}_MID_interface.json"] = _text(
                {
                    "tlm_mid_name": f"{packet.name}_MID",
                    "tlm_mid": f"0x{packet.msg_id:04X}",
                    "tlm_description": packet.text,
                    "tlm_data_type": packet.payload.name,
                    "tlm_parameters": _parameters(packet.payload),
                }
            )
    return files


def _unnamed(command: Command) -> str:
    """Return a name for a MsgId without one."""
    return f"{command.name.partition('_')[0]}_CMD_{command.msg_id:04X}"


def _text(document: dict[str, Any]) -> str:
    return json.dumps(document, indent=2) + "\n"


def _code(command: Command) -> dict[str, Any]:
    return {
        "cc_name": f"{command.name}_CC",
        "cc_value": str(command.code or 0),
        "cc_description": command.text,
        "cc_data_type": command.payload.name,
        "cc_parameters": _parameters(command.payload),
    }


def _parameters(layout: Layout) -> list[dict[str, Any]]:
    """Return the fields of a layout, including the fields of nested structs."""
    return _tree([(cell.path, cell) for cell in layout.cells()])


def _tree(cells: Iterable[tuple[str, Cell]]) -> list[dict[str, Any]]:
    groups: dict[str, list[tuple[str, Cell]]] = {}
    for path, cell in cells:
        field, _, rest = path.partition(".")
        groups.setdefault(_without_index(field), []).append((f"{field}.{rest}" if rest else field, cell))
    return [_parameter(field, found) for field, found in groups.items()]


def _parameter(field: str, found: list[tuple[str, Cell]]) -> dict[str, Any]:
    count = len({path.partition(".")[0] for path, _ in found}) if "[" in found[0][0].partition(".")[0] else 0
    first = found[0][0].partition(".")[0]
    inner = [(path.partition(".")[2], cell) for path, cell in found if path.startswith(f"{first}.")]
    cell = found[0][1]
    if inner:
        kind, size, bits = "struct", str(count), 0
    elif cell.type.startswith("char"):
        kind, size, bits = "char", str(cell.size * max(count, 1)), 0
    else:
        kind, bits = _type_of(cell)
        size = str(count)
    return {
        "name": field,
        "description": "",
        "array_size": size,
        "data_type": kind,
        "bit_length": str(bits),
        "parameters": _tree(inner),
    }


def _without_index(field: str) -> str:
    match = _INDEX.fullmatch(field)
    return field if match is None else match[1]


def _type_of(cell: Cell) -> tuple[str, int]:
    """Return the type of a number, and its bits if it is a bit field."""
    if cell.type == "bool":
        return "uint8", 0 if cell.width == 8 else cell.width
    whole = next(size for size in (8, 16, 32, 64) if size >= cell.width)
    return f"{_TYPES[cell.type[0]]}{whole}", 0 if whole == cell.width else cell.width
