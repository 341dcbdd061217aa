"""Publications of viewers: ROS messages that enter the mission's graph, and commands of cFE by their names.

A viewer is an outside node, /foxglove_1 and so on, and has publishers as all outside nodes do
(`rospy_shim.graph.outside`). Its messages enter through `cfepy.mission.outside`, so a journal records them. On a
channel /cfe/NAME, where NAME is a command of the dictionary, a JSON object holds its fields.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable
from itertools import count
from typing import TYPE_CHECKING, Any, NamedTuple

from cfepy.extra.viewers.bounded_json import loads
from cfepy.extra.viewers.foxglove.protocol import JSON, ROS1, Advertised, Published
from cfepy.extra.viewers.foxglove.viewer import PEER, Viewer
from cfepy.extra.viewers.websocket_listener import CONNECTIONS
from cfepy.ground import PACKETS, Dictionary, message_from_json
from cfepy.io import INTO, PeerCounts
from cfepy.mission import PACKET, ROS, Mission
from cfepy.msg import Command
from cfepy.status import CfeError, UsageError

if TYPE_CHECKING:
    from rospy_shim.graph.graph import TopicEntry

NODE = "/foxglove_"
MOST_TOPICS = 100  # of all viewers together: each takes a MsgId of the mission
MOST_WAITING = 1000  # messages of one topic for which the mission has no room yet
NAME = re.compile(r"/[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*")


class RosPublication(NamedTuple):
    """A ROS topic that a viewer publishes, with the viewer's node and the type."""

    topic: str
    node: str
    type: str
    md5sum: str
    definition: str
    encode: Callable[[bytes], bytes]
    waiting: deque[bytes]


class CommandPublication(NamedTuple):
    """A channel on which a viewer sends a command of cFE."""

    topic: str
    command: Command


