"""Common parts of core applications: their loop and their answers."""

from __future__ import annotations

from typing import Any

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.core_app import Replies, serve
from cfepy.ports import DEBUG, ERROR, INFORMATION, PEND_FOREVER, SYSTEM_CORE_READY, Ports


class Peers:
    """ES, EVS and SB, which record their calls."""

    def __init__(self, *packets: bytes | None) -> None:
        self.noted: list[Any] = []
        self._packets = list(packets)

    def __getattr__(self, name: str) -> Any:
        return lambda *arguments: self.noted.append((name, *arguments))

    def receive_buffer(self, pipe_id: int, timeout_ms: int) -> bytes | None:
        self.noted.append(("receive_buffer", pipe_id, timeout_ms))
        if not self._packets:
            raise EOFError
        return self._packets.pop(0)


def ports_of(peers: Peers) -> Ports:
    ports: Any = Ports()
    ports.es = ports.sb = ports.evs = peers
    return ports  # type: ignore[no-any-return]


def test_loop_waits_for_core_ready_and_marks_its_work() -> None:
    peers = Peers(b"packet", None)
    with pytest.raises(EOFError):
        serve(ports_of(peers), PlatformConfig(), 9, 4, lambda packet: peers.noted.append(packet))
    turn = [("increment_task_counter",), ("perf_log_exit", 4), ("receive_buffer", 9, PEND_FOREVER)]
    work = ("perf_log_entry", 4)
    start = ("wait_for_system_state", SYSTEM_CORE_READY, 30000)
    assert peers.noted == [start, *turn, work, b"packet", *turn, work, *turn]


def test_answers_are_counted_and_sent() -> None:
    peers = Peers()
    replies = Replies(ports_of(peers))
    replies.accept(1, "done")
    replies.accept(2, "done too", DEBUG)
    replies.reject(3, "no")
    replies.send(4, "by the way")
    assert (replies.command_counter, replies.error_counter) == (2, 1)
    assert [sent[1:] for sent in peers.noted] == [
        (1, INFORMATION, "done"),
        (2, DEBUG, "done too"),
        (3, ERROR, "no"),
        (4, INFORMATION, "by the way"),
    ]
    replies.reset()
    assert (replies.command_counter, replies.error_counter) == (0, 0)
