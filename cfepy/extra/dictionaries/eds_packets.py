"""Commands, telemetry and tables of electronic data sheets, as NASA's EdsLib finds them.

A component of a package requires interfaces of the Software Bus: `CFE_SB/Telecommand`, `CFE_SB/Telemetry`, and
`CFE_TBL/Table`. Each names the type of its packets, and a topic. The commands of an interface are the containers
derived from that type with a function code.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from importlib.resources import as_file, files
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.dictionaries.design_parameters import DesignParameters
from cfepy.extra.dictionaries.eds_defaults import DEFAULTS
from cfepy.extra.dictionaries.eds_types import EdsTypes, c_name
from cfepy.extra.dictionaries.nasa_names import command_name, packet_name
from cfepy.extra.dictionaries.packets import DeclaredPacket, DeclaredTable, SourceContent
from cfepy.extra.dictionaries.placed_types import Array, Struct, Type, lines_of, memory_layout, without_wrapper
from cfepy.extra.dictionaries.xml_tags import XmlTag, read_document
from cfepy.msg import Layout
from cfepy.status import UsageError

COMMANDS, TELEMETRY, TABLES = "CFE_SB/Telecommand", "CFE_SB/Telemetry", "CFE_TBL/Table"
_TABLE = re.compile(r"Table|Tbl", re.IGNORECASE)
_CODE = "Sec.FunctionCode"
_HEADERS = {COMMANDS: "CFE_HDR/CommandHeader", TELEMETRY: "CFE_HDR/TelemetryHeader"}
_BITS = {COMMANDS: 0x1800, TELEMETRY: 0x0800}
_GLOBAL_BITS = 0x60
_RANGES = {
    COMMANDS: (("TELECOMMAND", 0), ("GLOBAL_CMD", _GLOBAL_BITS)),
    TELEMETRY: (("TELEMETRY", 0), ("GLOBAL_TLM", _GLOBAL_BITS)),
}
ROOTS = ("PackageFile", "DesignParameters")
"""The outermost tags of electronic data sheets."""


class Interface(NamedTuple):
    """An interface of a component: its tag, its package, `COMMANDS`, `TELEMETRY` or `TABLES`, and the tags of its
    parameters by name.
    """

    tag: XmlTag
    package: str
    kind: str
    parameters: dict[str, XmlTag]


class DataSheets:
    """All electronic data sheets of a mission.

    Args:
        roots: the outermost tags of the files.
    """

    def __init__(self, roots: Iterable[XmlTag]) -> None:
        self.parameters = DesignParameters(DEFAULTS)
        self.types = EdsTypes(self.parameters)
        self._content = SourceContent("EDS")
        packages: list[XmlTag] = []
        for root in roots:
            if root.name == "DesignParameters":
                self._attempt(root, self.parameters.read)
            else:
                packages += root.all("Package")
        known = {each.attributes.get("name") for each in packages}
        packages += [each for each in _base_packages() if each.attributes["name"] not in known]
        for package in packages:
            self._attempt(package, self.types.read)
        self.types.link()
        self.packages = packages

    def content(self) -> SourceContent:
        """Return the packets and tables of all components."""
        for interface in self._interfaces():
            try:
                self._add(interface, self._content)
            except UsageError as error:
                self._content.add_problem(error, interface.tag.file)
        self._content.layout = self._layout
        self._content.tables += self._tables_by_name()
        return self._content

    def _layout(self, name: str) -> Layout | None:
        """Return a struct by the name that it has in C, such as "HS_AMTEntry_t"; None if there is none."""
        full = next((each for each in self.types.names() if c_name(each) == name), None)
        try:
            found = None if full is None else self.types.type(full)
        except UsageError:  # a packet or a table with the type has reported it
            return None
        return memory_layout(found) if isinstance(found, Struct) else None

    def _tables_by_name(self) -> Iterator[DeclaredTable]:
        """Yield types with the names of tables that no interface offers: HS/AppMon_Tbl is HS.AppMon_Tbl."""
        known = {each.name for each in self._content.tables}
        for full in self.types.names():
            name = full.replace("/", ".")
            if name in known or not _TABLE.search(full):
                continue
            try:
                table = self._table(name, full, self.types.tag(full).attributes.get("shortDescription", ""))
            except UsageError:  # as in `_layout`
                continue
            if table is not None:
                yield table

    def _attempt(self, tag: XmlTag, read: Callable[[XmlTag], None]) -> None:
        try:
            read(tag)
        except UsageError as error:
            self._content.add_problem(error, tag.file)

    def _interfaces(self) -> Iterator[Interface]:
        for package in self.packages:
            name = package.attributes.get("name", "")
            for component in package.inside("ComponentSet", "Component"):
                variables = {
                    each.attributes.get("name", ""): each
                    for each in component.inside("Implementation", "VariableSet", "Variable")
                }
                maps = list(component.inside("Implementation", "ParameterMapSet", "ParameterMap"))
                for tag in component.inside("RequiredInterfaceSet", "Interface"):
                    kind = tag.attributes.get("type", "")
                    if kind in (COMMANDS, TELEMETRY, TABLES):
                        mine = [each for each in maps if each.attributes.get("interface") == tag.attributes.get("name")]
                        found = {
                            each.attributes.get("parameter", ""): variables[each.attributes.get("variableRef", "")]
                            for each in mine
                            if each.attributes.get("variableRef", "") in variables
                        }
                        yield Interface(tag, name, kind, found)

    def _add(self, interface: Interface, content: SourceContent) -> None:
        generic = next(iter(interface.tag.inside("GenericTypeMapSet", "GenericTypeMap")), None)
        if generic is None:
            raise interface.tag.fail("missing <GenericTypeMap>; add it with the type of its packets")
        full = self.types.find(self.parameters.text(generic, "type"), interface.package, generic)
        if interface.kind == TABLES:
            self._add_table(interface, full, content)
            return
        msg_id = self._msg_id(interface)
        name = packet_name(interface.package, interface.tag.need("name"))
        content.names.setdefault(msg_id, name)
        if interface.kind == TELEMETRY:
            content.packets.append(self._packet(interface, full, name, msg_id))
            return
        derived = list(self._commands_of(full))
        for each, code in derived:
            own = command_name(interface.package, each.partition("/")[2])
            try:
                content.packets.append(self._packet(interface, each, own, msg_id, code))
            except UsageError as error:
                content.add_problem(error, interface.tag.file)
        if not derived:
            content.packets.append(self._packet(interface, full, name, msg_id))

    def _commands_of(self, base: str) -> Iterator[tuple[str, int]]:
        """Yield the containers that are derived from a container with a function code, and their codes."""
        for name in self.types.derived_from(base):
            code = self.types.constraints(name).get(_CODE)
            if code is None:
                yield from self._commands_of(name)
                continue
            tag = self.types.tag(name)
            try:
                number = int(code, 0)
            except ValueError:
                raise tag.fail(f"the function code must be a number, not {code!r}") from None
            yield name, number

    def _packet(
        self, interface: Interface, full: str, name: str, msg_id: int, code: int | None = None
    ) -> DeclaredPacket:
        whole = self.types.type(full)
        tag = self.types.tag(full)
        header = self._header_of(full, _HEADERS[interface.kind])
        if header is None or not isinstance(whole, Struct):
            raise tag.fail(f"must be derived from {_HEADERS[interface.kind]}; correct its baseType")
        payload = without_wrapper(Struct(whole.name, whole.fields[len(header.fields) :]))
        text = tag.attributes.get("shortDescription", "") or interface.tag.attributes.get("shortDescription", "")
        structs = tuple(dict.fromkeys((whole.name, payload.name)))
        is_command = interface.kind == COMMANDS
        return DeclaredPacket(
            name,
            msg_id,
            memory_layout(payload),
            is_command,
            tag.file,
            tag.line,
            code,
            text,
            whole,
            lines_of(payload),
            structs,
        )

    def _header_of(self, full: str, header: str) -> Struct | None:
        """Return the header from which a container is derived, or None."""
        name: str | None = full
        while name is not None:
            if name == header:
                found = self.types.type(name)
                assert isinstance(found, Struct)
                return found
            name = self.types.base_of(name)
        return None

    def _msg_id(self, interface: Interface) -> int:
        if "TopicId" not in interface.parameters:
            raise interface.tag.fail("has no TopicId; add a <ParameterMap> with a <Variable> for it")
        variable = interface.parameters["TopicId"]
        topic = self.parameters.number(variable, "initialValue")
        for name, bits in _RANGES[interface.kind]:
            first, end = (self._number_of(f"CFE_MISSION/{name}_{word}_TOPICID") for word in ("BASE", "MAX"))
            if first <= topic < end:
                return _BITS[interface.kind] ^ bits ^ (topic - first)
        what = "commands" if interface.kind == COMMANDS else "telemetry"
        raise variable.fail(f"the topic {topic} is not one of {what}; correct the mission's cfe-topicids.xml")

    def _number_of(self, name: str) -> int:
        tag = XmlTag("Define", {"name": name, "value": f"${{{name}}}"}, Path(), 0)
        return self.parameters.number(tag, "value")

    def _add_table(self, interface: Interface, full: str, content: SourceContent) -> None:
        name = f"{interface.package}.{interface.tag.need('name')}"
        text = interface.tag.attributes.get("shortDescription", "")
        table = self._table(name, full, text)
        if table is not None:
            content.tables.append(table)

    def _table(self, name: str, full: str, text: str) -> DeclaredTable | None:
        """Return a table of a type; None if the type is not made of structs."""
        row, rows = _rows_of(self.types.type(full))
        tag = self.types.tag(full)
        if row is None:
            return None
        layout = memory_layout(row)
        return DeclaredTable(name, layout, rows, tag.file, tag.line, text, lines_of(row), (row.name,))


def _rows_of(kind: Type) -> tuple[Struct | None, int]:
    """Return the row of a table and the number of rows."""
    if isinstance(kind, Array):
        row, rows = _rows_of(kind.item)
        return row, rows * kind.length
    if not isinstance(kind, Struct):
        return None, 0
    only = kind.fields[0].type if len(kind.fields) == 1 else None
    if isinstance(only, Array) and isinstance(only.item, Struct):
        return only.item, only.length
    return kind, 1


def _base_packages() -> list[XmlTag]:
    with as_file(files("cfepy.extra.dictionaries") / "base_types.xml") as path:
        return list(read_document(path).all("Package"))
