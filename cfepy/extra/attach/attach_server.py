"""`AttachServer`: answers the programs that attach to a flight, and shows them its messages.

While no program listens, it looks at no message. A program that reads too slowly loses the oldest messages, and cannot
delay the flight.
"""

from __future__ import annotations

import os
import socket
from collections.abc import Callable
from functools import partial
from selectors import DefaultSelector
from typing import Any

from cfepy.attachment import Attachment
from cfepy.ground import AbsentError, RosSide
from cfepy.io import Listening, LiveFrames, PeerSocket, flight_folder, framed
from cfepy.mission import PACKET, Mission, PacketWatch, Seen, TopicMessage, TopicWatch, matches, receivers
from cfepy.msg import get_msg_id
from cfepy.sb import SoftwareBus
from cfepy.status import CfeError, UsageError

MOST_PROGRAMS = 16
LONGEST_REQUEST = 1 << 20  # bytes
KIND, TELEMETRY = 0x1800, 0x0800  # of a MsgId: command, secondary header


class _Program:
    """An attached program: its connection, and the messages it wants."""

    def __init__(self) -> None:
        self.peer: PeerSocket
        self.frames = LiveFrames(LONGEST_REQUEST)
        self.topics: tuple[str, ...] = ()
        self.telemetry: frozenset[int] | None = None  # empty for all

    def send(self, message: dict[str, Any]) -> None:
        """Send a message; it has the number of lost ones."""
        self.peer.send(framed({**message, "lost": self.peer.dropped}))


class AttachServer(Attachment):
    """The flight's side of the socket.

    Attributes:
        path: the socket.

    Raises:
        UsageError: if the socket cannot be opened.
    """

    def __init__(self) -> None:
        self.path = flight_folder() / f"{os.getpid()}-{id(self):x}.sock"
        self._selector = DefaultSelector()
        self._programs: list[_Program] = []
        self._mission: Mission
        self._ros: RosSide
        self._listening: Listening | None = self._open()
        self._packet_watch = PacketWatch(self._take_packet, self._is_wanted)
        self._topic_watch = TopicWatch(self._take_message)
        self._answers: dict[str, Callable[[_Program, dict[str, Any]], dict[str, Any]]] = {
            "hello": self._hello,
            "topics": self._topics,
            "listen": self._listen,
            "send": self._send,
            "publish": self._publish,
        }

    def _open(self) -> Listening:
        opened = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            opened.bind(str(self.path))
            os.chmod(self.path, 0o600)
            opened.listen(MOST_PROGRAMS)
        except OSError as error:
            opened.close()
            raise UsageError(f"cannot be opened: {error.strerror or error}", file=self.path) from None
        return Listening(self._selector, opened, self._accept)

    # -- a guest of the run --------------------------------------------------------------------------------------------

    def fileno(self) -> int:
        """Return the descriptor that becomes readable when a request arrives."""
        return self._selector.fileno()

    def exchange(self) -> None:
        """Answer the requests that arrived."""
        if self._listening is not None:
            for key, events in self._selector.select(0):
                key.data(events)

    def close(self) -> None:
        """Send the remaining messages, and remove the socket. You may call it twice."""
        listening, self._listening = self._listening, None
        if listening is None:
            return
        for program in self._programs:
            program.peer.flush()
            program.peer.close()
        self._programs.clear()
        listening.close()
        self._selector.close()
        self.path.unlink(missing_ok=True)

    # -- an attachment -------------------------------------------------------------------------------------------------

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        return self._topic_watch.hearing(self._packet_watch.bus(base))

    def begin(self, mission: Mission) -> None:
        self._mission = mission
        self._ros = RosSide(mission, mission.outside.act)
        self._topic_watch.begin(mission)

    def _is_wanted(self, msg_id: int) -> bool:
        return any(each.topics or each.telemetry is not None for each in self._programs)

    def _take_packet(self, seen: Seen) -> None:
        self._topic_watch.take_packet(seen)
        for program in self._programs:
            wanted = program.telemetry
            if wanted is not None and (seen.msg_id in wanted or (not wanted and seen.msg_id & KIND == TELEMETRY)):
                program.send({"packet": seen.packet, "at_ns": seen.at_ns})

    def _take_message(self, message: TopicMessage) -> None:
        for program in self._programs:
            if program.topics and matches(message.topic, program.topics):
                shown = {name: getattr(message, name) for name in ("topic", "header", "data", "at_ns", "stamp_ns")}
                program.send(shown)

    # -- requests ------------------------------------------------------------------------------------------------------

    def _accept(self, connected: socket.socket) -> None:
        if len(self._programs) >= MOST_PROGRAMS:
            connected.close()
            return
        program = _Program()
        self._programs.append(program)
        program.peer = PeerSocket(
            self._selector, connected, partial(self._take, program), lambda why: self._programs.remove(program)
        )

    def _take(self, program: _Program, data: bytes) -> None:
        for request in program.frames.take(data):
            op = request.get("op")
            answer = self._answers.get(op) if isinstance(op, str) else None
            if answer is None:
                raise ValueError("unknown request")
            try:
                program.send({"of": op, **answer(program, request)})
            except (UsageError, AbsentError, CfeError) as error:
                program.send({"of": op, "error": str(error)})

    def _hello(self, program: _Program, request: dict[str, Any]) -> dict[str, Any]:
        spec = self._mission.spec
        return {"mission": spec.name, "script": str(spec.script.absolute()), "pid": os.getpid()}

    def _topics(self, program: _Program, request: dict[str, Any]) -> dict[str, Any]:
        ros = self._mission.ros
        if ros is None:
            return {"topics": [], "nodes": {}}
        rows = [[row.name, row.type, list(row.publishers), list(row.subscribers)] for row in ros.topics()]
        return {
            "topics": rows,
            "nodes": {name: node.client.get_node_uri() or "" for name, node in ros.graph.nodes.items()},
        }

    def _listen(self, program: _Program, request: dict[str, Any]) -> dict[str, Any]:
        program.topics = tuple(map(str, request["topics"]))
        ids = request["telemetry"]
        program.telemetry = None if ids is None else frozenset(map(int, ids))
        return {}

    def _send(self, program: _Program, request: dict[str, Any]) -> dict[str, Any]:
        packet = bytes(request["packet"])
        found = receivers(self._mission.cfe.sb, get_msg_id(packet))
        self._mission.outside.act(PACKET, packet)
        return {"receivers": found, "at_ns": self._mission.kernel.now}

    def _publish(self, program: _Program, request: dict[str, Any]) -> dict[str, Any]:
        topic, fields = str(request["topic"]), request["fields"]
        if not isinstance(fields, dict):
            raise ValueError("fields are not a mapping")
        try:
            self._ros.publish(topic, None, fields)
        except (UsageError, AbsentError):
            raise
        except Exception as error:  # any exception of the message's code for such a value
            raise UsageError(f"invalid value: {error}", file=topic) from None
        return {}
