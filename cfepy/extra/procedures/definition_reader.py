"""Definitions of a COSMOS target (`cmd_tlm/*.txt`) for procedures: all that sending and reading by name requires.

`cfepy.extra.dictionaries` reads the same files for the mission's dictionary, without ranges, states of hazards and ERB.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from cfepy.extra.procedures.erb import Template
from cfepy.extra.procedures.packet_items import Item, PacketDefinition
from cfepy.reading.cosmos_lines import DERIVED, item_forms, kind_of_item, next_word, whole_number, words_of
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.status import UsageError

_LIMIT = re.compile(r"(MIN|MAX)(?:_(U?INT|FLOAT)(\d+))?")
_MID, _CODE = 0, 48
_ASSIGNED = re.compile(r"^(\$\w+)[ \t]*=(?!=)[ \t]*(\"[^\"\n]*\"|'[^'\n]*'|[^#\n]+?)[ \t]*(?:#.*)?$", re.M)
_VARIABLE = re.compile(r"^\s*VARIABLE\s+(\w+)\s+(\S+)", re.M)
_STREAM = re.compile(r"base_stream_id:\s*(0x[0-9A-Fa-f]+)\s*,\s*packet_names:\s*\[([^\]]*)\]")
_IGNORED_BLOCKS = ("GENERIC_READ_CONVERSION", "GENERIC_WRITE_CONVERSION")
_CODE_KEYWORDS = ("READ_CONVERSION", "WRITE_CONVERSION", "PROCESSOR", "LIMITS_RESPONSE", "VALIDATOR")


def read_definitions(text: str, file: Path, note: Callable[[str], object]) -> list[PacketDefinition]:
    """Return the packets of a file of definitions, whose ERB is already evaluated.

    Args:
        text: the definitions.
        file: where they are, for errors.
        note: called with a line for each conversion in Ruby or Python that is left out.

    Raises:
        UsageError: for a line that cannot be read.
    """
    reader = _Reader(file, note)
    for line, written in enumerate(text.replace("&\n", "").splitlines(), 1):
        words = words_of(written)
        try:
            if words:
                reader.take(words[0].upper(), words[1:], line)
        except UsageError as error:
            raise UsageError(error.text, file=file, line=line) from None
    reader.finish()
    return reader.packets


class _Reader:
    def __init__(self, file: Path, note: Callable[[str], object]) -> None:
        self.packets: list[PacketDefinition] = []
        self._file = file
        self._note = note
        self._packet: PacketDefinition | None = None
        self._item: Item | None = None
        self._big_endian = True
        self._end = 0
        self._ids: dict[int, int] = {}
        self._is_code = self._is_table = False

    def take(self, keyword: str, words: list[str], line: int) -> None:
        """Read a line."""
        if keyword.startswith(_IGNORED_BLOCKS):
            self._is_code = keyword.endswith("_START")
        elif self._is_code:
            return
        elif keyword in ("COMMAND", "TELEMETRY"):
            self.finish()
            if len(words) < 3:
                raise UsageError(f"{keyword} requires a target, a name, and BIG_ENDIAN or LITTLE_ENDIAN")
            self._is_table = False
            self._big_endian = words[2].upper() != "LITTLE_ENDIAN"
            text = words[3] if len(words) > 3 else ""
            is_command = keyword == "COMMAND"
            name = words[1].upper()
            self._packet = PacketDefinition(
                words[0].upper(), name, is_command, 0, text=text, file=self._file, line=line
            )
            self._item, self._end, self._ids = None, 0, {}
        elif keyword in ("TABLE", "SELECT_COMMAND", "SELECT_TELEMETRY"):
            self.finish()
            self._is_table = True
        elif self._packet is not None:
            self._inside(self._packet, keyword, words)

    def finish(self) -> None:
        """Add the packet that ends here."""
        packet, self._packet = self._packet, None
        if packet is None:
            return
        packet.msg_id = self._ids.get(_MID, 0)
        if packet.is_command:
            packet.code = self._ids.get(_CODE)
        packet.size = -(-self._end // 8)
        self.packets.append(packet)

    def _inside(self, packet: PacketDefinition, keyword: str, words: list[str]) -> None:
        forms = item_forms(keyword)
        if forms is not None:
            self._item = self._read_item(forms, words, packet.is_command)
            if self._item is not None:
                packet.items[self._item.name] = self._item
        elif keyword == "HAZARDOUS":
            packet.hazardous = words[0] if words else "it is hazardous"
        elif keyword.split("_", 1)[0] in ("READ", "WRITE") or keyword in _CODE_KEYWORDS:
            if self._item is not None:
                name = f"{packet.full_name} {self._item.name}"
                self._note(f"{self._file}: {name}: {keyword} {' '.join(words)} is not executed")
        elif self._item is not None:
            _detail(self._item, keyword, words)

    def _read_item(self, kinds: set[str], words: list[str], is_command: bool) -> Item | None:
        rest = list(words)
        name = next_word(rest, "a name").upper()
        start = self._end if "APPEND" in kinds else whole_number(next_word(rest, "a bit offset"))
        bits = whole_number(next_word(rest, "a number of bits"))
        kind = kind_of_item(rest)
        if kind == DERIVED:
            return None
        item = Item(name, kind, start, bits, self._big_endian)
        if bits < 0 or start < 0:
            raise UsageError("a place or size from the end of the packet is not supported; give it from the start")
        if "ARRAY" in kinds:
            item.count = max(whole_number(next_word(rest, "the bits of the array")) // max(bits, 1), 1)
            item.default = []
        elif is_command:
            self._read_range(item, rest)
        if "ID" in kinds or name in ("CCSDS_STREAMID", "CCSDS_FC"):
            value = item.default if is_command else whole_number(next_word(rest, "the value of the ID"))
            self._ids[item.start] = value
            item.default = value
        if rest:
            item.text = rest.pop(0)
        if rest and rest[0].upper() in ("BIG_ENDIAN", "LITTLE_ENDIAN"):
            item.big_endian = rest[0].upper() == "BIG_ENDIAN"
        self._end = max(self._end, item.end)
        return item

    def _read_range(self, item: Item, rest: list[str]) -> None:
        if item.kind in ("char", "block"):
            item.default = next_word(rest, "a default value")
            return
        low, high = next_word(rest, "a lowest value"), next_word(rest, "a highest value")
        item.low, item.high = _limit(low, item), _limit(high, item)
        item.default = _default(next_word(rest, "a default value"))


def _default(word: str) -> Any:
    try:
        return whole_number(word)
    except UsageError:
        try:
            return float(word)
        except ValueError:
            return word  # the name of a state


def _limit(word: str, item: Item) -> float:
    match = _LIMIT.fullmatch(word.upper())
    if match is None:
        return float(_default(word))
    kind = {"UINT": "u", "INT": "i", "FLOAT": "f"}.get(match[2] or "", item.kind)
    bits = int(match[3] or item.bits)
    if kind == "f":
        return float("-inf") if match[1] == "MIN" else float("inf")
    if match[1] == "MIN":
        return -(1 << (bits - 1)) if kind == "i" else 0
    return (1 << (bits - (kind == "i"))) - 1


def _detail(item: Item, keyword: str, words: list[str]) -> None:
    if keyword == "STATE" and len(words) > 1:
        if words[1].upper() != "ANY":
            item.states[words[0].upper()] = whole_number(words[1])
        if len(words) > 2 and words[2].upper() == "HAZARDOUS":
            item.hazardous[words[0].upper()] = words[3] if len(words) > 3 else "it is hazardous"
    elif keyword == "REQUIRED":
        item.required = True
    elif keyword == "UNITS" and words:
        item.units = words[-1]
    elif keyword == "FORMAT_STRING" and words:
        item.format = words[0]
    elif keyword == "POLY_READ_CONVERSION":
        item.polynomial = tuple(float(each) for each in words)
    elif keyword == "SEG_POLY_READ_CONVERSION" and len(words) > 1:
        item.segments.append((float(words[0]), tuple(float(each) for each in words[1:])))
        item.segments.sort(reverse=True)
    elif keyword == "LIMITS" and len(words) >= 7:
        item.limits[words[0].upper()] = tuple(float(each) for each in words[3:7])
    elif keyword == "DEFAULT_VALUE" and words:
        item.default = _default(words[0])
    elif keyword == "MINIMUM_VALUE" and words:
        item.low = float(words[0])
    elif keyword == "MAXIMUM_VALUE" and words:
        item.high = float(words[0])


def ruby_variables(folders: Iterable[Path]) -> dict[str, Any]:
    """Return the values that Ruby files assign to global variables, and the variables of a plugin.txt.

    Lines such as `$size = 64`, `$fields = ($rows + 7) / 8` and `VARIABLE name value` count. Indented assignments are in
    functions and conditions of Ruby, which are not executed.

    Args:
        folders: folders with `lib/*.rb` and `plugin.txt`.
    """
    found: dict[str, Any] = {}
    for folder in folders:
        for file in sorted((folder / "lib").glob("*.rb")):
            text = read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace")
            _assign(found, text, file)
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


def _assign(found: dict[str, Any], text: str, file: Path) -> None:
    """Add the values that a Ruby file assigns; values that need Ruby are left out.

    Args:
        found: values by name, of the files before, too.
        text: the file's text.
        file: the file.
    """
    for name, value in _ASSIGNED.findall(text):
        with suppress(UsageError):
            found[name] = Template(found).value(value, file)


def _constant(text: str) -> Any:
    if text in ("true", "false"):
        return text == "true"
    if text[:1] in "\"'":
        return text[1:-1]
    try:
        return int(text, 0)
    except ValueError:
        return text
