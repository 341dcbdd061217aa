"""A run in parts that are so short in wall-clock time that the host, and above all the user, can interrupt in between.

The parts do not change the run: its trace is the same as without them.

Python's default for Ctrl-C is a KeyboardInterrupt between any two steps of the running code, perhaps in the kernel
while it takes a task from a queue. After that the run could not continue, and its tasks could not be ended. So such a
signal waits until the part is over.
"""

from __future__ import annotations

import signal
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any

from cfepy.interpreter.host_system import interrupt_once, signal_number

FIRST_PIECE_NS = 10_000_000  # virtual time
LEAST_PIECE_NS = 1_000_000
SHORT_NS, LONG_NS = 80_000_000, 250_000_000  # wall time that a part should take
_handler_of: Callable[[int], Any] = getattr(signal.getsignal, "__wrapped__", signal.getsignal)
"""The function in C, which creates no enum; it is called before each part."""


_SIGNALS = tuple(filter(None, map(signal_number, ("SIGINT", "SIGTERM", "SIGHUP"))))
_RAISING = (signal.default_int_handler, interrupt_once)


def is_to_be_held_back() -> bool:
    """Return whether Python would raise a KeyboardInterrupt for a signal, so that `HeldBack` is needed."""
    return any(_handler_of(each) in _RAISING for each in _SIGNALS)


class PieceLength:
    """The length of a part, adapted to the time of earlier parts.

    Attributes:
        ns: virtual time of the next part.
    """

    def __init__(self) -> None:
        self.ns = FIRST_PIECE_NS

    def took(self, length_ns: int, wall_ns: int) -> None:
        """Adapt the length after a part, from its virtual time and its wall-clock time."""
        if wall_ns > LONG_NS:
            self.ns = max(LEAST_PIECE_NS, self.ns // 2)
        elif wall_ns < SHORT_NS and length_ns >= self.ns:
            self.ns *= 2


class HeldBack:
    """A context manager that holds back Ctrl-C, and other signals that raise a KeyboardInterrupt.

    The KeyboardInterrupt is raised at the end, unless another error is. A second signal is not held back, except
    SIGHUP, because the code inside may never end. Signals with another handler, and signals outside the main thread,
    are left alone.

    Attributes:
        asked: whether a signal arrived.
        is_first: whether signals are held back here; False if an outer one already does.
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
            pass  # not the main thread: it gets no signals
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
