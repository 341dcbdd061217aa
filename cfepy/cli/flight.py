"""A run in pieces: between two of them the display is brought up to date, and Ctrl-C ends it cleanly.

The pieces change nothing in the run: its trace is that of a run in one piece.
"""

from __future__ import annotations

import contextlib
import gc
import os
import signal
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from cfepy.cli.display import Display
from cfepy.cli.main import INTERRUPTED
from cfepy.mission.course import BROKEN_OFF, OVER, Course
from cfepy.mission.course import INTERRUPTED as INTERRUPTED_BETWEEN
from cfepy.mission.results import Mark
from cfepy.rtos.realtime import Pacer, Stopwatch
from cfepy.rtos.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.io.host_network import HostNetwork
    from cfepy.mission.script_verdicts import Outcome

FIRST_PIECE_NS = 10_000_000
LEAST_PIECE_NS = 1_000_000
PATIENCE_NS = 2 * NS_PER_S  # wall time after the second Ctrl-C in which no other has an effect
STDERR = 2
SHORT_NS, LONG_NS = 80_000_000, 250_000_000  # wall time that a piece should take


class Flight:
    """A run that goes on until its time is over, or until somebody presses Ctrl-C.

    Args:
        course: how long it goes on.
        realtime: pace it to the wall clock, so many times as fast; None runs as fast as it goes.
        display: is told between the pieces.
        interrupts: says whether somebody pressed Ctrl-C.
        bridge: to this computer's network; a paced run has one.
        pause: called between the pieces.

    Attributes:
        mission: the mission.
        trace: the digest; set by `go`.
        broken_off: a task was interrupted in its middle.
    """

    def __init__(
        self,
        course: Course,
        realtime: float | None,
        display: Display,
        interrupts: Interrupts,
        bridge: HostNetwork | None = None,
        pause: Callable[[], object] = lambda: None,
    ) -> None:
        self.mission = course.mission
        self.interrupts = interrupts
        self.trace = ""
        self.broken_off = False
        self._pause = pause
        self._course = course
        self._display = display
        self._piece_ns = FIRST_PIECE_NS
        self._step: Callable[[int], None] = self._free_step
        if realtime is not None and bridge is not None:
            self._step = Pacer(self.mission.kernel, self._bridged(bridge), realtime, bridge.wait).step

    def go(self) -> None:
        """Run, let the nodes shut down, and take down what there is to know before the tasks end."""
        watch = Stopwatch()
        try:
            stop_ns = self._course.next_stop()
            while self._course.goes_on and not self.interrupts.asked:
                self._step(stop_ns)
                self._pause()
                self._display.update(self.mission)
                stop_ns = self._course.next_stop()
            self._course.end(watch.elapsed_ns())
            self.mission.shut_down_nodes()
        except KeyboardInterrupt:
            self.broken_off = self.interrupts.asked = (
                True  # also when an app raised it: what it looks like is what it is
            )
            self._course.end(watch.elapsed_ns())
        self.trace = self.mission.finish()

    @property
    def at(self) -> Mark:
        """What there was when the time was over."""
        return self._course.at

    @property
    def reason(self) -> str:
        """How the run has ended (`cfepy.mission.course`)."""
        if self.broken_off:
            return BROKEN_OFF
        return INTERRUPTED_BETWEEN if self.interrupts.asked else OVER

    @property
    def outcome(self) -> Outcome | None:
        """Of the script, None without one."""
        return self._course.outcome

    def _bridged(self, bridge: HostNetwork) -> Callable[[int], None]:
        """Running the mission until a virtual time in ns, then letting in and out what goes over the network."""

        def run_until(until_ns: int) -> None:
            self.mission.run_until(until_ns)
            bridge.exchange()

        return run_until

    def _free_step(self, until_ns: int) -> None:
        """As fast as it goes: a piece of virtual time that takes some 80 to 250 ms of wall time."""
        watch = Stopwatch()
        self.mission.run_until(min(until_ns, self.mission.kernel.now + self._piece_ns))
        wall_ns = watch.elapsed_ns()
        if wall_ns < SHORT_NS:
            self._piece_ns *= 2
        elif wall_ns > LONG_NS:
            self._piece_ns = max(LEAST_PIECE_NS, self._piece_ns // 2)


class Interrupts:
    """What Ctrl-C and SIGTERM do while a mission runs and ends; use as a context manager.

    The first one sets `asked`, for the run to end at the next occasion. The second one raises KeyboardInterrupt, for a
    task that gives no occasion. Any more are ignored for a while: they would disturb the ending of tasks. After that
    the next one ends the process, for a task that nothing can end, such as one that waits in a C library.
    """

    def __init__(self) -> None:
        self.asked = False
        self._count = 0
        self._before: dict[signal.Signals, Any] = {}
        self._since_second = Stopwatch()

    def __enter__(self) -> Interrupts:
        try:
            for each in (signal.SIGINT, signal.SIGTERM):
                self._before[each] = signal.signal(each, self._on_signal)
        except ValueError:
            pass  # not the main thread: signals do not come here
        return self

    def __exit__(self, *error: object) -> None:
        for each, handler in self._before.items():
            signal.signal(each, handler)

    def _on_signal(self, *_: object) -> None:
        self.asked = True
        self._count += 1
        if self._count == 2:
            self._since_second = Stopwatch()
            raise KeyboardInterrupt
        if self._count > 2 and self._since_second.elapsed_ns() > PATIENCE_NS:
            os.write(STDERR, b"cfepy: a task does not end; gave up\n")
            os._exit(INTERRUPTED)


@contextlib.contextmanager
def no_collection() -> Iterator[None]:
    """The kernel collects garbage at fixed virtual times; in the host it would run finalizers at the clock's whim.

    Around the whole life of a mission it saves a process that has only one the look for what is left at its end.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
