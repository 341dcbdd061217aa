"""The section `devices:` of a mission file: the devices at ports and buses of compiled applications."""

from __future__ import annotations

import os
import re
from functools import partial
from pathlib import Path
from typing import NamedTuple

from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes

DEVICE_FIELDS = ("python", "udp", "to")
HERE = "127.0.0.1"
MOST_PORT = 65_535
_CLASS = re.compile(r"(?P<file>[^:]+\.py):(?P<name>[A-Za-z_]\w*)")
_PLACE = re.compile(r"(?:(?P<host>[\w.-]+):)?(?P<port>\d{1,5})")


class DeviceConfig(NamedTuple):
    """One device.

    Attributes:
        name: its name in C, such as "/dev/ttyS1", "/dev/i2c-1:0x1e", "gpio24" or "can0".
        file, class_name: a class in Python that is the device; None and "" if there is none.
        port: the UDP port that is the device, on the mission's network; 0 if there is none.
        target: host and port that get the datagrams.
    """

    name: str
    file: Path | None = None
    class_name: str = ""
    port: int = 0
    target: tuple[str, int] = (HERE, 0)


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
    if ("python" in said) == ("udp" in said):
        raise entry.fail("requires one of `python: FILE.py:CLASS` and `udp: PORT`")
    if "python" in said:
        if "to" in said:
            raise said["to"].fail("is only valid with `udp`")
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


def _place(entry: Marked) -> tuple[str, int]:
    match = _PLACE.fullmatch(str(entry.value))
    if match is None or not 0 < int(match["port"]) <= MOST_PORT:
        raise entry.fail(f"{entry.shown()} is not an address; expected PORT or HOST:PORT")
    return match["host"] or HERE, int(match["port"])
