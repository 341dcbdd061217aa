"""The section `devices:` of a mission file: the devices at ports and buses of compiled applications."""

from __future__ import annotations

import os
import re
from functools import partial
from pathlib import Path
from typing import NamedTuple

from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes

DEVICE_FIELDS = ("python", "udp", "topic", "to", "type")
TOPIC_TYPES = ("std_msgs/UInt8MultiArray", "std_msgs/String")
"""The types of messages that carry the bytes of a device; the first is the default."""
HERE = "127.0.0.1"
MOST_PORT = 65_535
_CLASS = re.compile(r"(?P<file>[^:]+\.py):(?P<name>[A-Za-z_]\w*)")
_TOPIC = re.compile(r"/?[A-Za-z]\w*(?:/[A-Za-z]\w*)*")
_PLACE = re.compile(r"(?:(?P<host>[\w.-]+):)?(?P<port>\d{1,5})")


class DeviceConfig(NamedTuple):
    """One device.

    Attributes:
        name: its name in C, such as "/dev/ttyS1", "/dev/i2c-1:0x1e", "gpio24" or "can0".
        file, class_name: a class in Python that is the device; None and "" if there is none.
        port: the UDP port that is the device, on the mission's network; 0 if there is none.
        target: host and port that get the datagrams.
        topic: the ROS topic whose messages are bytes to read; "" if it is no topic.
        sends: the ROS topic that gets the written bytes; "" for none.
        kind: the type of both topics.
    """

    name: str
    file: Path | None = None
    class_name: str = ""
    port: int = 0
    target: tuple[str, int] = (HERE, 0)
    topic: str = ""
    sends: str = ""
    kind: str = TOPIC_TYPES[0]


def read_devices(section: Marked, mistakes: Mistakes) -> dict[str, DeviceConfig]:
    """Return the devices, by name, without invalid ones.

    Args:
        section: the mapping of names; files are relative to the folder of its file.
        mistakes: collects unknown keys, missing files and invalid values.
    """
    found: dict[str, DeviceConfig] = {}
    for name, entry in mistakes.mapping(section).items():
        device = mistakes.attempt(partial(_device, name, entry))
        if device is None:
            continue
        other = next((each.name for each in found.values() if device.port and each.port == device.port), None)
        if other is not None:
            mistakes.add(entry.fail(f"has the UDP port {device.port} of {other}; choose another port"))
        found[name] = device
    return found


def _device(name: str, entry: Marked) -> DeviceConfig:
    said = entry.mapping(DEVICE_FIELDS)
    if sum(kind in said for kind in ("python", "udp", "topic")) != 1:
        raise entry.fail("requires one of `python: FILE.py:CLASS`, `udp: PORT` and `topic: NAME`")
    if "type" in said and "topic" not in said:
        raise said["type"].fail("is only valid with `topic`")
    if "topic" in said:
        sends = _topic(said["to"]) if "to" in said else ""
        kind = said["type"].text() if "type" in said else TOPIC_TYPES[0]
        if kind not in TOPIC_TYPES:
            raise said["type"].fail(f"{said['type'].shown()} carries no bytes; expected {' or '.join(TOPIC_TYPES)}")
        return DeviceConfig(name, topic=_topic(said["topic"]), sends=sends, kind=kind)
    if "python" in said:
        if "to" in said:
            raise said["to"].fail("is only valid with `udp` or `topic`")
        file, class_name = _class(said["python"])
        return DeviceConfig(name, file, class_name)
    if "to" not in said:
        raise entry.fail("requires `to: HOST:PORT`, which gets the bytes that applications write")
    host, port = _place(said["to"])
    return DeviceConfig(name, port=said["udp"].integer(1, MOST_PORT), target=(host, port))


def _class(entry: Marked) -> tuple[Path, str]:
    text = entry.text()
    match = _CLASS.fullmatch(text)
    if match is None:
        raise entry.fail(f"{entry.shown()} is not a class; expected FILE.py:CLASS")
    file = Path(entry.file).parent / match["file"]
    if not os.path.isfile(file):
        raise entry.fail(f"file {file} not found")
    return file, match["name"]


def _topic(entry: Marked) -> str:
    text = entry.text()
    if _TOPIC.fullmatch(text) is None:
        raise entry.fail(f"{entry.shown()} is not a ROS name; expected /NAME")
    return "/" + text.lstrip("/")


def _place(entry: Marked) -> tuple[str, int]:
    match = _PLACE.fullmatch(str(entry.value))
    if match is None or not 0 < int(match["port"]) <= MOST_PORT:
        raise entry.fail(f"{entry.shown()} is not an address; expected PORT or HOST:PORT")
    return match["host"] or HERE, int(match["port"])
