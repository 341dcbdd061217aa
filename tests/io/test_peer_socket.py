"""A connection on which neither side waits: its data while it is paused, and at its end."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from selectors import DefaultSelector
from typing import NamedTuple

import pytest

from cfepy.io import PeerSocket

MESSAGE = bytes(1 << 16)
COUNT = 200  # messages, more than the system keeps for a connection
LOOK_S = 10.0  # at most; there is always data to transfer


class Ends(NamedTuple):
    """A connection: our side with its selector, and the other side."""

    selector: DefaultSelector
    near: PeerSocket
    far: socket.socket
    came: list[bytes]

    def read_all(self) -> int:
        """Return the bytes that the other side receives up to the end, while this side sends."""
        total = 0
        self.far.setblocking(False)
        while True:
            try:
                data = self.far.recv(1 << 20)
            except BlockingIOError:
                ready = self.selector.select(LOOK_S)
                assert ready, f"nothing goes out any more after {total} bytes"
                for key, events in ready:
                    key.data(events)
                continue
            if not data:
                return total
            total += len(data)


@pytest.fixture
def ends() -> Iterator[Ends]:
    with socket.create_server(("127.0.0.1", 0)) as server, socket.create_connection(server.getsockname()) as far:
        connected, _ = server.accept()
        came: list[bytes] = []
        with DefaultSelector() as selector:
            near = PeerSocket(selector, connected, came.append, lambda why: None)
            yield Ends(selector, near, far, came)
            near.close()


@pytest.mark.parametrize("is_paused", [False, True])
def test_waiting_data_is_sent_also_while_paused(ends: Ends, is_paused: bool) -> None:
    if is_paused:
        ends.near.pause()
    for _ in range(COUNT):
        ends.near.send(MESSAGE)
    assert ends.near.is_full
    ends.near.finish()
    assert ends.read_all() == COUNT * len(MESSAGE)
    assert not ends.near.is_open


def test_pause_keeps_waiting_data(ends: Ends) -> None:
    for _ in range(COUNT):
        ends.near.send(MESSAGE)
    ends.near.pause()
    ends.far.sendall(b"not now")
    ends.near.resume()
    ends.near.finish()
    assert ends.read_all() == COUNT * len(MESSAGE)


def test_data_that_arrives_in_a_pause_is_read_after_it(ends: Ends) -> None:
    ends.near.pause()
    ends.far.sendall(b"later")
    assert ends.selector.select(0) == []
    ends.near.resume()
    for key, events in ends.selector.select(LOOK_S):
        key.data(events)
    assert ends.came == [b"later"]


def test_data_beyond_the_buffer_is_sent_by_flush(ends: Ends) -> None:
    """As a run does that has no time to look at the selector."""
    sent = 0
    while not ends.near.is_full:
        ends.near.send(MESSAGE)
        sent += 1
    total = 0
    while total < sent * len(MESSAGE):
        total += len(ends.far.recv(1 << 20))
        ends.near.flush()
    assert not ends.near.is_full


def test_closed_socket_sends_nothing(ends: Ends) -> None:
    for _ in range(COUNT):
        ends.near.send(MESSAGE)
    ends.near.close()
    for step in (ends.near.flush, ends.near.pause, ends.near.resume, ends.near.finish, ends.near.close):
        step()
    ends.near.send(MESSAGE)
    assert not ends.near.is_open
