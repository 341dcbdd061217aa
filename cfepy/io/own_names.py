"""The names of this computer, by which a server distinguishes its own clients from pages of other sites.

A browser lets every page send requests to 127.0.0.1, and a site can give its own name the address 127.0.0.1 (DNS
rebinding). The browser sends both: Origin is the site of the page (RFC 6454), Host is the name of the server used by
the page (RFC 9110, 7.2).
"""

from __future__ import annotations

import re
import socket
from collections.abc import Iterable
from ipaddress import ip_address
from pathlib import Path

LOCALHOST = "localhost"
HOSTS = Path("/etc/hosts")
_HOST = re.compile(r"(\[[0-9a-f:.]+\]|[^\[\]:/@\s]+)(:[0-9]{1,5})?", re.IGNORECASE | re.ASCII)


def is_this_computer(host: str) -> bool:
    """Return whether a host is a name or an address of the loopback interface."""
    return host == LOCALHOST or is_loopback(host)


def is_loopback(host: str) -> bool:
    """Return whether a text is an address of the loopback interface."""
    try:
        return host.isascii() and ip_address(host).is_loopback
    except ValueError:
        return False


class OwnNames:
    """Names and addresses by which clients may address a server.

    Args:
        more: additional names or addresses, such as ROS_HOSTNAME and ROS_IP.
    """

    def __init__(self, more: Iterable[str] = ()) -> None:
        name = _plain(socket.gethostname())
        label = name.partition(".")[0]
        self._names = {name, label, f"{label}.local", *map(_plain, more), *_aliases(name)} - {"", ".local"}

    def has(self, host: str, here: str) -> bool:
        """Return whether the field Host of a request names this computer.

        Args:
            host: the field, with or without a port.
            here: address of this computer to which the client has connected.
        """
        parts = _HOST.fullmatch(host.strip())
        if parts is None:
            return False
        name = _plain(parts[1].strip("[]"))
        return is_this_computer(name) or name in self._names or name == _plain(here)


def _plain(name: str) -> str:
    return name.strip().rstrip(".").lower()


def _aliases(name: str) -> set[str]:
    """Return other names of this computer in its hosts file."""
    try:
        lines = HOSTS.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return set()
    found = [{_plain(each) for each in line.partition("#")[0].split()[1:]} for line in lines]
    return {each for names in found if name in names for each in names}
