"""A run recorded into an MCAP file, for Foxglove and other tools: its ROS topics, its cFE packets and its events.

Recording watches the bus, as that into a bag does, so it changes nothing in the run. Packets are JSON with a schema:
the fields of their declaration, `_header` with what their CCSDS headers say, and `_packet`, all their bytes in base64.
Events are also written as `foxglove.Log`.
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from cfepy.evs import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.ground.bag import BagRecorder, RunRecorder, storage
from cfepy.ground.dictionary import Decoded, Dictionary, dictionary_of
from cfepy.ground.events import EVENT_IDS, DecodedEvent
from cfepy.ground.mcap_writer import McapWriter
from cfepy.mission import Mission, Seen, TopicMessage, matches
from cfepy.msg import (
    CMD_HEADER_SIZE,
    TLM_HEADER_SIZE,
    Command,
    Telemetry,
    get_fcn_code,
    get_header_size,
    get_header_version,
)
from cfepy.status import CfeError, UsageError
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from rosbag_storage import RecordedChannel

SUFFIX = ".mcap"
PACKETS, EVENTS = "/cfe/", "/cfe/events"
FLUSH_NS = NS_PER_S  # of virtual time: what a run that is killed loses at most, as soon as it is on the disk

_INTEGER, _NUMBER, _TEXT = {"type": "integer"}, {"type": "number"}, {"type": "string"}
_BYTES = {"type": "string", "contentEncoding": "base64"}
_TIME = {"type": "object", "title": "time", "properties": {"sec": _INTEGER, "nsec": _INTEGER}}
_HEADER = {
    "type": "object",
    "properties": {
        "msg_id": _INTEGER,
        "sequence": _INTEGER,
        "length": _INTEGER,
        "time_s": _NUMBER,
        "function_code": _INTEGER,
        "sender": _TEXT,
        "problem": _TEXT,
    },
}
_LOG = {
    "title": "foxglove.Log",
    "type": "object",
    "properties": {
        "timestamp": _TIME,
        "level": _INTEGER,
        "message": _TEXT,
        "name": _TEXT,
        "file": _TEXT,
        "line": _INTEGER,
    },
}
_LOG_LEVELS = {DEBUG: 1, INFORMATION: 2, ERROR: 4, CRITICAL: 5}
"""foxglove.Log's level of each type of event."""


class McapRecorder(RunRecorder):
    """Records a run into an MCAP file.

    Args:
        file: the file; an older one is written over.
        patterns: names of topics and channels, such as "/odom" or "/cfe/*"; all when there are none.
        command: the command that does the run again, which the file tells.

    Raises:
        UsageError: the file cannot be written, or the library mcap is not installed.

    Attributes:
        count: messages, packets and events so far.
    """

    def __init__(self, file: str, patterns: Sequence[str] = (), command: str = "") -> None:
        super().__init__(self._take_topic, file, patterns)
        self._channels: dict[object, int] = {}
        self._dictionary = Dictionary()
        self._flushed_ns = 0
        try:
            self._writer = McapWriter(self._file)
            if command:
                self._writer.metadata("cfepy", {"command": command})
        except UsageError:
            self._file.close()
            raise

    def _finish(self) -> None:
        self._writer.finish()

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""
        super().begin(mission)
        self._dictionary = dictionary_of(mission.spec)

    def _is_wanted(self, msg_id: int) -> bool:
        return True

    def take_packet(self, seen: Seen) -> None:
        """See `TopicWatch.take_packet`."""
        super().take_packet(seen)
        declared = None if get_header_version(seen.packet) else self._dictionary.declared_as(seen.packet)
        if declared is None and self._topic(seen.msg_id) is not None:
            return  # the message of a ROS topic, which has been taken
        stamp_ns = self._stamp(seen.at_ns)
        if stamp_ns is None:
            return  # as of topics, there is no time yet
        self._take_cfe(seen, declared, stamp_ns)
        if seen.msg_id in EVENT_IDS and matches(EVENTS, self._patterns):
            self._take_event(seen, stamp_ns)

    def _take_cfe(self, seen: Seen, declared: Command | Telemetry | None, stamp_ns: int) -> None:
        name = f"{PACKETS}{f'0x{seen.msg_id:04X}' if declared is None else declared.name}"
        if not matches(name, self._patterns):
            return
        decoded = self._dictionary.decode(seen.packet)

        def channel() -> RecordedChannel:
            about = {"msg_id": f"0x{seen.msg_id:04X}"}
            return _json_channel(name, name[1:].replace("/", "."), _packet_schema(name, declared), about)

        self._write(name, channel, seen.at_ns, stamp_ns, _packet_json(seen, decoded), decoded.sequence)

    def _take_event(self, seen: Seen, stamp_ns: int) -> None:
        try:
            event = DecodedEvent.of(seen)
        except (CfeError, UsageError):
            return  # an application has sent something else on this MsgId, which the packet's own channel shows
        data = _event_json(event, stamp_ns)
        self._write(
            EVENTS, lambda: _json_channel(EVENTS, "foxglove.Log", _log_schema(), {}), seen.at_ns, stamp_ns, data
        )

    def _take_topic(self, message: TopicMessage) -> None:
        if message.stamp_ns is None:
            return  # rosbag, too, begins when there is a time
        header = message.header
        key = (message.topic, header.get("callerid", ""), header["md5sum"])

        def channel() -> RecordedChannel:
            found: RecordedChannel = storage().channel_of_connection(storage().Connection(0, message.topic, header))
            return found

        self._write(key, channel, message.at_ns, message.stamp_ns, message.data)

    def _write(
        self,
        key: object,
        channel: Callable[[], RecordedChannel],
        at_ns: int,
        stamp_ns: int,
        data: bytes,
        sequence: int = 0,
    ) -> None:
        if self._failed is not None:
            return
        try:
            if key not in self._channels:
                self._channels[key] = self._writer.channel(channel())
            self.count += 1
            self._writer.write(self._channels[key], stamp_ns, data, sequence=sequence)
            if at_ns - self._flushed_ns >= FLUSH_NS:
                self._flushed_ns = at_ns
                self._writer.flush()
        except OSError as error:
            self._failed = error


