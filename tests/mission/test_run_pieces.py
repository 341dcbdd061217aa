"""A run in pieces: Ctrl-C at any point, after which the run continues unchanged."""

from __future__ import annotations

import os
import signal

import pytest

import cfepy
from cfepy.mission import Mission, PacketWatch, Seen
from cfepy.mission.run_pieces import FIRST_PIECE_NS, LEAST_PIECE_NS, LONG_NS, SHORT_NS, HeldBack, PieceLength
from tests.rtos.helpers import Clocks

TASKS = pytest.mark.parametrize("tasks", ["thread", "greenlet"])


def press() -> None:
    os.kill(os.getpid(), signal.SIGINT)


class PressedInTheBus(PacketWatch):
    """Presses Ctrl-C in the middle of the bus's work, at the so manyeth packet."""

    def __init__(self, packet: int) -> None:
        super().__init__(self._take_packet)
        self.left = packet

    def _take_packet(self, seen: Seen) -> None:
        self.left -= 1
        if not self.left:
            press()


@TASKS
@pytest.mark.parametrize(
    ("packet", "seconds"),
    [(50, 0.8), *(pytest.param(packet, 3, marks=pytest.mark.slow) for packet in (1, 300, 800))],
)
def test_flight_continues_after_ctrl_c(tasks: str, packet: int, seconds: float) -> None:
    with cfepy.boot("capture", tasks=tasks) as usual:
        usual.run_until(seconds)
    with cfepy.boot("capture", tasks=tasks, attachments=[PressedInTheBus(packet)]) as flight:
        with pytest.raises(KeyboardInterrupt):
            flight.run_until(seconds)
        assert flight.now < seconds
        flight.run_until(seconds)
    assert flight.trace == usual.trace


class LongPiece(PressedInTheBus):
    """Makes the work at that packet take long, as on a busy computer."""

    def __init__(self, packet: int, clocks: Clocks) -> None:
        super().__init__(packet)
        self._clocks = clocks

    def begin(self, mission: Mission) -> None:
        super().begin(mission)
        mission.stall_watch.spent = self._clocks

    def _take_packet(self, seen: Seen) -> None:
        super()._take_packet(seen)
        if not self.left:
            self._clocks.wait_for_looks()


@pytest.mark.slow
@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_flight_continues_after_ctrl_c_on_a_busy_computer(tasks: str, monkeypatch: pytest.MonkeyPatch) -> None:
    with cfepy.boot("capture", tasks=tasks) as usual:
        usual.run_until(2)
    piece = LongPiece(300, Clocks(monkeypatch, used=0.0, ready=1.0))
    with cfepy.boot("capture", tasks=tasks, attachments=[piece]) as flight:
        with pytest.raises(KeyboardInterrupt):
            flight.run_until(2)
        flight.run_until(2)
    assert flight.trace == usual.trace


@TASKS
def test_run_ends_with_ctrl_c(tasks: str) -> None:
    with pytest.raises(KeyboardInterrupt):
        cfepy.run("capture", seconds=1e6, tasks=tasks, attachments=[PressedInTheBus(40)])
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_ctrl_c_is_raised_at_the_end_of_the_block() -> None:
    done = []

    def act() -> None:
        with HeldBack() as signals:
            press()
            done.append(signals.asked)

    with pytest.raises(KeyboardInterrupt):
        act()
    assert done == [True]


def test_second_ctrl_c_is_raised_at_once() -> None:
    done = []

    def act() -> None:
        with HeldBack():
            press()
            done.append(1)
            press()
            done.append(2)

    with pytest.raises(KeyboardInterrupt):
        act()
    assert done == [1]


def test_error_has_precedence_over_ctrl_c() -> None:
    def act() -> None:
        with HeldBack():
            press()
            raise ValueError("first")

    with pytest.raises(ValueError, match="first"):
        act()


def test_outermost_block_raises_ctrl_c() -> None:
    done = []

    def act() -> None:
        with HeldBack() as outer:
            with HeldBack() as inner:
                press()
            done.append((outer.is_first, inner.is_first, outer.asked, inner.asked))

    with pytest.raises(KeyboardInterrupt):
        act()
    assert done == [(True, False, True, False)]


def test_signal_handler_of_the_program_is_not_replaced() -> None:
    heard = []
    before = signal.signal(signal.SIGINT, lambda *_: heard.append("here"))
    try:
        with HeldBack() as signals:
            press()
    finally:
        signal.signal(signal.SIGINT, before)
    assert (heard, signals.asked, signals.is_first) == (["here"], False, False)


def test_length_of_pieces_follows_their_duration() -> None:
    length = PieceLength()
    length.took(FIRST_PIECE_NS, SHORT_NS - 1)
    assert length.ns == 2 * FIRST_PIECE_NS
    length.took(FIRST_PIECE_NS, SHORT_NS - 1)  # a short one, because the run ended there: it is not representative
    assert length.ns == 2 * FIRST_PIECE_NS
    length.took(length.ns, SHORT_NS)
    assert length.ns == 2 * FIRST_PIECE_NS
    for _ in range(9):
        length.took(length.ns, LONG_NS + 1)
    assert length.ns == LEAST_PIECE_NS
