"""Selects connections and messages, and splits a message to be written into its parts.

Imports genpy and rosbag_storage.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any

import genpy.message
from rosbag_storage import Connection, Entry, ROSBagException

if TYPE_CHECKING:
    from ._indexed import Indexed

Filter = Callable[[str, str, str, str, Any], Any]
"""Takes (topic, type, md5sum, definition, connection header); whether messages of the connection are wanted."""


def connections(
    every: Iterable[Connection], topics: str | Iterable[str] | None, wanted: Filter | None
) -> Iterator[Connection]:
    """Yield the connections of some topics, or of all if there are none, that pass a filter."""
    names = {_canonical(each) for each in ([topics] if isinstance(topics, str) else topics or ()) if each}
    for each in every:
        if names and each.topic not in names and _canonical(each.topic) not in names:
            continue
        if wanted is None or wanted(each.topic, each.datatype, each.md5sum, each.msg_def, each.header):
            yield each


def _canonical(topic: str) -> str:
    """Without a slash at the end, and none twice (roslib.names.canonicalize_name)."""
    lead = "/" if topic[0] == "/" else ""
    return lead + "/".join(part for part in topic.split("/") if part)


def entries(bag: Indexed, chosen: Iterable[Connection] | None, start: Any, end: Any) -> Iterator[Entry]:
    """Yield the entries of connections (None: of all) from one time to another, both included, None without limit."""
    contents = bag.__contents__()
    for entry in contents.entries(list(contents.connections.values() if chosen is None else chosen)):
        time = genpy.Time(0, entry.time) if start or end else genpy.Time()
        if start and time < start:
            continue
        if end and time > end:
            return
        yield entry


def entries_reverse(bag: Indexed, chosen: Iterable[Connection] | None, start: Any, end: Any) -> Iterator[Entry]:
    """Yield the same from the last one on."""
    contents = bag.__contents__()
    connected = list(contents.connections.values() if chosen is None else chosen)
    for entry in contents.entries(connected, reverse=True):
        time = genpy.Time(0, entry.time) if start or end else genpy.Time()
        if end and time > end:
            continue
        if start and time < start:
            return
        yield entry


Parts = tuple[Callable[[], bytes], Callable[[], dict[str, str]]]


def message_parts(topic: str, message: Any) -> Parts:
    """Return functions that make a message's bytes and its connection header."""
    kind = message.__class__

    def data() -> bytes:
        buffer = io.BytesIO()
        message.serialize(buffer)
        return buffer.getvalue()

    return data, lambda: _header(topic, kind._type, kind._md5sum, message._full_text)


def raw_parts(topic: str, message: Any) -> Parts:
    """Return the same for a raw message.

    Raises:
        ValueError: it is not a tuple of four or five.
    """
    if len(message) not in (4, 5):
        raise ValueError("msg must be of length 4 or 5")
    type_name, data, md5sum, *_, kind = message

    def header() -> dict[str, str]:
        found = kind if kind is not None else _known(type_name)
        if found is None:
            raise ROSBagException(f"cannot locate message class and no message class provided for [{type_name}]")
        if found._md5sum != md5sum:
            text = f"WARNING: md5sum of loaded type [{type_name}] does not match that specified"
            print(text, file=sys.stderr)
        return _header(topic, type_name, md5sum, found._full_text)

    return lambda: data, header


def _known(type_name: str) -> Any:
    try:
        return genpy.message.get_message_class(type_name)
    except Exception:  # a name that is none
        return None


def _header(topic: str, type_name: str, md5sum: str, definition: str) -> dict[str, str]:
    return {"topic": topic, "type": type_name, "md5sum": md5sum, "message_definition": definition}
