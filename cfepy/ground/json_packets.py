"""Packets and events as JSON with a schema, for MCAP files and Foxglove.

A packet has the fields of its declaration, `_header` with the contents of its CCSDS headers, and `_packet` with all its
bytes in base64. An event is a `foxglove.Log` (docs.foxglove.dev/docs/visualization/message-schemas/log).
"""

from __future__ import annotations

import base64
import json
import math
from typing import TYPE_CHECKING, Any

from cfepy.evs import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.msg import CMD_HEADER_SIZE, TLM_HEADER_SIZE, Command, Telemetry, get_fcn_code, get_header_size
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.ground.dictionary import Decoded
    from cfepy.ground.events import DecodedEvent
    from cfepy.mission import Seen

PACKETS, EVENTS = "/cfe/", "/cfe/events"
"""Prefix of the names of packets' channels, and the channel of events."""

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


def packet_schema(name: str, declared: Command | Telemetry | None) -> bytes:
    """Return the JSON schema of a packet.

    Args:
        name: name of the packet.
        declared: its declaration; None if it is not known.
    """
    layout = None if declared is None else declared.payload
    fields = {} if layout is None else _properties(layout.unpack(bytes(layout.size)))
    return _bytes_of({"title": name, "type": "object", "properties": {**fields, "_header": _HEADER, "_packet": _BYTES}})


def log_schema() -> bytes:
    """Return the JSON schema of an event."""
    return _bytes_of(_LOG)


def packet_json(seen: Seen, decoded: Decoded) -> bytes:
    """Return a packet as JSON.

    Args:
        seen: the packet.
        decoded: its contents.
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


def event_json(event: DecodedEvent, time_ns: int) -> bytes:
    """Return an event as a `foxglove.Log`: the application is its name, the event's id its line.

    Args:
        event: the event.
        time_ns: time at which it was sent.
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
    """Return a value in JSON types: bytes as base64, null for numbers that JSON lacks."""
    if isinstance(value, dict):
        return {name: _plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    if isinstance(value, (bytes, bytearray, memoryview)):
        return base64.b64encode(value).decode()
    return None if isinstance(value, float) and not math.isfinite(value) else value
