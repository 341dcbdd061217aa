"""Ports of this computer for programs that have to be told one.

A port that the system picks is free only for the moment: until the program opens it, anybody who opens port 0, or
connects to somebody, may get it, and has it for another minute after the end of a connection (RFC 9293, 3.6.1). So a
port is taken from below those that the system picks.
"""

from __future__ import annotations

import random
import socket
from pathlib import Path

LOWEST, USUAL_FIRST = 20_000, 32_768
_RANGE = Path("/proc/sys/net/ipv4/ip_local_port_range")
_any_number = random.SystemRandom().randrange  # also where a test has set the seed


def first_picked() -> int:
    """The lowest port that the system picks by itself."""
    try:
        return int(_RANGE.read_text(encoding="utf-8").split()[0])
    except OSError:  # of a system without it: those of macOS and Windows are higher
        return USUAL_FIRST


def free_port(kind: socket.SocketKind = socket.SOCK_STREAM) -> int:
    """A port that nobody has, and that nobody gets who does not ask for it.

    Args:
        kind: of its sockets, streams or datagrams.
    """
    while True:
        port = _any_number(LOWEST, max(first_picked(), LOWEST + 1000))
        with socket.socket(socket.AF_INET, kind) as trial:
            try:
                trial.bind(("", port))
            except OSError:
                continue
        return port
