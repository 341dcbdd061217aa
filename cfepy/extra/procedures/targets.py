"""The targets of procedures: packets by target and name, from COSMOS definitions and from the mission's dictionary."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from cfepy.extra.procedures.definition_reader import read_definitions
from cfepy.extra.procedures.erb import Helper, Template
from cfepy.extra.procedures.mission_packets import msg_id_of, packets_of
from cfepy.extra.procedures.packet_items import PacketDefinition, squeezed
from cfepy.ground import Dictionary
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

_ASSIGNED = re.compile(r"^\s*(\$\w+)\s*=\s*(true|false|-?\d+|0x[0-9A-Fa-f]+|\"[^\"\n]*\"|'[^'\n]*')\s*(?:#.*)?$", re.M)
_VARIABLE = re.compile(r"^\s*VARIABLE\s+(\w+)\s+(\S+)", re.M)
_STREAM = re.compile(r"base_stream_id:\s*(0x[0-9A-Fa-f]+)\s*,\s*packet_names:\s*\[([^\]]*)\]")
_FILLERS = ("CMD", "TLM")


class Targets:
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

    def _learn_mission(self) -> None:
        for packet in packets_of(self.name, self._dictionary):
            known = self._commands if packet.is_command else self._telemetry
            known.setdefault((packet.target, packet.name), packet)
            self._squeezed.setdefault((packet.is_command, packet.target, _short(packet.name)), packet)

    def learn(self) -> None:
        """Add packets that the mission's dictionary has learned since, such as topics of running nodes."""
        for key in [key for key, each in self._telemetry.items() if each.read_all is not None]:
            del self._telemetry[key]
        self._squeezed = {key: each for key, each in self._squeezed.items() if each.read_all is None}
        self._learn_mission()

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
        msg_id = ids.get(name, msg_id_of(name, int(code), self._dictionary)) or 0
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
        msg_id = ids.get(name, msg_id_of(name, None, self._dictionary)) or 0
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


def ruby_variables(folders: Iterable[Path]) -> dict[str, Any]:
    """Return the constants that Ruby files assign to global variables, and the variables of a plugin.txt.

    Only lines such as `$size = 64` and `VARIABLE name value` count; nothing is executed.

    Args:
        folders: folders with `lib/*.rb` and `plugin.txt`.
    """
    found: dict[str, Any] = {}
    for folder in folders:
        for file in sorted((folder / "lib").glob("*.rb")):
            text = read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace")
            found.update({name: _constant(value) for name, value in _ASSIGNED.findall(text)})
        plugin = folder / "plugin.txt"
        if plugin.is_file():
            text = read_limited(plugin, LINE_FILE_BYTES).decode("utf-8", "replace")
            found.update({name: _constant(value) for name, value in _VARIABLE.findall(text)})
    return found


def msg_ids_in(folders: Iterable[Path]) -> dict[str, int]:
    """Return MsgIds by packet name from tables in Ruby files: `base_stream_id: 0x1806, packet_names: ["A", ...]`.

    Args:
        folders: folders with Ruby files; missing ones count as empty.
    """
    found: dict[str, int] = {}
    for folder in folders:
        for file in sorted(folder.glob("*.rb")):
            text = read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace")
            for stream, names in _STREAM.findall(text):
                found.update({name: int(stream, 16) for name in re.findall(r'"(\w+)"', names)})
    return found


def _constant(text: str) -> Any:
    if text in ("true", "false"):
        return text == "true"
    if text[:1] in "\"'":
        return text[1:-1]
    try:
        return int(text, 0)
    except ValueError:
        return text
