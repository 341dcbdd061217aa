"""The target of a ground command: a flight computer on the network, or a mission to be flown."""

from __future__ import annotations

import re
from typing import NamedTuple

from cfepy.ground import Dictionary, dictionary_of
from cfepy.mission import find_script, is_node, read_mission
from cfepy.status import UsageError

_HOST = re.compile(r"((?:\d{1,3}\.){3}\d{1,3}|localhost)(?::(\d+))?|([\w.-]+):(\d+)")
LAST_PORT = 65535


class RemoteHost(NamedTuple):
    """The name and a UDP port of a computer on the network."""

    name: str
    port: int

    def __str__(self) -> str:
        return f"{self.name}:{self.port}"


def host_of(text: str, port: int) -> RemoteHost | None:
    """Parse the name of a computer.

    Args:
        text: an IPv4 address or "localhost", with or without a port, or any name with a port.
        port: the port if the text has none.

    Returns:
        The computer, or None if the text looks like something else.

    Raises:
        UsageError: the port is invalid.
    """
    match = _HOST.fullmatch(text)
    if match is None:
        return None
    given = match[2] or match[4]
    if given is not None and not 0 < int(given) <= LAST_PORT:
        raise UsageError(f"invalid port {given}; expected 1 to {LAST_PORT}", file=text)
    return RemoteHost(match[1] or match[3], port if given is None else int(given))


def check_is_mission(text: str) -> None:
    """Check that a target which is not a computer is a mission.

    Raises:
        UsageError: it is not a mission either.
    """
    try:
        if not is_node(text):
            find_script(text)
    except UsageError as error:
        if text in dictionary_of(None).commands:
            raise UsageError("this is a command name; put the mission or the host first", file=text) from None
        what = "an address such as 192.168.1.5, localhost, or NAME:PORT"
        raise UsageError(f"{error.text}; a host must be {what}", file=text) from None


def dictionary_for(mission: str | None) -> Dictionary:
    """Return the dictionary of a mission that the command line names; for None, of all packets that cfepy ships.

    Raises:
        UsageError: there is no such mission.
    """
    return dictionary_of(None if mission is None else read_mission(mission))
