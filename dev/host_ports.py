"""Ports of this computer for programs that must be given a port number.

A port that the system picks is free only for the moment. Until the program opens it, another process that opens port 0
or connects to a peer may get it. That process keeps it for another minute after the end of a connection
(RFC 9293, 3.6.1). Therefore this module takes a port below the range from which the system picks.
"""

from __future__ import annotations

import random
import socket
from pathlib import Path

LOWEST, USUAL_FIRST = 20_000, 32_768
_RANGE = Path("/proc/sys/net/ipv4/ip_local_port_range")
_any_number = random.SystemRandom().randrange  # also where a test has set the seed


def first_picked() -> int:
    """Return the lowest port that the system may pick."""
    try:
        return int(_RANGE.read_text(encoding="utf-8").split()[0])
    except OSError:  # other systems do not have it: macOS and Windows pick higher ports
        return USUAL_FIRST


def free_port(kind: socket.SocketKind = socket.SOCK_STREAM) -> int:
    """Return a port that is unused, and that no process gets without asking for that number.

    Args:
        kind: kind of its sockets, streams or datagrams.
    """
    while True:
        port = _any_number(LOWEST, max(first_picked(), LOWEST + 1000))
        with socket.socket(socket.AF_INET, kind) as trial:
            try:
                trial.bind(("", port))
            except OSError:
                continue
        return port
