"""A run in pieces, so short in wall-clock time that the host gets a word in between: the host's user above all.

The pieces change nothing in a run: its trace is that of a run in one piece.

Python's own answer to Ctrl-C is a KeyboardInterrupt between any two steps of whatever runs, which may be the kernel in
the middle of taking a task from a queue: neither could the run go on after that, nor could its tasks be ended. So a
signal that would be answered like that waits until the piece is over.
"""

from __future__ import annotations

import signal
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any

from cfepy.interpreter.host_system import interrupt_once, signal_number

FIRST_PIECE_NS = 10_000_000  # virtual time
LEAST_PIECE_NS = 1_000_000
SHORT_NS, LONG_NS = 80_000_000, 250_000_000  # wall time that a piece should take
_handler_of: Callable[[int], Any] = getattr(signal.getsignal, "__wrapped__", signal.getsignal)
"""The function in C, which makes no enum of what it finds: it is asked before each piece."""


_SIGNALS = tuple(filter(None, map(signal_number, ("SIGINT", "SIGTERM", "SIGHUP"))))
_RAISING = (signal.default_int_handler, interrupt_once)


def is_to_be_held_back() -> bool:
    """Whether Python would answer a signal with a KeyboardInterrupt, so that it takes `HeldBack`."""
    return any(_handler_of(each) in _RAISING for each in _SIGNALS)


class PieceLength:
    """How long a piece is, after what the ones before it took.

    Attributes:
        ns: virtual time of the next piece.
    """

    def __init__(self) -> None:
        self.ns = FIRST_PIECE_NS

    def took(self, length_ns: int, wall_ns: int) -> None:
        """A piece of so much virtual time took so much wall-clock time."""
        if wall_ns > LONG_NS:
            self.ns = max(LEAST_PIECE_NS, self.ns // 2)
        elif wall_ns < SHORT_NS and length_ns >= self.ns:
            self.ns *= 2


class HeldBack:
    """Around what a signal must not break off: Ctrl-C, and others of which Python makes a KeyboardInterrupt.

    The KeyboardInterrupt comes at the end, unless another error does. A second signal does not wait, unless it is
    SIGHUP: what it is about does not come to an end by itself. Signals that the program answers in its own way, and
    those of other threads than the first, are left alone.

    Attributes:
        asked: whether there was one.
        is_first: whether signals are held back here; not when they are already, further out.
    """

    def __init__(self) -> None:
        self.asked = False
        self.is_first = False
        self._before: dict[int, Any] = {}

    def __enter__(self) -> HeldBack:
        try:
            for each in _SIGNALS:
                if _handler_of(each) in _RAISING:
                    self._before[each] = signal.signal(each, self._on_signal)
        except ValueError:
            pass  # not the first thread: signals do not come here
        self.is_first = bool(self._before)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        for each, handler in self._before.items():
            signal.signal(each, handler)
        if self.asked and kind is None:
            raise KeyboardInterrupt

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        is_hangup = self._before[number] is not signal.default_int_handler
        if self.asked and not is_hangup:
            signal.default_int_handler(number, frame)
        if is_hangup:
            self._before[number] = signal.SIG_IGN  # from the end on; see `interrupt_once`
        self.asked = True
