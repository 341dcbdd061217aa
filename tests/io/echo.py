"""Common parts of tests with real sockets: a peer application, a clock, and a time limit."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.rtos import Kernel
from cfepy.rtos.realtime import Pacer
from cfepy.units import NS_PER_S

LOOPBACK = "127.0.0.1"
FAST = 500.0  # virtual seconds for a real one
PATIENCE_NS = 3_000 * NS_PER_S


class WaitingClock:
    """Time that passes only while a paced run waits: a machine that is busy elsewhere takes nothing of its patience."""

    def __init__(self, wait: Callable[[float], object]) -> None:
        self._wait = wait
        self._elapsed_ns = 0

    def elapsed_ns(self) -> int:
        return self._elapsed_ns

    def wait(self, seconds: float) -> None:
        self._wait(seconds)
        self._elapsed_ns += int(seconds * NS_PER_S)


def pacer(kernel: Kernel, run_until: Callable[[int], object], wait: Callable[[float], object]) -> Pacer:
    """Paces a run by the time that it has waited."""
    clock = WaitingClock(wait)
    return Pacer(kernel, run_until, FAST, clock.wait, clock.elapsed_ns)


ECHO = '''
def Echo(cfe):
    """Sends back what comes to TCP port 7, in capitals, until the other side has no more."""
    server = cfe.os.socket_open(1, 2)
    address = cfe.os.socket_addr_init(1)
    cfe.os.socket_addr_set_port(address, 7)
    cfe.os.socket_bind(server, address)
    while True:
        connection, _ = cfe.os.socket_accept(server)
        while data := cfe.os.read(connection, 5000):
            at = 0
            while at < len(data):
                at += cfe.os.write(connection, data[at:].upper())
        cfe.os.close(connection)
'''
