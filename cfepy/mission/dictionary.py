"""Every command and telemetry packet of a mission by name: the ground's dictionary.

Collected from the declarations (`cfepy.msg.Command` and `Telemetry`) of the five services and of the applications that
the startup script names; an application's module is executed for that, but not started. ROS topics are telemetry too:
those that the mission file names are known from the start, with what they carry as soon as a mission runs.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterable
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any, NamedTuple

from cfepy import msg
from cfepy.mission.declared import declared
from cfepy.mission.msg_names import CORE_SERVICES
from cfepy.mission.spec import MissionSpec
from cfepy.mission.topics import Topic
from cfepy.mission.values import int_of
from cfepy.msg import CMD_HEADER_SIZE, TLM_HEADER_SIZE, Command, Telemetry
from cfepy.status import CfeError, UsageError

DECLARATIONS = ("COMMANDS", "TELEMETRY")


class Decoded(NamedTuple):
    """A packet that was read.

    `time_s` is the time in its header in s; None for a command. `problem` says why `values` is empty though there is a
    payload.
    """

    name: str
    msg_id: int
    sequence: int
    time_s: float | None
    values: dict[str, Any]
    problem: str = ""


@dataclass(slots=True)
class Dictionary:
    """Commands and telemetry by name. `problems` says, a line each, what could not be read."""

    commands: dict[str, Command] = field(default_factory=dict)
    telemetry: dict[str, Telemetry | Topic] = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)
    _by_id: dict[int, Telemetry | Topic] = field(default_factory=dict)
    _by_code: dict[tuple[int, int], Command] = field(default_factory=dict)

    def add(self, declarations: Iterable[Command | Telemetry | Topic]) -> None:
        """Take declarations in; the first one of a name or MsgId stays."""
        for each in declarations:
            if isinstance(each, Command):
                self.commands.setdefault(each.name, each)
                self._by_code.setdefault((each.msg_id, each.code or 0), each)
            else:
                self.telemetry.setdefault(each.name, each)
                self._by_id.setdefault(each.msg_id, each)

    def learn(self, topics: Iterable[Topic]) -> None:
        """Take in what a running mission knows of its topics; a packet that an application declares stays as it is."""
        for topic in topics:
            self.telemetry[topic.name] = topic
            if not isinstance(self._by_id.get(topic.msg_id), Telemetry):
                self._by_id[topic.msg_id] = topic

    def command(self, name: str) -> Command:
        """A command by its name.

        Raises:
            UsageError: there is none; the text names those that are like it.
        """
        if name not in self.commands:
            raise self._unknown("command", name, self.commands)
        return self.commands[name]

    def telemetry_of(self, name: str) -> Telemetry | Topic:
        """A telemetry packet by its name or MsgId ("0x0800", "2048"); one whose MsgId alone is known has no fields.

        Raises:
            UsageError: there is none of that name.
        """
        if name in self.telemetry:
            return self.telemetry[name]
        try:
            msg_id = int_of(name)
        except ValueError:
            raise self._unknown("telemetry packet", name, self.telemetry) from None
        return self._by_id.get(msg_id) or Telemetry(f"0x{msg_id:04X}", msg_id)

    def decode(self, packet: bytes) -> Decoded:
        """Name and fields of a packet: telemetry, or a command.

        Raises:
            CfeError: CFE_MSG_BAD_ARGUMENT when it has no primary header.
        """
        msg_id, header = msg.get_msg_id(packet), msg.get_header_size(packet)
        decoded = Decoded(f"0x{msg_id:04X}", msg_id, msg.get_sequence_count(packet), None, {})
        if len(packet) < header:
            return decoded._replace(problem=f"{len(packet)} bytes are too few for a header of {header}")
        version = msg.get_header_version(packet)
        if version != 0:
            return decoded._replace(problem=f"its header has the version {version}, not 0")
        if header == TLM_HEADER_SIZE:
            seconds, subseconds = msg.get_msg_time(packet)
            return _read(self._by_id.get(msg_id), packet, decoded._replace(time_s=seconds + subseconds / 2**32))
        code = msg.get_fcn_code(packet) if header == CMD_HEADER_SIZE else 0
        return _read(self._by_code.get((msg_id, code)), packet, decoded._replace(name=f"{decoded.name}/{code}"))

    def _unknown(self, what: str, name: str, known: Iterable[str]) -> UsageError:
        names = list(known)
        upper = {each.upper(): each for each in names}
        near = [upper[each] for each in get_close_matches(name.upper(), upper, 3)]
        hint = f"; is {' or '.join(near)} meant?" if near else ""
        unread = "".join(f"; {problem}" for problem in self.problems)
        return UsageError(f"no {what} is called {name}{hint}{unread}")


def _read(entry: Command | Telemetry | Topic | None, packet: bytes, decoded: Decoded) -> Decoded:
    if entry is None:
        return decoded._replace(problem="its layout is not known")
    try:
        return decoded._replace(name=entry.name, values=entry.read(packet))
    except (CfeError, UsageError) as error:
        return decoded._replace(name=entry.name, problem=str(error))


def dictionary_of(spec: MissionSpec | None) -> Dictionary:
    """The dictionary of a mission.

    Args:
        spec: the mission; None takes the services and every application that cfepy brings along.
    """
    found = Dictionary()
    for service in CORE_SERVICES:
        packets = importlib.import_module(f"cfepy.{service.lower()}.packets")
        found.add([*packets.COMMANDS, *packets.TELEMETRY])
    found.add(declared(spec, DECLARATIONS, found.problems))
    if spec is not None:
        found.add(Topic(topic.name, topic.msg_id, raw=topic.raw) for topic in spec.ros.topics.values())
    return found
