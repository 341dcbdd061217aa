"""The targets of procedures: packets by target and name, from COSMOS definitions and from the mission's dictionary."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

from cfepy.extra.procedures.definition_reader import msg_ids_in, read_definitions
from cfepy.extra.procedures.erb import Helper, Template
from cfepy.extra.procedures.packet_items import Item, PacketDefinition, squeezed
from cfepy.ground import Dictionary, Topic, flat, xtce_name
from cfepy.msg import CMD_HEADER_SIZE, TLM_HEADER_SIZE, Cell, Command, Layout, Telemetry
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

_FILLERS = ("CMD", "TLM")
_WORDS_LEFT_OUT = frozenset({"CMD", "TLM", "PKT", "PACKET", "MSG"})
_KINDS = {"u": "u", "i": "i", "f": "f", "b": "bool"}
_SEQUENCE = 0xC000


class TargetPackets:
    """Packets by target and name.

    Args:
        dictionary: the mission's packets.
        name: the name of the target whose packets are the mission's.
    """

    def __init__(self, dictionary: Dictionary, name: str) -> None:
        self.name = name.upper()
        self.notes: list[str] = []
        self._dictionary = dictionary
        self._commands: dict[tuple[str, str], PacketDefinition] = {}
        self._telemetry: dict[tuple[str, str], PacketDefinition] = {}
        self._squeezed: dict[tuple[bool, str, str], PacketDefinition] = {}
        self._learn_mission()

    def _learn_mission(self, only_topics: bool = False) -> None:
        for packet in _mission_packets(self.name, self._dictionary, only_topics):
            known = self._commands if packet.is_command else self._telemetry
            known.setdefault((packet.target, packet.name), packet)
            self._squeezed.setdefault((packet.is_command, packet.target, _short(packet.name)), packet)

    def learn(self) -> None:
        """Add the topics of running nodes, which the mission's dictionary has learned since."""
        for key in [key for key, each in self._telemetry.items() if each.read_all is not None]:
            del self._telemetry[key]
        self._squeezed = {key: each for key, each in self._squeezed.items() if each.read_all is None}
        self._learn_mission(only_topics=True)

    def add(self, packets: Iterable[PacketDefinition]) -> None:
        """Add packets of definitions, which come before the mission's own names."""
        for packet in packets:
            known = self._commands if packet.is_command else self._telemetry
            known[packet.target, packet.name] = packet

    def read_folder(self, folder: Path, variables: Mapping[str, Any]) -> None:
        """Add the packets of all definitions in a target's folder.

        Args:
            folder: the folder with `cmd_tlm`.
            variables: variables of ERB.

        Raises:
            UsageError: for a definition that cannot be read.
        """
        ids = msg_ids_in([folder / "lib", *(each / "lib" for each in list(folder.parents)[:2])])
        for file in sorted((folder / "cmd_tlm").glob("*.txt")):
            text = read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace")
            template = Template(variables, lambda name: self._header(name, ids))
            found = read_definitions(template.render(text, file), file, self.notes.append)
            self.add(each for each in found if each.msg_id)

    def _header(self, name: str, ids: Mapping[str, int]) -> Helper | None:
        if name.endswith("_cmd_hdr"):
            return lambda *given: self._command_header(ids, *given)
        if name.endswith("_tlm_hdr"):
            return lambda *given: self._telemetry_header(ids, *given)
        return None

    def _command_header(self, ids: Mapping[str, int], target: str, name: str, *rest: Any) -> str:
        *_, code, text = rest
        msg_id = ids.get(name, _msg_id_of(name, int(code), self._dictionary)) or 0
        if not msg_id:
            self.notes.append(f"{target} {name}: the mission has no such command")
        return (
            f'COMMAND {target} {name} LITTLE_ENDIAN "{text}"\n'
            f'APPEND_ID_PARAMETER CCSDS_STREAMID 16 UINT MIN MAX {msg_id} "MsgId" BIG_ENDIAN\n'
            'APPEND_PARAMETER CCSDS_SEQUENCE 16 UINT MIN MAX 0xC000 "Sequence" BIG_ENDIAN\n'
            'APPEND_PARAMETER CCSDS_LENGTH 16 UINT MIN MAX 1 "Length" BIG_ENDIAN\n'
            f'APPEND_PARAMETER CCSDS_FC 8 UINT MIN MAX {code} "Function code" BIG_ENDIAN\n'
            'APPEND_PARAMETER CCSDS_CHECKSUM 8 UINT MIN MAX 0 "Checksum" BIG_ENDIAN\n'
        )

    def _telemetry_header(self, ids: Mapping[str, int], target: str, name: str, *rest: Any) -> str:
        msg_id = ids.get(name, _msg_id_of(name, None, self._dictionary)) or 0
        if not msg_id:
            self.notes.append(f"{target} {name}: the mission has no such packet")
        return (
            f'TELEMETRY {target} {name} LITTLE_ENDIAN "{rest[-1]}"\n'
            f'APPEND_ID_ITEM CCSDS_STREAMID 16 UINT {msg_id} "MsgId" BIG_ENDIAN\n'
            'APPEND_ITEM CCSDS_SEQUENCE 16 UINT "Sequence" BIG_ENDIAN\n'
            'APPEND_ITEM CCSDS_LENGTH 16 UINT "Length" BIG_ENDIAN\n'
            'APPEND_ITEM SECONDS 32 UINT "Time, in s" BIG_ENDIAN\n'
            'APPEND_ITEM SUBSECS 16 UINT "Time, in 1/65536 s" BIG_ENDIAN\n'
            'APPEND_ITEM SPARE_FOR_64_ALIGN 32 UINT "Alignment"\n'
        )

    def helper(self, name: str) -> Helper | None:
        """Return the helper of ERB in procedures with a name, or None.

        `get_..._msg_id('PACKET', ...)` is the MsgId of a packet. `..._num_from_target_name(target)` is the number in
        the name of a target, such as 2 of CFS-2, or None.
        """
        if name.startswith("get_") and name.endswith("msg_id"):
            return lambda packet, *rest: self._packet(packet).msg_id
        if name.endswith("num_from_target_name"):
            return _number_in
        return None

    def _packet(self, name: str) -> PacketDefinition:
        try:
            return self.command(self.name, name)
        except UsageError:
            return self.telemetry(self.name, name)

    # -- lookup --------------------------------------------------------------------------------------------------------

    def command(self, target: str, name: str) -> PacketDefinition:
        """Return a command.

        Raises:
            UsageError: if it does not exist; the text names similar ones.
        """
        return self._found(True, target, name)

    def telemetry(self, target: str, name: str) -> PacketDefinition:
        """Return a telemetry packet.

        Raises:
            UsageError: if it does not exist; the text names similar ones.
        """
        return self._found(False, target, name)

    def _found(self, is_command: bool, target: str, name: str) -> PacketDefinition:
        known = self._commands if is_command else self._telemetry
        key = target.upper(), name.upper()
        found = known.get(key) or self._squeezed.get((is_command, key[0], _short(name)))
        if found is not None:
            return found
        if key[0] not in self.names():
            raise UsageError(f"unknown target {key[0]}; {did_you_mean(key[0], self.names(), '')}")
        kind = "command" if is_command else "telemetry packet"
        names = [each for owner, each in known if owner == key[0]]
        raise UsageError(f"{key[0]} has no {kind} {key[1]}; {did_you_mean(key[1], names, 'see cfepy cmd --list')}")

    def names(self) -> list[str]:
        """Return the names of all targets."""
        return sorted({target for target, _ in [*self._commands, *self._telemetry]})

    def packets(self, target: str, is_command: bool) -> list[PacketDefinition]:
        """Return the commands or telemetry packets of a target, by name."""
        known = self._commands if is_command else self._telemetry
        return sorted((each for (owner, _), each in known.items() if owner == target.upper()), key=lambda p: p.name)