class ClientTopics:
    """All publications of viewers.

    Args:
        mission: the mission.
        dictionary: knows its commands.
        counts: counts for the run's report.
        way_out: receives the mission's output for the viewers' nodes.
        tell: shows an error to the users of the viewers: a text, and a key under which the next one replaces it.
    """

    def __init__(
        self,
        mission: Mission,
        dictionary: Dictionary,
        counts: PeerCounts,
        way_out: Any,
        tell: Callable[[str, str], object],
    ) -> None:
        self._mission = mission
        self._dictionary = dictionary
        self._counts = counts
        self._way_out = way_out
        self._tell = tell
        self._publications: dict[tuple[Viewer, int], RosPublication | CommandPublication] = {}  # by the viewer's number
        self._numbers: dict[Viewer, int] = {}  # of viewers that publish

    def advertise(self, viewer: Viewer, wanted: Advertised) -> None:
        """Begin a publication of a viewer."""
        key = (viewer, wanted.number)
        self._leave(key)
        try:
            if len(self._publications) >= MOST_TOPICS:
                raise UsageError(f"the limit of {MOST_TOPICS} topics published by viewers is reached")
            self._publications[key] = self._publication(viewer, wanted)
        except (UsageError, CfeError, ValueError, KeyError) as error:
            self._refuse(wanted.topic, f"{wanted.topic} cannot be published: {error}")
            self._counts.of(_name_of(wanted.topic), PEER, INTO).refused += 1
        else:
            self._counts.of(wanted.topic, PEER, INTO).connections += 1

    def unadvertise(self, viewer: Viewer, number: int) -> None:
        """End a publication of a viewer."""
        self._leave((viewer, number))

    def gone(self, viewer: Viewer) -> None:
        """End all publications of a viewer that has left."""
        for key in [key for key in self._publications if key[0] is viewer]:
            self._leave(key)

    def publish(self, viewer: Viewer, message: Published) -> None:
        """Take a message of a viewer."""
        publication = self._publications.get((viewer, message.number))
        if publication is None:  # an error was reported when it was advertised
            row = self._counts.of(CONNECTIONS, PEER, INTO)
            row.dropped += 1
            row.why = f"channel {message.number} of a viewer is not, or cannot be, published"
            return
        row = self._counts.of(publication.topic, PEER, INTO)
        row.messages += 1
        row.size += len(message.data)
        try:
            if isinstance(publication, CommandPublication):
                self._command(publication.command, message.data)
                return
            payload = publication.encode(message.data)
        except (CfeError, UsageError, ValueError) as error:
            row.dropped += 1
            self._refuse(publication.topic, f"a message on {publication.topic} was dropped: {error}")
            return
        publication.waiting.append(payload)
        if len(publication.waiting) > MOST_WAITING:
            publication.waiting.popleft()
            row.dropped += 1
            row.why = "the mission has no room for so many"
        self._enter(publication)

    def enter(self) -> None:
        """Enter messages that have waited for room."""
        for publication in self._publications.values():
            if isinstance(publication, RosPublication) and publication.waiting:
                self._enter(publication)

    def begin(self) -> None:
        """Join all publications to a new graph, such as after a processor reset."""
        for publication in self._publications.values():
            if isinstance(publication, RosPublication):
                self._join(publication)

    def _refuse(self, topic: str, why: str) -> None:
        self._counts.of(_name_of(topic), PEER, INTO).why = why
        self._tell(why, f"publish {topic}")

    def _leave(self, key: tuple[Viewer, int]) -> None:
        publication = self._publications.pop(key, None)
        if isinstance(publication, RosPublication):
            row = self._counts.of(publication.topic, PEER, INTO)
            row.ended += 1
            row.dropped += len(publication.waiting)
            self._mission.outside.act(ROS, "publish no more", publication.topic, publication.node)

    # -- begin a publication -------------------------------------------------------------------------------------------

    def _publication(self, viewer: Viewer, wanted: Advertised) -> RosPublication | CommandPublication:
        """Make a publication.

        Raises:
            UsageError, CfeError, ValueError, KeyError: it is not possible.
        """
        command = self._dictionary.commands.get(wanted.topic.removeprefix(PACKETS))
        if wanted.topic.startswith(PACKETS) and command is not None:
            if wanted.encoding != JSON:
                raise UsageError(f"a command must have the encoding {JSON}, not {wanted.encoding}")
            return CommandPublication(wanted.topic, command)
        topic = wanted.topic if wanted.topic.startswith("/") else f"/{wanted.topic}"
        if NAME.fullmatch(topic) is None:
            raise UsageError("invalid topic name")
        if wanted.encoding not in (JSON, ROS1):
            raise UsageError(f"unknown encoding {wanted.encoding!r}; expected {ROS1} or {JSON}")
        kind, definition = wanted.kind, self._definition(topic, wanted)
        library = _library(kind, definition)
        made = library.message_class(kind)
        encode = _encoder(library.message_class, kind, wanted.encoding == JSON)
        node = f"{NODE}{self._number_of(viewer)}"
        found = RosPublication(topic, node, kind, made._md5sum, definition, encode, deque())
        self._join(found)
        return found

    def _number_of(self, viewer: Viewer) -> int:
        """Return the number of a viewer that publishes: the lowest free one, so that the number of names stays
        small.
        """
        here = {viewer for viewer, _ in self._publications}
        self._numbers = {each: number for each, number in self._numbers.items() if each in here}
        taken = set(self._numbers.values())
        return self._numbers.setdefault(viewer, next(number for number in count(1) if number not in taken))

    def _definition(self, topic: str, wanted: Advertised) -> str:
        """Return the definition of a type: from the mission, or else from the viewer."""
        from rospy_shim.types.msgs import message_class

        ros = self._mission.ros
        entries: list[TopicEntry] = [] if ros is None else list(ros.graph.topics.values())
        for entry in sorted(entries, key=lambda each: each.name != topic):
            if entry.type == wanted.kind and entry.definition:
                return entry.definition
        if wanted.definition:
            return wanted.definition
        return message_class(wanted.kind)._full_text

    def _join(self, publication: RosPublication) -> None:
        topic, node, kind, md5sum, definition, *_ = publication
        wrong = self._mission.outside.act(ROS, "publish", topic, node, "", kind, md5sum, definition, False)
        if wrong:
            raise UsageError(wrong)
        ros = self._mission.ros
        assert ros is not None
        ros.outside.ways_out[node] = self._way_out

    # -- input ---------------------------------------------------------------------------------------------------------

    def _enter(self, publication: RosPublication) -> None:
        ros, waiting = self._mission.ros, publication.waiting
        link = None if ros is None else ros.outside.links.get((publication.topic, publication.node))
        while waiting and (link is None or link.has_room(waiting[0])):
            payload = waiting.popleft()
            taken = link is not None and self._mission.outside.act(
                ROS, "message", publication.topic, publication.node, payload
            )
            if not taken:
                row = self._counts.of(publication.topic, PEER, INTO)
                row.dropped += 1
                row.why = "the Software Bus did not take it"

    def _command(self, command: Command, data: bytes) -> None:
        try:
            self._send(command, data)
        except (TypeError, KeyError, AttributeError, OverflowError) as error:  # of values that do not fit a field
            raise ValueError(f"invalid {command.name}: {error}") from None

    def _send(self, command: Command, data: bytes) -> None:
        values = loads(data)
        if not isinstance(values, dict):
            raise ValueError("a command must be a JSON object of its fields")
        fields = {name: value for name, value in values.items() if not name.startswith("_")}
        self._mission.outside.act(PACKET, command.packet(fields))


def _name_of(topic: str) -> str:
    """Return the name of a topic for the report, or a placeholder for an invalid one."""
    return topic if NAME.fullmatch(topic) else "(no topic)"


def _library(kind: str, definition: str) -> Any:
    from rospy_shim.types.msgs import from_full_text

    return from_full_text(kind, definition)


def _encoder(class_of: Callable[[str], Any], kind: str, is_json: bool) -> Callable[[bytes], bytes]:
    """Make a function that serialises a viewer's message as ROS does; it raises ValueError for invalid data."""
    made = class_of(kind)

    def encode(data: bytes) -> bytes:
        try:
            if is_json:
                return bytes(message_from_json(class_of, kind, loads(data)).__pack__())
            is_whole = made.__unpack__(data).__pack__() == data
        except Exception as error:  # the generated code may raise any error for invalid data
            raise ValueError(f"invalid {kind}: {error}") from None
        if not is_whole:
            raise ValueError(f"invalid {kind}: wrong number of bytes")
        return data

    return encode
