"""Every command, telemetry packet and table of a mission by name, as declared by its services and applications.

Commands and telemetry are collected from the declarations (`cfepy.msg.Command` and `Telemetry`) of the five services
and of the applications in the startup script, tables from their `TABLES`. An application's module is executed for that,
but not started; one without declarations is not executed, and a ROS node never is. ROS topics are telemetry too: those
in the mission file are known from the start, their message types once a mission runs.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, NamedTuple

from cfepy import msg, tbl
from cfepy.es import NODE_SYMBOL
from cfepy.fs import HEADER_SIZE, TABLE_HEADER_SIZE
from cfepy.ground.mission_names import CORE_PACKETS, foreign_declarations
from cfepy.ground.topics import Topic
from cfepy.ground.values import flat, int_of, line_of, measured_fields, texts_of, violations_of
from cfepy.mission import MissionSpec, read_mission
from cfepy.mission import app_sources as sources
from cfepy.mission.python_code import ModuleNames, execute, find_declarations
from cfepy.msg import CMD_HEADER_SIZE, TLM_HEADER_SIZE, Command, Layout, Telemetry
from cfepy.reading.contained_files import is_contained
from cfepy.reading.input_files import open_input
from cfepy.reading.resources import shipped
from cfepy.reading.suggestions import did_you_mean, expected, known_as, listed
from cfepy.status import CfeError, UsageError
from cfepy.tbl import TableType

DECLARATIONS = ("COMMANDS", "TELEMETRY")
TABLES = "TABLES"
CF = "/cf/"
_WILD = re.compile(r"[*?[]")
ROS_PACKETS = "rospy_shim.parameters.table"
"""Code in which the application ROS declares its packets, as found by a loader."""


class Decoded(NamedTuple):
    """A decoded packet.

    Attributes:
        time_s: time in its header, in s; None for a command.
        problem: why `values` is empty although the packet has a payload.
    """

    name: str
    msg_id: int
    sequence: int
    time_s: float | None
    values: dict[str, Any]
    problem: str = ""
    layout: Layout | None = None

    def line(self, raw: bool = False) -> str:
        """Return its values on one line, with the names of enumeration values, and with engineering values and marks
        for violated limits unless `raw`.
        """
        return line_of(self.values, self.layout, raw)

    def texts(self, raw: bool = False) -> dict[str, str]:
        """As `line`, by path."""
        return texts_of(self.values, self.layout, raw)

    @property
    def violations(self) -> dict[str, str]:
        """The limits that its fields violate, by path; see `cfepy.msg.Measurement`."""
        return violations_of(self.values, self.layout)

    @property
    def measurements(self) -> dict[str, dict[str, Any]]:
        """The engineering values of its fields, by path: value, unit and violated limit."""
        measured = {} if self.layout is None else measured_fields(self.layout)
        numbers = flat(self.values) if measured else {}
        found = {path: (each, each.value(numbers[path])) for path, each in measured.items() if path in numbers}
        return {
            path: {"value": value, "unit": each.unit, "violated": each.violated(value)}
            for path, (each, value) in found.items()
        }


@dataclass(slots=True)
class Dictionary:
    """Commands and telemetry by name. `problems` has a line for each declaration that could not be read."""

    commands: dict[str, Command] = field(default_factory=dict)
    telemetry: dict[str, Telemetry | Topic] = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)
    _by_id: dict[int, Telemetry | Topic] = field(default_factory=dict)
    _by_code: dict[tuple[int, int], Command] = field(default_factory=dict)

    def add(self, declarations: Iterable[Command | Telemetry | Topic]) -> None:
        """Add declarations; the first one of a name or MsgId stays."""
        for each in declarations:
            if isinstance(each, Command):
                self.commands.setdefault(each.name, each)
                self._by_code.setdefault((each.msg_id, each.code or 0), each)
            else:
                self.telemetry.setdefault(each.name, each)
                self._by_id.setdefault(each.msg_id, each)

    def knows(self, packet: Command | Telemetry) -> bool:
        """Return whether a packet of the same MsgId and function code is declared."""
        if isinstance(packet, Command):
            return (packet.msg_id, packet.code or 0) in self._by_code
        return isinstance(self._by_id.get(packet.msg_id), Telemetry)

    def add_from_table(self, kind: TableType, image: bytes | None) -> None:
        """Add the packets that depend on a table; a topic known by name from the mission file stays.

        Args:
            kind: type of the table.
            image: the whole table; None adds nothing.
        """
        if kind.telemetry is None or image is None:
            return
        known = {
            msg_id: each if isinstance(each, Telemetry) else Telemetry(each.name, msg_id)
            for msg_id, each in self._by_id.items()
        }
        for each in kind.telemetry(image, known):
            self.telemetry.setdefault(each.name, each)
            if not isinstance(self._by_id.get(each.msg_id), Telemetry):
                self._by_id[each.msg_id] = each

    def learn(self, topics: Iterable[Topic]) -> None:
        """Add the topics that a running mission knows; a packet declared by an application stays."""
        for topic in topics:
            self.telemetry[topic.name] = topic
            if not isinstance(self._by_id.get(topic.msg_id), Telemetry):
                self._by_id[topic.msg_id] = topic

    def command(self, name: str) -> Command:
        """Return a command by its name, which may be in small letters.

        Raises:
            UsageError: if there is none; the text names similar ones.
        """
        name = name if name in self.commands else known_as(name, self.commands)
        if name not in self.commands:
            raise self._unknown("command", name, self.commands)
        return self.commands[name]

    def telemetry_of(self, name: str) -> Telemetry | Topic:
        """Return a telemetry packet by its name or MsgId ("0x0800", "2048"); one known only by MsgId has no fields.

        Args:
            name: the name, which may be in small letters.

        Raises:
            UsageError: if there is none of that name.
        """
        name = name if name in self.telemetry else known_as(name, self.telemetry)
        if name in self.telemetry:
            return self.telemetry[name]
        try:
            msg_id = int_of(name)
        except ValueError:
            raise self._unknown("telemetry packet", name, self.telemetry) from None
        return self._by_id.get(msg_id) or Telemetry(f"0x{msg_id:04X}", msg_id)

    def telemetry_like(self, pattern: str) -> list[int]:
        """Return the MsgIds of the telemetry packets that a word names: a name, a MsgId, or a pattern such as `CFE_*`.

        Raises:
            UsageError: if there is none.
        """
        if not _WILD.search(pattern):
            return [self.telemetry_of(pattern).msg_id]
        found = [packet.msg_id for name, packet in self.telemetry.items() if fnmatchcase(name, pattern.upper())]
        if not found:
            raise self._unknown("telemetry packet", pattern, self.telemetry)
        return found

    def decode(self, packet: bytes) -> Decoded:
        """Return name and fields of a packet: telemetry, or a command.

        Raises:
            CfeError: CFE_MSG_BAD_ARGUMENT if it has no primary header.
        """
        msg_id, header = msg.get_msg_id(packet), msg.get_header_size(packet)
        decoded = Decoded(f"0x{msg_id:04X}", msg_id, msg.get_sequence_count(packet), None, {})
        known = self._by_id.get(msg_id)
        if isinstance(known, Telemetry) and header == TLM_HEADER_SIZE:
            header = known.header_size
        if len(packet) < header:
            return decoded._replace(problem=f"{len(packet)} bytes are too few for a header of {header}")
        version = msg.get_header_version(packet)
        if version != 0:
            return decoded._replace(problem=f"its header has the version {version}, not 0")
        if msg.get_header_size(packet) == TLM_HEADER_SIZE:
            seconds, subseconds = msg.get_msg_time(packet)
            found = known.variant_of(packet) if isinstance(known, Telemetry) else known
            return _read(found, packet, decoded._replace(time_s=seconds + subseconds / 2**32))
        code = msg.get_fcn_code(packet) if header == CMD_HEADER_SIZE else 0
        return _read(self._by_code.get((msg_id, code)), packet, decoded._replace(name=f"{decoded.name}/{code}"))

    def declared_as(self, packet: bytes) -> Command | Telemetry | None:
        """Return the declaration of a packet, by its MsgId and function code; None for ROS messages and unknown
        packets.
        """
        msg_id, header = msg.get_msg_id(packet), msg.get_header_size(packet)
        if header == TLM_HEADER_SIZE:
            found = self._by_id.get(msg_id)
            return found.variant_of(packet) if isinstance(found, Telemetry) else None
        return self._by_code.get((msg_id, msg.get_fcn_code(packet))) if len(packet) >= header else None

    def fields_of(self, packet: bytes) -> dict[str, Any]:
        """Return the fields of a packet; one without declared layout has only `data`, the bytes after the header.

        Raises:
            UsageError: if it is not such a packet.
        """
        decoded = self.decode(packet)
        if not decoded.problem:
            return decoded.values
        if decoded.name in self.telemetry or decoded.name in self.commands:
            raise UsageError(f"{decoded.name}: {decoded.problem}")
        return {"data": packet[msg.get_header_size(packet) :]}

    def _unknown(self, what: str, name: str, known: Iterable[str]) -> UsageError:
        unread = "".join(f"; {problem}" for problem in self.problems)
        hint = did_you_mean(name, known, f"expected {listed(known)}", most=3)
        return UsageError(f"unknown {what} {name}; {hint}{unread}")


def _read(entry: Command | Telemetry | Topic | None, packet: bytes, decoded: Decoded) -> Decoded:
    if entry is None:
        return decoded._replace(problem="its layout is not known")
    try:
        layout = None if isinstance(entry, Topic) else entry.payload
        return decoded._replace(name=entry.name, values=entry.read(packet), layout=layout)
    except (CfeError, UsageError) as error:
        return decoded._replace(name=entry.name, problem=str(error))


def dictionary_of(spec: MissionSpec | None) -> Dictionary:
    """Return the dictionary of a mission.

    Args:
        spec: the mission; None for the services and all applications included in cfepy.
    """
    found = Dictionary()
    for packets in CORE_PACKETS.values():
        found.add([*packets.COMMANDS, *packets.TELEMETRY])
    tables: list[tuple[MissionSpec, TableType]] = []
    without_fields: list[Command | Telemetry] = []
    for each in (spec, *(() if spec is None else spec.beside)):
        items = declared(each, (*DECLARATIONS, TABLES), found.problems)
        found.add(item for item in items if not isinstance(item, TableType))
        if each is not None:
            for foreign in foreign_declarations(each):
                found.problems += foreign.problems
                new = [packet for packet in foreign.packets if not found.knows(packet)]
                found.add(packet for packet in new if packet.payload.size)
                without_fields += [packet for packet in new if not packet.payload.size]
            tables += [(each, kind) for kind in items if isinstance(kind, TableType) and kind.telemetry is not None]
    if spec is not None:
        found.add(Topic(topic.name, topic.msg_id, raw=topic.raw) for topic in spec.ros.topics.values())
    for owner, kind in tables:
        found.add_from_table(kind, _default_image(owner, kind, found.problems))
    found.add(packet for packet in without_fields if not found.knows(packet))  # a table may tell their fields
    return found


def _default_image(spec: MissionSpec, kind: TableType, problems: list[str]) -> bytes | None:
    """Return the image of a table as a mission first loads it, from a file in its folder or of its application."""
    name = kind.file.removeprefix(CF)
    if name == kind.file or not is_contained(f"/{name}"):
        return None
    packages = [code.parent for _, code in _codes(spec) if isinstance(code, Path)]
    places = [spec.folder / name, *(package / "tables" / name for package in packages)]
    file = next((place for place in places if place.is_file()), None)
    if file is None:
        return None
    try:
        with open_input(file) as opened:
            image = tbl.read(opened.read(HEADER_SIZE + TABLE_HEADER_SIZE + kind.size))
    except (CfeError, OSError) as error:
        problems.append(f"{file} is not a table file: {error}")
        return None
    return (bytes(image.offset) + image.data)[: kind.size].ljust(kind.size, b"\0")


def declared(spec: MissionSpec | None, attributes: Sequence[str], problems: list[str]) -> list[Any]:
    """Return everything that the apps and libraries of a mission declare.

    Args:
        spec: the mission; None for all apps included in cfepy.
        attributes: names of the tuples, such as "TABLES".
        problems: receives a line for each app that could not be executed.
    """
    found: list[Any] = []
    names = ModuleNames()
    try:
        for file, code in _codes(spec):
            found += _of_app(file, code, attributes, names, problems)
    finally:
        names.forget()
    return found


def struct_layout(mission: str | None, name: str) -> Layout | None:
    """Return a struct of a mission's applications by its name in C; None if no file declares it.

    Args:
        mission: as for `read_mission`, or None.
        name: such as "HS_AMTEntry_t".
    """
    spec = None if mission is None else read_mission(mission)
    found = (each.layout(name) for each in foreign_declarations(spec)) if spec is not None else ()
    return next((layout for layout in found if layout is not None), None)


def table_types(mission: str | None, problems: list[str]) -> dict[str, TableType]:
    """Return the known tables by full name, with tables of a mission before tables of the apps included in cfepy.

    Args:
        mission: as for `read_mission`, or None.
        problems: receives a line for each app that could not be executed.

    Raises:
        UsageError: if there is no such mission.
    """
    found = {kind.name: kind for kind in declared(None, ("TABLES",), problems)}
    if mission is None:
        return found
    spec = read_mission(mission)
    for foreign in foreign_declarations(spec):
        found = {kind.name: kind for kind in foreign.tables} | found
        problems += foreign.problems
    return found | {kind.name: kind for kind in declared(spec, ("TABLES",), problems)}


def table_type(name: str, mission: str | None) -> TableType:
    """Return the declaration of a table, by its full name, or by its own name if that is unique.

    Args:
        name: such as "HK.CopyTable", or "CopyTable".
        mission: mission whose applications declare it, as for `table_types`.

    Raises:
        UsageError: if there is none, or there are several of that name.
    """
    problems: list[str] = []
    known = table_types(mission, problems)
    if name in known:
        return known[name]
    found = [kind for kind in known.values() if kind.own_name == name]
    if len(found) == 1:
        return found[0]
    several = f"did you mean {' or '.join(kind.name for kind in found)}?"
    which = several if found else expected(name, sorted(known), subject="known tables are", last="and")
    raise UsageError("; ".join([f"unknown table {name!r}", which, *problems]))


def _codes(spec: MissionSpec | None) -> Iterator[tuple[str, Path | str]]:
    """Return (name, code) of apps and libraries, each once."""
    if spec is None:
        for package in sorted(shipped("apps").glob("*/__init__.py")):
            yield package.parent.name, package
        yield ROS_PACKETS, ROS_PACKETS
        return
    files = dict.fromkeys(entry.path for entry in spec.entries if entry.symbol != NODE_SYMBOL)
    for file in files:
        code = find_declarations(file, spec.folder)
        if code is not None:
            yield file, code
    if spec.has_nodes:
        yield ROS_PACKETS, ROS_PACKETS


def _of_app(
    file: str, code: Path | str, attributes: Sequence[str], names: ModuleNames, problems: list[str]
) -> list[Any]:
    source = sources.source_of(code)
    if source is None or not any(sources.defines(source, name) for name in attributes):
        return []
    try:
        module = execute(code, names.new(file))
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # includes sys.exit(): the code belongs to the mission and may do anything
        from cfepy.mission import described

        problems.append(f"{source} could not be read: {described(error)}")
        return []
    values = (getattr(module, name, ()) for name in attributes)
    # others have another meaning
    return [item for value in values if isinstance(value, tuple | list) for item in value]