def _short(name: str) -> str:
    """Return a packet's name without the words in which COSMOS and cFE differ."""
    return squeezed("_".join(each for each in name.upper().split("_") if each not in _FILLERS))


def _mission_packets(target: str, dictionary: Dictionary, only_topics: bool = False) -> list[PacketDefinition]:
    """Return the packets of a mission's dictionary, and its ROS topics.

    Args:
        target: the name of the target.
        dictionary: the mission's packets.
        only_topics: leave out the packets, which take long if there are many.
    """
    topics = [_topic(target, each, dictionary) for each in dictionary.telemetry.values() if isinstance(each, Topic)]
    if only_topics:
        return topics
    commands = [_command(target, each) for each in dictionary.commands.values()]
    telemetry = [_telemetry(target, each) for each in dictionary.telemetry.values() if not isinstance(each, Topic)]
    return [*commands, *telemetry, *topics]


def _command_header_items(target: str, msg_id: int, code: int | None) -> list[Item]:
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


def _telemetry_header_items() -> list[Item]:
    """Return the items of the header of a telemetry packet."""
    return [
        Item("CCSDS_STREAMID", "u", 0, 16, True),
        Item("CCSDS_SEQUENCE", "u", 16, 16, True),
        Item("CCSDS_LENGTH", "u", 32, 16, True),
        Item("SECONDS", "u", 48, 32, True),
        Item("SUBSECS", "u", 80, 16, True),
    ]


def _command(target: str, command: Command) -> PacketDefinition:
    items = [
        *_command_header_items(target, command.msg_id, command.code),
        *_items(command.payload, 8 * CMD_HEADER_SIZE),
    ]
    named = {each.name: each for each in items}
    return PacketDefinition(
        target, command.name, True, command.msg_id, command.code, named, command.length, command.text
    )


def _telemetry(target: str, packet: Telemetry) -> PacketDefinition:
    items = [*_telemetry_header_items(), *_items(packet.payload, 8 * TLM_HEADER_SIZE)]
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


def _msg_id_of(name: str, code: int | None, dictionary: Dictionary) -> int | None:
    """Return the MsgId of the mission's packet that a definition names, or None.

    A command is the one with the same function code and the longest common beginning, for example
    TO_LAB_CMD_ENABLE_OUTPUT with code 6 is the mission's TO_LAB_OUTPUT_ENABLE.

    Args:
        name: name in the definitions.
        code: function code; None for telemetry.
        dictionary: the mission's packets.
    """
    words = [each for each in name.upper().split("_") if each not in _WORDS_LEFT_OUT]
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


def _number_in(target: str) -> int | None:
    match = re.search(r"\d+", target)
    return None if match is None else int(match[0])


def _plain(name: str) -> list[str]:
    return [each for each in name.upper().split("_") if each not in _WORDS_LEFT_OUT]
