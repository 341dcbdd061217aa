"""A Python module that declares the packets and tables of a mission, for `cfepy.msg` and all ground tools."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from cfepy.ground import Dictionary
from cfepy.mission import MissionSpec
from cfepy.msg import TLM_HEADER_SIZE, BitLayout, Command, FieldPlace, Layout, Measurement, Telemetry, ValueNames

_HEAD = '''"""Packets of the mission {name}, written by `cfepy export python`."""

from cfepy.msg import BitLayout, Command, Layout, Measurement, FieldPlace, Telemetry, ValueNames

'''


def python_text(spec: MissionSpec, dictionary: Dictionary) -> str:
    """Return the text of a module.

    Args:
        spec: the mission.
        dictionary: its packets; topics of ROS are left out.
    """
    writer = _Writer()
    commands = sorted(dictionary.commands.values(), key=lambda each: (each.msg_id, each.code or 0, each.name))
    found = [each for each in dictionary.telemetry.values() if isinstance(each, Telemetry)]
    declared = [writer.packet("Command", each) for each in commands]
    packets = [writer.packet("Telemetry", each) for each in sorted(found, key=lambda each: (each.msg_id, each.name))]
    lists = _listed("COMMANDS", declared) + _listed("TELEMETRY", packets)
    return _HEAD.format(name=spec.name.replace('"', "'")) + "".join(writer.layouts) + lists


def _listed(name: str, items: Iterable[str]) -> str:
    return f"\n{name} = (\n" + "".join(f"    {each},\n" for each in items) + ")\n"


class _Writer:
    """Writes each layout once, before the packets that use it."""

    def __init__(self) -> None:
        self.layouts: list[str] = []
        self._names: dict[str, str] = {}
        self._taken: set[str] = set()

    def packet(self, kind: str, packet: Command | Telemetry) -> str:
        """Return the expression of a packet."""
        words = [repr(packet.name), f"0x{packet.msg_id:04X}"]
        if isinstance(packet, Command):
            words.append(f"code={packet.code!r}")
        if packet.payload.fields:
            words.append(f"payload={self._layout(packet.payload)}")
        if packet.text:
            words.append(f"text={packet.text!r}")
        if isinstance(packet, Telemetry) and packet.header_size != TLM_HEADER_SIZE:
            words.append(f"header_size={packet.header_size}")
        return f"{kind}({', '.join(words)})"

    def _layout(self, layout: Layout) -> str:
        """Return the name of a layout's variable."""
        if isinstance(layout, BitLayout):
            places = "".join(f"        {_place(each)},\n" for each in layout.places)
            text = f"BitLayout(\n    {layout.name!r},\n    [\n{places}    ],\n    {layout.size},\n)"
        else:
            fields = "".join(f"        ({name!r}, {self._type(kind)}),\n" for name, kind in layout.types())
            options = ", packed=True" if layout.is_packed else ", on_the_wire=True" if layout.on_the_wire else ""
            text = f"Layout(\n    {layout.name!r},\n    [\n{fields}    ]{options},\n)"
        if text not in self._names:
            variable = self._variable(layout.name)
            self._names[text] = variable
            self.layouts.append(f"{variable} = {text}\n")
        return self._names[text]

    def _type(self, kind: object) -> str:
        if isinstance(kind, Layout):
            return self._layout(kind)
        if isinstance(kind, tuple):
            return f"({self._type(kind[0])}, {kind[1]})"
        if isinstance(kind, ValueNames):
            return _names(kind)
        return _measurement(kind) if isinstance(kind, Measurement) else repr(kind)

    def _variable(self, name: str) -> str:
        variable = re.sub(r"\W", "_", name).strip("_").upper() or "LAYOUT"
        while variable in self._taken:
            variable += "_"
        self._taken.add(variable)
        return variable


def _place(place: FieldPlace) -> str:
    words = []
    for name, value in zip(FieldPlace._fields, place, strict=True):
        if value is None:
            continue
        shown = _names(value) if isinstance(value, ValueNames) else value
        shown = _measurement(value) if isinstance(value, Measurement) else shown
        words.append(f"{name}={shown if shown is not value else repr(value)}")
    return f"FieldPlace({', '.join(words)})"


def _names(names: ValueNames) -> str:
    if names.flags:
        return f"ValueNames({names.type!r}, flags=True, **{dict(names.values)!r})"
    return f"ValueNames.of({names.type!r}, {dict(names.values)!r})"


def _measurement(measured: Measurement) -> str:
    return "Measurement(" + ", ".join(_given(measured)) + ")"


def _given(measured: Measurement) -> Iterator[str]:
    yield repr(measured.type)
    for name in ("unit", "polynomial", "points", "yellow", "red"):
        value = getattr(measured, name)
        if value:
            yield f"{name}={value!r}"
