"""The cost of the same work without cfepy, in this process: the denominator of every ratio."""

from __future__ import annotations

import _thread
import os
import struct
from collections import deque

PACKET = bytes([0x08, 0x81, 0xC0, 0x00, 0x00, 57]) + bytes(58)


def queue_and_header(count: int = 300_000) -> int:
    """One header packed and one packet through a deque: the least that a message can cost."""
    header, items, tail = struct.Struct(">HHHIH").pack, deque[bytes](), PACKET[12:]
    for sequence in range(count):
        items.append(header(0x0881, 0xC000 | (sequence & 0x3FFF), 57, 1001000, 0) + tail)
        items.popleft()
    return count


def hand_overs(context: str, count: int = 100_000) -> int:
    """Bare switches of a pair of tasks, there and back."""
    return _thread_hand_overs(count) if context == "thread" else _greenlet_hand_overs(count)


def _thread_hand_overs(count: int) -> int:
    here, there, done = (_thread.allocate_lock() for _ in range(3))
    for lock in (here, there, done):
        lock.acquire()
    cpu = {min(os.sched_getaffinity(0))} if hasattr(os, "sched_getaffinity") else None

    def settle() -> None:
        if cpu:
            os.sched_setaffinity(0, cpu)
        if hasattr(os, "SCHED_BATCH"):
            os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))

    def ping() -> None:
        settle()
        for _ in range(count):
            there.release()
            here.acquire()
        done.release()

    def pong() -> None:
        settle()
        for _ in range(count):
            there.acquire()
            here.release()

    _thread.start_new_thread(pong, ())
    _thread.start_new_thread(ping, ())
    done.acquire()
    return count


def _greenlet_hand_overs(count: int) -> int:
    from greenlet import getcurrent, greenlet

    host = getcurrent()

    def pong() -> None:
        while True:
            host.switch()

    other = greenlet(pong)
    for _ in range(count):
        other.switch()
    return count
