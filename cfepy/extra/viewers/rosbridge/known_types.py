"""`KnownTypes`: types of topics, messages and services, as nodes of the mission and of ROS know them.

Errors have the texts of rosbridge_library's ros_loader, where they fit.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Literal

from cfepy.ground import ShownPacket
from cfepy.mission import Mission
from cfepy.status import UsageError
from rospy_shim.graph.compiled import CompiledService
from rospy_shim.types.msgs import Library, MessageClass, ServiceClass, library_of, shipped

if TYPE_CHECKING:
    from rospy_shim.runtime import RosRuntime

ANY = "*"


class NotPossible(UsageError):
    """A client's request is not possible; the text is for the client."""


class KnownTypes:
    """The types.

    Args:
        mission: the mission.
        packets: shown packets of applications, by topic.
    """

    def __init__(self, mission: Mission, packets: Mapping[str, ShownPacket]) -> None:
        self._mission = mission
        self._packets = packets

    @property
    def _ros(self) -> RosRuntime | None:
        return self._mission.ros

    def topic_type(self, topic: str) -> str:
        """Return the type of a topic; "" as long as it is not known."""
        ros = self._ros
        found = "" if ros is None else ros.switchboard.master.registry.topic_types().get(topic, "")
        if found in ("", ANY) and topic in self._packets:
            return self._packets[topic].type.name
        return "" if found == ANY else found

    def message_class(self, name: str) -> MessageClass:
        """Return the class of a type, from the mission's own packages or from those that come with cfepy.

        Raises:
            NotPossible: there is no such type.
        """
        full_name = _full_name(name)
        for library in self._libraries():
            if library.has(full_name):
                return library_of(full_name, library.full_text(full_name)).message_class(full_name)
        for topic in () if self._ros is None else self._ros.graph.topics.values():
            if topic.type == full_name and topic.definition:
                return library_of(full_name, topic.definition).message_class(full_name)
        for shown in self._packets.values():
            own = library_of(shown.type.name, shown.type.definition)
            if own.has(full_name):
                return own.message_class(full_name)
        raise self._unknown(full_name, "msg")

    def _libraries(self) -> Iterator[Library]:
        """Yield the sources of types: the packages of the mission's nodes, then those that come with cfepy."""
        if self._ros is not None:
            yield from (node.library for node in self._ros.graph.nodes.values())
        yield shipped()

    def _unknown(self, full_name: str, kind: Literal["msg", "srv"]) -> NotPossible:
        package, _, name = full_name.partition("/")
        if not any(library.names(package, kind) for library in self._libraries()):
            return NotPossible(f"Unable to load the manifest for package {package}. Caused by: it is not there")
        return NotPossible(f"Unable to import {kind} class {name} from package {package}. Caused by: it is not there")

    def service_class(self, name: str) -> ServiceClass:
        """Return the class of a service type.

        Raises:
            NotPossible: there is no such type.
        """
        full_name = _full_name(name)
        for library in self._libraries():
            if library.has(full_name, "srv"):
                return library.service_class(full_name)
        raise self._unknown(full_name, "srv")

    def class_of_service(self, service: str) -> ServiceClass | None:
        """Return the class of an offered service, or None if it is not offered.

        Raises:
            NotPossible: its type is unknown.
        """
        entry = None if self._ros is None else self._ros.graph.services.get(service)
        if entry is None:
            return None
        if isinstance(entry.service, CompiledService):
            return self.service_class(entry.service.service_class._type)
        return entry.service.service_class


def _full_name(name: str) -> str:
    """Return the name of a type without superfluous slashes."""
    parts = [part for part in name.split("/") if part]
    if len(parts) != 2:
        raise NotPossible(f"{name} is not a valid type string")
    return "/".join(parts)
