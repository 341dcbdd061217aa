"""A separate network for a test that needs certain ports: a Linux network namespace with nothing but loopback.

`python -m tests.own_network MODULE WORD...` raises the loopback interface and runs a module in it. `run_in_own_network`
starts that with `unshare`, which needs no rights if user namespaces are allowed.
"""

from __future__ import annotations

import fcntl
import os
import runpy
import socket
import struct
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
UNSHARE = ("unshare", "--user", "--map-root-user", "--net")
PATIENCE_S = 300  # limit for a program that would wait forever
SIOCSIFFLAGS, IFF_UP = 0x8914, 1


@cache
def _is_allowed() -> bool:
    try:
        return subprocess.run([*UNSHARE, "true"], capture_output=True, check=False).returncode == 0
    except OSError:  # there is no such program
        return False


needs_own_network = pytest.mark.skipif(not _is_allowed(), reason="this system lets nobody have a network of one's own")


def run_in_own_network(module: str, *words: object, cwd: Path, patience_s: float = PATIENCE_S) -> str:
    """Run a module with `__main__` in a network of its own. Returns its output.

    Args:
        module: such as "tests.ground.page_flight".
        words: its arguments.
        cwd: its working folder.
        patience_s: limit in seconds, after which it counts as waiting forever.
    """
    command = [*UNSHARE, sys.executable, "-m", __name__, module, *map(str, words)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1"}
    ended = subprocess.run(
        command,
        cwd=cwd,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=patience_s,
    )
    assert ended.returncode == 0, ended.stdout
    return ended.stdout


def raise_loopback() -> None:
    """Take the loopback interface into use, which a new network namespace has but down (netdevice(7))."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, SIOCSIFFLAGS, struct.pack("16sH14x", b"lo", IFF_UP))


if __name__ == "__main__":
    raise_loopback()
    sys.argv = sys.argv[1:]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
