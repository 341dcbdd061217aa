"""A mission's packets in XTCE 1.2 (CCSDS 660.1-G-2), the XML in which ground systems learn what telemetry means.

One container for each packet, below those for the CCSDS primary header and cFE's telemetry header, told apart by APID.
Nested structs and arrays are laid flat, padding is there as binary parameters. Names are the dictionary's, with "_"
where XTCE forbids a character: CFE_EVS_HK_TLM_AppData_0_AppID.
"""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree.ElementTree import Element, indent, tostring

from cfepy import __version__
from cfepy.mission.dictionary import Dictionary
from cfepy.mission.topics import Topic
from cfepy.mission.xtce_commands import add_commands
from cfepy.mission.xtce_names import cells_with_padding, xtce_name
from cfepy.mission.xtce_topics import topic_parts
from cfepy.mission.xtce_types import TypeSet, add
from cfepy.msg import Telemetry

NAMESPACE = "http://www.omg.org/spec/XTCE/20180204"
SCHEMA = f"{NAMESPACE} {NAMESPACE}/SpaceSystem.xsd"
ROOT, TELEMETRY = "CCSDSPacket", "CCSDSTelemetry"
APID_MASK = 0x7FF
WHOLE = "3"  # sequence flags of a packet that is not segmented

PRIMARY_HEADER = (
    ("VERSION", 3),
    ("TYPE", 1),
    ("SEC_HDR_FLG", 1),
    ("PKT_APID", 11),
    ("SEQ_FLGS", 2),
    ("SRC_SEQ_CTR", 14),
    ("PKT_LEN", 16),
)
"""Names that CCSDS tools in Python expect, and bits."""


def xtce_of(name: str, dictionary: Dictionary) -> str:
    """The XTCE document of a mission.

    Args:
        name: of the space system.
        dictionary: its packets; topics of a type that is not known are left out.
    """
    system = Element("SpaceSystem", {"name": xtce_name(name), "xmlns": NAMESPACE})
    system.set("xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance")
    system.set("xsi:schemaLocation", SCHEMA)
    add(system, "Header", version=__version__, validationStatus="Working")
    _Telemetry(add(system, "TelemetryMetaData")).add_packets(dictionary.telemetry.values())
    add_commands(add(system, "CommandMetaData"), dictionary.commands.values())
    indent(system)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(system, encoding="unicode") + "\n"


class _Telemetry:
    """TelemetryMetaData while it is filled."""

    def __init__(self, parent: Element) -> None:
        self._types = TypeSet(parent, "Parameter")
        self._parameters = add(parent, "ParameterSet")
        self._containers = add(parent, "ContainerSet")
        self._names: set[str] = set()
        self._add_headers()

    def _add_headers(self) -> None:
        entries = self._container(ROOT, "the CCSDS primary header", is_abstract=True)
        for name, bits in PRIMARY_HEADER:
            self._entry(entries, name, self._types.bits(bits))
        entries = self._container(TELEMETRY, "cFE's telemetry header", is_abstract=True)
        self._entry(entries, "TIME", self._types.time())
        self._padding(entries, 4)
        self._base(ROOT, TYPE="0", SEC_HDR_FLG="1")

    def add_packets(self, packets: Iterable[Telemetry | Topic]) -> None:
        """Add a container for each packet."""
        taken: set[int] = set()
        for packet in sorted(packets, key=lambda each: (each.msg_id, isinstance(each, Topic))):
            known = isinstance(packet, Telemetry) or (packet.type and not packet.raw)
            if known and packet.msg_id not in taken:
                taken.add(packet.msg_id)
                self._add(packet)

    def _add(self, packet: Telemetry | Topic) -> None:
        name = self._unique(xtce_name(packet.name))
        entries = self._container(name, packet.text)
        apid = str(packet.msg_id & APID_MASK)
        if isinstance(packet, Topic):
            for part in topic_parts(packet, self._types, lambda path: f"{name}_{xtce_name(path)}"):
                self._entry(entries, part.name, part.type)
            self._base(TELEMETRY, PKT_APID=apid, SEQ_FLGS=WHOLE)
            return
        for cell in cells_with_padding(packet.payload):
            if cell.type == "padding":
                self._padding(entries, cell.size)
            else:
                text = cell.type.startswith("char")
                kind = self._types.text(cell.size) if text else self._types.number(cell.type)
                self._entry(entries, self._unique(f"{name}_{xtce_name(cell.path)}"), kind)
        self._base(TELEMETRY, PKT_APID=apid)

    def _unique(self, name: str) -> str:
        """The name, with underscores behind it as long as another one is the same."""
        while name in self._names:
            name += "_"
        self._names.add(name)
        return name

    def _container(self, name: str, text: str, is_abstract: bool = False) -> Element:
        abstract = "true" if is_abstract else ""
        self._current = add(self._containers, "SequenceContainer", name=name, shortDescription=text, abstract=abstract)
        return add(self._current, "EntryList")

    def _base(self, container: str, **conditions: str) -> None:
        """What the current container builds on, and which values tell it apart."""
        criteria = add(add(self._current, "BaseContainer", containerRef=container), "RestrictionCriteria")
        comparisons = add(criteria, "ComparisonList")
        for name, value in conditions.items():
            add(comparisons, "Comparison", parameterRef=name, value=value)

    def _entry(self, entries: Element, name: str, kind: str) -> None:
        add(self._parameters, "Parameter", name=name, parameterTypeRef=kind)
        add(entries, "ParameterRefEntry", parameterRef=name)

    def _padding(self, entries: Element, size: int) -> None:
        """Padding of each size is one parameter for all packets."""
        kind = self._types.padding(size)
        if kind not in self._names:
            self._names.add(kind)
            add(self._parameters, "Parameter", name=kind, parameterTypeRef=kind)
        add(entries, "ParameterRefEntry", parameterRef=kind)
