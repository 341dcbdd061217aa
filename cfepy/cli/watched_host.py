"""The host's side of a run that a person watches: a display, Ctrl-C, the wall clock, this computer's ports.

The run is cut into short steps for that. They do not affect it: its trace is the same as in one step.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from cfepy.cli.display import Display, SilentDisplay
from cfepy.cli.main import FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.options import LONGEST_S
from cfepy.cli.user_notes import note
from cfepy.interpreter.garbage import no_collection
from cfepy.interpreter.host_system import ending_signals, leave_dead_terminal, signal_number
from cfepy.mission import PieceLength
from cfepy.pilot import Host, LiveRun
from cfepy.rtos import Pacer, Stopwatch
from cfepy.units import NS_PER_S
from cfepy.writing.console import Console
from cfepy.writing.escapes import visible

if TYPE_CHECKING:
    from cfepy.cli.flight_add_ons import FlightAddOns
    from cfepy.io import Guest, HostNetwork

PATIENCE_NS = 2 * NS_PER_S  # wall time after the second Ctrl-C during which further ones are ignored
STDERR = 2

MakeDisplay = Callable[[float], Display]


def silent(seconds: float) -> Display:
    """Make a display that shows nothing of a run of so many virtual seconds."""
    return SilentDisplay()


def _show_lines_at_once() -> None:
    """Flush each line of a paced run at once, also into a file or a pipe, because a reader may follow it there."""
    reconfigure = getattr(sys.stdout, "reconfigure", None)
    if reconfigure is not None:
        reconfigure(line_buffering=True)


class WatchedHost(Host):
    """Updates the display between the steps of a run; use as a context manager around it.

    Args:
        interrupts: reports whether Ctrl-C was pressed.
        make_display: makes the display from the length of the run in virtual seconds.
        realtime: speed as a multiple of the wall clock, with the mission's ports open; None runs as fast as possible.
        ports: ports of this computer by the ports of the mission.
        add_ons: add-ons around the run, or None. They are closed at the end of the run.
        pause: called between the steps.
        note: receives messages for the user before the run starts.

    Attributes:
        console: the console for the mission; its lines go to the display.

    If the display cannot be written to, the run ends as by Ctrl-C, and the context raises the error at its end. It
    raises no error if a terminal was closed.
    """

    owns_process = True

    def __init__(
        self,
        interrupts: Interrupts,
        make_display: MakeDisplay = silent,
        *,
        realtime: float | None = None,
        ports: Mapping[int, int] | None = None,
        add_ons: FlightAddOns | None = None,
        pause: Callable[[], object] = lambda: None,
        note: Callable[[str], object] = note,
    ) -> None:
        self.console = Console(sink=self._line)
        self.longest_s = None if realtime is None else LONGEST_S
        self._interrupts = interrupts
        self._make_display = make_display
        self._display: Display = SilentDisplay()
        self._realtime = realtime
        self._ports = ports or {}
        self._add_ons = add_ons
        self._pause = pause
        self._note = note
        self._piece = PieceLength()
        self._watch = Stopwatch()
        self._go: Callable[[int], None] = self._free_piece
        self._bridge = contextlib.ExitStack()
        self._network: HostNetwork | None = None
        self._unshown: OSError | None = None

    @property
    def asked(self) -> bool:
        return self._interrupts.asked

    def __enter__(self) -> WatchedHost:
        no_collection.__enter__()  # once around all steps: no garbage collection between them
        return self

    def __exit__(self, *error: Any) -> None:
        try:
            self._display.close()
        except OSError as why:
            self._stop_showing(why)
        no_collection.__exit__(*error)
        if self._unshown is not None and error[0] is None:
            raise self._unshown

    def begin(self, run: LiveRun) -> None:
        """Begin the run: show the notes for the user before it starts, and open the display and the ports."""
        super().begin(run)
        for each in run.notes:
            self._note(each)
        self._display = self._make_display(run.course.until_ns / NS_PER_S)
        self._watch = Stopwatch()
        if self._realtime is not None:
            _show_lines_at_once()
            self._connect()
            self.pace(self._realtime)

    def step(self, until_ns: int) -> None:
        self._go(until_ns)
        self._pause()
        try:
            self._display.update(self._mission)
        except OSError as error:
            self._stop_showing(error)

    def stand(self) -> None:
        """Stand still between two steps; requests of viewers are answered all the same."""
        for each in self._guests:
            each.exchange()

    def wall_ns(self) -> int:
        """Return the wall time in ns since the run began; see `Host.wall_ns`."""
        return self._watch.elapsed_ns()

    def take_break(self) -> bool:
        """Ask for the end of the run; see `Host.take_break`. An application that raises KeyboardInterrupt has the same
        effect.
        """
        self._interrupts.asked = True
        return True

    def give_up(self, why: BaseException) -> None:
        """End the process without a report, since the thread that would write it does not return."""
        with contextlib.suppress(Exception):
            sys.stdout.flush()
        os.write(
            STDERR,
            f"cfepy: {visible(str(why))}\ncfepy: it cannot be ended; the process exits\n".encode(errors="replace"),
        )
        os._exit(INTERRUPTED if self.asked else FOUND_PROBLEMS)

    def end(self) -> None:
        if self._add_ons is not None:
            self._add_ons.close()
        self._bridge.close()

    def _stop_showing(self, error: OSError) -> None:
        """End the run as by Ctrl-C if the display cannot be written to, so that its output files are complete."""
        self._display = SilentDisplay()
        self._interrupts.asked = True
        if not leave_dead_terminal():
            self._unshown = error

    @property
    def _guests(self) -> list[Guest]:
        return [] if self._add_ons is None else self._add_ons.guests

    def _line(self, text: str) -> None:
        self._display.line(text)

    def _tell(self, text: str) -> None:
        self._display.tell(text)

    def _free_piece(self, until_ns: int) -> None:
        """Run a step as fast as possible."""
        self._run_until(min(until_ns, self._mission.kernel.now + self._piece.ns))

    def pace(self, factor: float | None) -> None:
        """Set the speed as a multiple of the wall clock; None is as fast as possible."""
        kernel, network = self._mission.kernel, self._network
        if factor is None:
            self._go = self._free_piece
            return
        run = self._run_until
        paced = Pacer(kernel, run, factor) if network is None else Pacer(kernel, run, factor, network.wait)
        # A run that falls behind would have ever more to catch up with in one step.
        self._go = lambda until_ns: paced.step(min(until_ns, kernel.now + self._piece.ns))

    def _connect(self) -> None:
        """Open real ports for the mission's ports. Only a run in real time has them and imports the code for them."""
        from cfepy.io import HostNetwork

        self._mission.kernel.context.be_prompt()
        self._network = self._bridge.enter_context(HostNetwork(self._mission, dict(self._ports), self._tell))
        if self._add_ons is not None:
            for each in self._add_ons.connect(self._mission, self._tell):
                self._network.join(each)

    def _run_until(self, until_ns: int) -> None:
        """Run a step. Its length is adapted so that a step takes some 80 to 250 ms of wall time."""
        watch, length_ns = Stopwatch(), until_ns - self._mission.kernel.now
        self._mission.run_until(until_ns)
        self._piece.took(length_ns, watch.elapsed_ns())
        if self._network is None:
            self.stand()
        else:
            self._network.exchange()


