"""The names of messages, fields and applications of a mission in a fault plan.

ROS topics have their own names, commands and telemetry have the names of the dictionary, and all can be given by MsgId.
An application with a node can be given by its cFE name or by the node's name.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

from cfepy import msg
from cfepy.ground import Dictionary, Topic, dictionary_of, library_of, names_of, topics_of
from cfepy.mission import Mission, MissionSpec
from cfepy.msg import Command, Telemetry
from cfepy.status import CfeError, UsageError

if TYPE_CHECKING:
    from rospy_shim.graph.graph import TopicEntry

_STEP = re.compile(r"[^.\[\]]+")


def matches(names: Sequence[str], targets: Sequence[str]) -> bool:
    """Return whether one of the names matches one of the targets, which may be patterns such as "/arm/*"."""
    return any(fnmatchcase(name, target) for target in targets for name in names)


def number_as_name(target: str) -> str:
    """Return a target in the form of packet names: "0x801" and "2049" become "0x0801"."""
    try:
        return f"0x{int(target, 0):04X}"
    except ValueError:
        return target


def apps_of_nodes(spec: MissionSpec) -> dict[str, str]:
    """Return cFE names of applications by the names of their nodes, as far as the mission file gives these."""
    named = ((node.app, node.namespace, node.name) for node in spec.ros.nodes.values() if node.name is not None)
    return {f"{namespace.rstrip('/')}/{name}": app for app, namespace, name in named}


class MissionNames:
    """Names of one mission's messages; applications are executed for them as by `cfepy cmd`."""

    def __init__(self) -> None:
        self._mission: Mission | None = None
        self._dictionary = Dictionary()
        self._constants: dict[int, str] = {}

    def begin(self, mission: Mission) -> None:
        """The mission was created, and nothing of it has run."""
        self._mission = mission
        self._dictionary = dictionary_of(mission.spec)
        self._constants = names_of(mission.spec)

    def version(self) -> object:
        """Value that changes when new names become known."""
        ros = None if self._mission is None else self._mission.ros
        return None if ros is None else (id(ros), len(ros.graph.topics))

    def of(self, packet: bytes | bytearray) -> Sequence[str]:
        """Return all names of a packet, the preferred one first; its MsgId as "0x0801" is one."""
        msg_id = packet[0] << 8 | packet[1]
        topic, entry = self._topic(msg_id), self._entry(packet)
        names = [each.name for each in (topic, entry) if each is not None]
        return (*names, *filter(None, [self._constants.get(msg_id)]), f"0x{msg_id:04X}")

    def known(self) -> list[str]:
        """Return all names that exist at this time, sent or not."""
        topics = topics_of(self._mission) if self._mission is not None else []
        numbers = [f"0x{msg_id:04X}" for msg_id in self._constants]
        declared = (*self._dictionary.telemetry, *self._dictionary.commands, *self._constants.values())
        return [*(topic.name for topic in topics), *declared, *numbers]

    def _topic(self, msg_id: int) -> TopicEntry | None:
        ros = None if self._mission is None else self._mission.ros
        topics = () if ros is None else ros.graph.topics.values()
        return next((topic for topic in topics if topic.msg_id == msg_id), None)

    def _entry(self, packet: bytes | bytearray) -> Command | Telemetry | Topic | None:
        """Return the declaration of a packet that an application has."""
        msg_id = packet[0] << 8 | packet[1]
        if not msg_id & 0x1000:
            return next((each for each in self._dictionary.telemetry.values() if each.msg_id == msg_id), None)
        code = packet[6] & 0x7F if len(packet) > 6 else 0
        commands = [each for each in self._dictionary.commands.values() if each.msg_id == msg_id]
        return next((each for each in commands if (each.code or 0) == code), None)

    def app(self, name: str) -> str:
        """Return the cFE name of a node's application, from the node's name, such as "/arm_control"; other names
        unchanged.
        """
        return name if self._mission is None else apps_of_nodes(self._mission.spec).get(name, name)

    def edit(self, packet: bytes, values: Mapping[str, Any]) -> bytes:
        """Return a packet with some fields set.

        Raises:
            UsageError: if it has no such fields, or the values do not fit.
        """
        topic = self._topic(packet[0] << 8 | packet[1])
        if topic is not None and not topic.raw:
            return self._edit_message(packet, topic.name, values)
        entry = self._entry(packet)
        if not isinstance(entry, Command | Telemetry):
            raise UsageError(f"cannot set a field of {self.of(packet)[0]}: its layout is unknown")
        header = msg.get_header_size(packet)
        try:
            fields = entry.read(packet)
            for path, value in values.items():
                _set(fields, path, value, entry.name)
            return packet[:header] + entry.payload.pack(fields)
        except CfeError as error:
            raise UsageError(str(error)) from None

    def _edit_message(self, packet: bytes, name: str, values: Mapping[str, Any]) -> bytes:
        assert self._mission is not None
        topic = next(each for each in topics_of(self._mission) if each.name == name)
        if msg.get_segmentation_flag(packet) != msg.SegmentationFlag.UNSEGMENTED:
            raise UsageError(f"cannot set a field of a message on {name}: it is sent in segments")
        try:
            message = library_of(topic).message_class(topic.type)().deserialize(packet[msg.TLM_HEADER_SIZE :])
            for path, value in values.items():
                _set(message, path, value, name)
            payload = message.__pack__()
        except UsageError:
            raise
        except Exception as error:  # any exception of the generated code for values that do not fit
            raise UsageError(f"{name}: {error}") from None
        changed = bytearray(packet[: msg.TLM_HEADER_SIZE] + payload)
        msg.set_size(changed, len(changed))
        return bytes(changed)


def _set(whole: Any, path: str, value: Any, owner: str) -> None:
    """Set a field by its path, such as "pose.position.x" or "ranges[3]".

    Raises:
        UsageError: if there is no such field.
    """
    try:
        _changed(whole, _STEP.findall(path), value)
    except (AttributeError, LookupError, ValueError, TypeError):
        raise UsageError(f"cannot set {path} of {owner}: the field is missing or has another type") from None


def _changed(whole: Any, steps: Sequence[str], value: Any) -> Any:
    """Return a value with the part at the path replaced; immutable parts are created again."""
    if not steps:
        return value
    step = steps[0]
    if isinstance(whole, dict):
        whole[step] = _changed(whole[step], steps[1:], value)
    elif isinstance(whole, list | tuple | bytes):
        parts = list(whole)
        parts[int(step)] = _changed(parts[int(step)], steps[1:], value)
        return type(whole)(parts)
    else:
        setattr(whole, step, _changed(getattr(whole, step), steps[1:], value))
    return whole