def _json_channel(name: str, title: str, schema: bytes, about: dict[str, str]) -> RecordedChannel:
    library = storage()
    channel: RecordedChannel = library.RecordedChannel(
        0, name, "json", library.McapSchema(title, "jsonschema", schema), about
    )
    return channel


def recorder_of(file: str, patterns: Sequence[str] = (), command: str = "") -> RunRecorder:
    """What records a run into a file: into an MCAP file if its name ends with .mcap, else into a bag.

    Args:
        file: the file; an older one is written over.
        patterns: names of topics; all when there are none.
        command: the command that does the run again, which an MCAP file tells.

    Raises:
        UsageError: the file cannot be written, or the library mcap is not installed.
    """
    if file.endswith(SUFFIX):
        return McapRecorder(file, patterns, command)
    return BagRecorder(file, patterns)


# -- packets and events as JSON ----------------------------------------------------------------------------------------


def _packet_schema(name: str, declared: Command | Telemetry | None) -> bytes:
    """The JSON schema of a packet.

    Args:
        name: of the packet.
        declared: what it is declared as; None when that is not known.
    """
    layout = None if declared is None else declared.payload
    fields = {} if layout is None else _properties(layout.unpack(bytes(layout.size)))
    return _bytes_of({"title": name, "type": "object", "properties": {**fields, "_header": _HEADER, "_packet": _BYTES}})


def _log_schema() -> bytes:
    """The JSON schema of an event."""
    return _bytes_of(_LOG)


def _packet_json(seen: Seen, decoded: Decoded) -> bytes:
    """A packet as JSON.

    Args:
        seen: the packet.
        decoded: what is in it.
    """
    packet = seen.packet
    header: dict[str, Any] = {"msg_id": decoded.msg_id, "sequence": decoded.sequence, "length": len(packet)}
    if decoded.time_s is not None:
        header["time_s"] = decoded.time_s
    elif len(packet) >= CMD_HEADER_SIZE and get_header_size(packet) != TLM_HEADER_SIZE:
        header["function_code"] = get_fcn_code(packet)
    header["sender"] = seen.sender
    if decoded.problem:
        header["problem"] = decoded.problem
    return _bytes_of({**decoded.values, "_header": header, "_packet": packet})


def _event_json(event: DecodedEvent, time_ns: int) -> bytes:
    """An event as a `foxglove.Log`: the application is its name, the event's id its line.

    Args:
        event: the event.
        time_ns: when it was sent.
    """
    return _bytes_of(
        {
            "timestamp": {"sec": time_ns // NS_PER_S, "nsec": time_ns % NS_PER_S},
            "level": _LOG_LEVELS.get(event.event_type, 0),
            "message": event.text or f"event {event.event_id}",
            "name": event.app,
            "file": "",
            "line": event.event_id,
        }
    )


def _properties(values: dict[str, Any]) -> dict[str, Any]:
    return {name: _schema_of(value) for name, value in values.items()}


def _schema_of(value: Any) -> dict[str, Any]:
    if isinstance(value, dict):
        return {"type": "object", "properties": _properties(value)}
    if isinstance(value, list):
        return {"type": "array", "items": _schema_of(value[0])} if value else {"type": "array"}
    if isinstance(value, bool):
        return {"type": "boolean"}
    if isinstance(value, float):
        return _NUMBER
    return _INTEGER if isinstance(value, int) else _TEXT


def _bytes_of(value: Any) -> bytes:
    return json.dumps(_plain(value), separators=(",", ":"), allow_nan=False).encode()


def _plain(value: Any) -> Any:
    """With what JSON has: bytes as base64, and null for a number that it has not."""
    if isinstance(value, dict):
        return {name: _plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    if isinstance(value, (bytes, bytearray, memoryview)):
        return base64.b64encode(value).decode()
    return None if isinstance(value, float) and not math.isfinite(value) else value