class Interrupts:
    """Handles Ctrl-C, SIGTERM and SIGHUP while a mission runs and ends; use as a context manager.

    The first signal sets `asked`, so that the run ends at the next opportunity. The second one raises
    KeyboardInterrupt, for a task that gives no opportunity. Any more are ignored for a while, because they would
    disturb the ending of tasks. After that the next one ends the process, for a task that cannot be ended, such as one
    that waits in a C library. A terminal that is closed sends SIGHUP two or three times, from its system and its shell,
    so that only the first one counts.
    """

    def __init__(self) -> None:
        self.asked = False
        self._count = 0
        self._before: dict[signal.Signals, Any] = {}
        self._since_second = Stopwatch()

    def __enter__(self) -> Interrupts:
        try:
            for each in ending_signals():
                self._before[each] = signal.signal(each, self._on_signal)
        except ValueError:
            pass  # not the main thread: signals do not arrive here
        return self

    def __exit__(self, *error: object) -> None:
        for each, handler in self._before.items():
            signal.signal(each, handler)

    def _on_signal(self, number: int, _: object) -> None:
        if number == signal_number("SIGHUP"):
            leave_dead_terminal()
            if self.asked:
                return
        self.asked = True
        self._count += 1
        if self._count == 2:
            self._since_second = Stopwatch()
            raise KeyboardInterrupt
        if self._count > 2 and self._since_second.elapsed_ns() > PATIENCE_NS:
            os.write(STDERR, b"cfepy: a task does not end; the process exits\n")
            os._exit(INTERRUPTED)
