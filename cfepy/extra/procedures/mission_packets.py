"""Packets of a mission's own dictionary as a ground system shows them, and MsgIds by the names of packets in COSMOS."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby
from typing import Any

from cfepy.extra.procedures.packet_items import Item, PacketDefinition, squeezed
from cfepy.ground import Dictionary, Topic, flat, xtce_name
from cfepy.msg import CMD_HEADER_SIZE, TLM_HEADER_SIZE, Cell, Command, Layout, Telemetry

_KINDS = {"u": "u", "i": "i", "f": "f", "b": "bool"}
_FILLERS = frozenset({"CMD", "TLM", "PKT", "PACKET", "MSG"})
_SEQUENCE = 0xC000


def packets_of(target: str, dictionary: Dictionary) -> list[PacketDefinition]:
    """Return the packets of a mission's dictionary, and its ROS topics.

    Args:
        target: the name of the target.
        dictionary: the mission's packets.
    """
    commands = [_command(target, each) for each in dictionary.commands.values()]
    telemetry = [
        _topic(target, each, dictionary) if isinstance(each, Topic) else _telemetry(target, each)
        for each in dictionary.telemetry.values()
    ]
    return [*commands, *telemetry]


def command_header(target: str, msg_id: int, code: int | None) -> list[Item]:
    """Return the items of the header of a command.

    Args:
        target: the name of the target, for the description.
        msg_id: its MsgId.
        code: its function code; None for a command without one.
    """
    return [
        Item("CCSDS_STREAMID", "u", 0, 16, True, default=msg_id, text=f"MsgId of {target}"),
        Item("CCSDS_SEQUENCE", "u", 16, 16, True, default=_SEQUENCE),
        Item("CCSDS_LENGTH", "u", 32, 16, True, default=1),
        Item("CCSDS_FC", "u", 48, 8, True, default=code or 0),
        Item("CCSDS_CHECKSUM", "u", 56, 8, True, default=0),
    ]


def telemetry_header() -> list[Item]:
    """Return the items of the header of a telemetry packet."""
    return [
        Item("CCSDS_STREAMID", "u", 0, 16, True),
        Item("CCSDS_SEQUENCE", "u", 16, 16, True),
        Item("CCSDS_LENGTH", "u", 32, 16, True),
        Item("SECONDS", "u", 48, 32, True),
        Item("SUBSECS", "u", 80, 16, True),
    ]


def _command(target: str, command: Command) -> PacketDefinition:
    items = [*command_header(target, command.msg_id, command.code), *_items(command.payload, 8 * CMD_HEADER_SIZE)]
    named = {each.name: each for each in items}
    return PacketDefinition(
        target, command.name, True, command.msg_id, command.code, named, command.length, command.text
    )


def _telemetry(target: str, packet: Telemetry) -> PacketDefinition:
    items = [*telemetry_header(), *_items(packet.payload, 8 * TLM_HEADER_SIZE)]
    named = {each.name: each for each in items}
    return PacketDefinition(target, packet.name, False, packet.msg_id, None, named, packet.length, packet.text)


def _topic(target: str, topic: Topic, dictionary: Dictionary) -> PacketDefinition:
    name = topic.name.strip("/").replace("/", "_").upper()

    def read_all(data: bytes) -> Mapping[str, Any]:
        return {squeezed(path): value for path, value in flat(dictionary.decode(data).values).items()}

    return PacketDefinition(target, name, False, topic.msg_id, text=topic.text, read_all=read_all)


def _items(layout: Layout, header: int) -> list[Item]:
    found = []
    for name, group in groupby(layout.cells(), lambda cell: cell.path.split("[", 1)[0] if _is_element(cell) else ""):
        cells = list(group)
        if name:
            first = _item(cells[0], name, header)
            first.count, first.default = len(cells), []
            found.append(first)
        found += [_item(each, each.path, header) for each in cells]
    return found


def _is_element(cell: Cell) -> bool:
    return cell.path.endswith("]") and cell.path.count("[") == 1 and not cell.type.startswith("char")


def _item(cell: Cell, path: str, header: int) -> Item:
    is_text = cell.type.startswith("char")
    item = Item(
        xtce_name(path).upper(),
        "char" if is_text else _KINDS[cell.type[0]],
        header + cell.start,
        cell.width,
        cell.big_endian,
        default="" if is_text else 0,
    )
    if cell.names is not None:
        item.states = {each.upper(): value for each, value in cell.names.values.items()}
    if cell.measurement is not None:
        item.units, item.polynomial = cell.measurement.unit, tuple(cell.measurement.polynomial)
    return item


def msg_id_of(name: str, code: int | None, dictionary: Dictionary) -> int | None:
    """Return the MsgId of the mission's packet that a definition names, or None.

    A command is the one with the same function code and the longest common beginning, for example
    TO_LAB_CMD_ENABLE_OUTPUT with code 6 is the mission's TO_LAB_OUTPUT_ENABLE.

    Args:
        name: name in the definitions.
        code: function code; None for telemetry.
        dictionary: the mission's packets.
    """
    words = [each for each in name.upper().split("_") if each not in _FILLERS]
    if code is None:
        return next((each.msg_id for each in dictionary.telemetry.values() if _plain(each.name) == words), None)
    for command in dictionary.commands.values():
        if _plain(command.name) == words:
            return command.msg_id
    best, most = None, 0
    for command in dictionary.commands.values():
        if command.code != code:
            continue
        own = _plain(command.name)
        common = next(
            (i for i, (a, b) in enumerate(zip(own, words, strict=False)) if a != b), min(len(own), len(words))
        )
        same_end = sum(1 for each in words[common:] if each in own[common:])
        if common >= 1 and common + same_end > most:
            best, most = command.msg_id, common + same_end
    return best


def _plain(name: str) -> list[str]:
    return [each for each in name.upper().split("_") if each not in _FILLERS]
