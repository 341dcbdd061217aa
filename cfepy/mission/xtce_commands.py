"""Commands in XTCE: a MetaCommand each, with its header as fixed values and its payload as arguments.

Sequence count and checksum are zero: whoever sends the command may fill them in; cFE as it is delivered checks neither.
"""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree.ElementTree import Element

from cfepy.mission.xtce_names import cells_with_padding, xtce_name
from cfepy.mission.xtce_types import TypeSet, add
from cfepy.msg import Command

LENGTH_OFFSET = 7  # a packet's length field is its size less this
UNSEGMENTED = 0xC000


def add_commands(parent: Element, commands: Iterable[Command]) -> None:
    """Fill a CommandMetaData element.

    Args:
        parent: the element.
        commands: the commands, in any order.
    """
    types = TypeSet(parent, "Argument")
    metas = add(parent, "MetaCommandSet")
    for command in sorted(commands, key=lambda each: (each.msg_id, each.code or 0, each.name)):
        _add(metas, types, command)


def _add(metas: Element, types: TypeSet, command: Command) -> None:
    name = xtce_name(command.name)
    meta = add(metas, "MetaCommand", name=name, shortDescription=command.text)
    if command.payload.fields:
        arguments = add(meta, "ArgumentList")
        for cell in command.payload.cells():
            kind = types.text(cell.size) if cell.type.startswith("char") else types.number(cell.type)
            add(arguments, "Argument", name=xtce_name(cell.path), argumentTypeRef=kind)
    entries = add(add(meta, "CommandContainer", name=name), "EntryList")
    for field, value, size in _header(command):
        _fixed(entries, value.to_bytes(size, "big"), field)
    for cell in cells_with_padding(command.payload):
        if cell.type == "padding":
            _fixed(entries, bytes(cell.size))
        else:
            add(entries, "ArgumentRefEntry", argumentRef=xtce_name(cell.path))


def _header(command: Command) -> Iterable[tuple[str, int, int]]:
    """Name, value and bytes of each field of a command's headers."""
    return (
        ("PACKET_ID", command.msg_id, 2),
        ("SEQUENCE", UNSEGMENTED, 2),
        ("PKT_LEN", command.length - LENGTH_OFFSET, 2),
        ("FUNCTION_CODE", command.code or 0, 1),
        ("CHECKSUM", 0, 1),
    )


def _fixed(entries: Element, value: bytes, name: str = "") -> None:
    add(entries, "FixedValueEntry", name=name, binaryValue=value.hex(), sizeInBits=str(8 * len(value)))
