"""`cfepy replay` with --break, --step, --pdb, --gdb or --back: the debugger for these options."""

from __future__ import annotations

import argparse
import io
import os
import pickle
import signal
import sys
from collections.abc import Callable, Sequence
from typing import Any, TextIO, cast

from cfepy.attachment import Attachment
from cfepy.cli.display import Display, PlainDisplay, SilentDisplay
from cfepy.cli.main import ENDED_WELL
from cfepy.cli.run.outputs import Outputs
from cfepy.cli.run.run import View, fly_again
from cfepy.cli.user_notes import tell
from cfepy.extra.debugger import Debugger, GdbSession, Journey, Keepers
from cfepy.journal import Replay
from cfepy.mission import CORE_APPS, MissionSpec
from cfepy.pilot import Flown
from cfepy.reading.suggestions import expected
from cfepy.rtos import GREENLET, task_kind
from cfepy.status import UsageError
from cfepy.units import NS_PER_S


def fly_with_debugger(
    arguments: argparse.Namespace, replay: Replay, view: View, looking_on: Sequence[Attachment]
) -> tuple[int, Replay]:
    """Fly a replay that stops, and fly it again whenever its user goes back.

    Args:
        arguments: of `cfepy replay`.
        replay: the replay.
        view: its output for the user.
        looking_on: other observers of each flight.

    Returns:
        The exit status, and the last of the replays.
    """
    if arguments.gdb is not None and (arguments.back or arguments.back_to is not None):
        raise UsageError("cannot be combined with --gdb", field="--back")
    if _may_fork(arguments, replay):
        return _in_other_processes(replay, lambda keepers: _fly_all(arguments, replay, view, looking_on, keepers))
    return _fly_all(arguments, replay, view, looking_on, None)


def _fly_all(
    arguments: argparse.Namespace,
    replay: Replay,
    view: View,
    looking_on: Sequence[Attachment],
    keepers: Keepers | None,
) -> tuple[int, Replay]:
    """Make all flights in this process. With keepers, another process may return from this call."""
    journey = None if arguments.gdb is not None else Journey(arguments.back, arguments.back_to)
    while True:
        debugger = debugger_of(arguments, replay, journey, keepers)
        replay.attachments.append(debugger)
        status = fly_again(arguments, replay, DebugView(view, journey))
        if journey is None or not journey.flies_again:
            break
        journey.flies_again = False
        replay = replay.anew()
        replay.attachments += looking_on
    if journey is not None and journey.is_silent:
        tell(["cannot go back: the second run did not reach this point, so the run is not deterministic"])
    tell(debugger.missed)
    return status, replay


def _may_fork(arguments: argparse.Namespace, replay: Replay) -> bool:
    """Return True if processes may be forked during the run, so that going back is fast."""
    wanted = arguments.back or arguments.back_to is not None
    writes = arguments.bag is not None or arguments.trace is not None  # while the run goes on
    is_alone = task_kind(replay.plan.tasks).name == GREENLET and arguments.pdb is None and hasattr(os, "fork")
    return wanted and is_alone and not writes and sys.stdin is sys.__stdin__


def _in_other_processes(replay: Replay, flights: Callable[[Keepers], tuple[int, Replay]]) -> tuple[int, Replay]:
    """Fly in a child of this process, or in its forks, and receive the result here.

    Raises:
        UsageError: a flight raised it, or the process of the run ended.
    """
    reader, writer = os.pipe()
    sys.stdout.flush()
    sys.stderr.flush()
    child = os.fork()
    if not child:
        os.close(reader)
        _tell_parent(writer, flights)
    os.close(writer)
    usual = signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that flies
    with open(reader, "rb") as told:
        answer = told.read()
    signal.signal(signal.SIGINT, usual)
    os.waitpid(child, 0)
    if not answer:
        raise UsageError("the process of the run ended unexpectedly", field="--back")
    status, verdict, problems, error = pickle.loads(answer)
    if error is not None:
        raise UsageError(error)
    replay.verdict, replay.problems = verdict, problems
    return status, replay


def _tell_parent(writer: int, flights: Callable[[Keepers], tuple[int, Replay]]) -> None:
    """Fly, send the result to the waiting process, and end."""
    keepers = Keepers()
    try:
        status, last = flights(keepers)
        answer: tuple[Any, ...] = (status, last.verdict, last.problems, None)
    except UsageError as error:
        answer = (0, None, None, str(error))
    keepers.dismiss()
    sys.stdout.flush()
    sys.stderr.flush()
    with open(writer, "wb") as told:
        told.write(pickle.dumps(answer))
    os._exit(0)


def debugger_of(
    arguments: argparse.Namespace, replay: Replay, journey: Journey | None, keepers: Keepers | None
) -> Debugger:
    """Return the debugger for a replay.

    Args:
        arguments: of `cfepy replay`; with --step, --pdb or --gdb, --until is the time of the first stop, not the end.
        replay: the replay.
        journey: the state that its flights share; None for no way back.
        keepers: processes that shorten the way back; None for none.

    Raises:
        UsageError: an invalid breakpoint, or an unknown application.
    """
    spec = replay.stage.spec()
    if arguments.pdb is not None and arguments.gdb is not None:
        raise UsageError("cannot be combined with --pdb", field="--gdb")
    app = None if arguments.pdb is None else _application(arguments.pdb, spec, "--pdb")
    gdb = None
    if arguments.gdb is not None:
        app = _application(arguments.gdb, spec, "--gdb")
        gdb = GdbSession(app)
    from_ns = None if arguments.until is None or arguments.stops else round(arguments.until * NS_PER_S)
    return Debugger(
        spec,
        stops=arguments.stops,
        step=arguments.step,
        app=app,
        from_ns=from_ns,
        gdb=gdb,
        on_quit=replay.end_here,
        root=replay.stage.root,
        journey=journey,
        keepers=keepers,
        commands=None if keepers is None else cast("TextIO", _Typed()),
    )


def _application(name: str, spec: MissionSpec, option: str) -> str:
    """Return the cFE name of the application or node that a user names."""
    apps = [entry.name for entry in spec.entries]
    nodes = {config.name: app for app, config in spec.ros.nodes.items() if config.name is not None}
    plain = name.lstrip("/")
    for app in (name, nodes.get(plain), plain.upper()):  # a self-named node's application: its file in capitals
        if app in apps or app in CORE_APPS:
            return str(app)
    known = [*apps, *nodes]
    raise UsageError(f"unknown application {name!r}; {expected(plain, known)}", field=option)


class DebugView(View):
    """The output of a run that stops: no status line, which would overwrite the debugger's output.

    Args:
        view: the view without a debugger.
        journey: of the replay; output that its user has seen before is not shown again.
    """

    def __init__(self, view: View, journey: Journey | None) -> None:
        super().__init__(view.arguments)
        self._view = view
        self._journey = journey

    def display(self, seconds: float) -> Display:
        return SilentDisplay() if self.hides_console else _LateDisplay(sys.stdout, self._journey)

    def report(self, flown: Flown) -> None:
        self._view.report(flown)

    def end(self, flown: Flown, outputs: Outputs, longer: str) -> int:
        if self._journey is not None and self._journey.flies_again:
            return ENDED_WELL
        return self._view.end(flown, outputs, longer)


class _LateDisplay(PlainDisplay):
    """Lines, without those that come while a replay is on its way back to the user's target.

    Args:
        stream: the output.
        journey: of the replay.
    """

    def __init__(self, stream: TextIO, journey: Journey | None) -> None:
        super().__init__(stream)
        self._journey = journey

    def line(self, text: str) -> None:
        if self._journey is None or not self._journey.is_silent:
            super().line(text)


class _Typed(io.TextIOBase):
    """Typed input, read line by line, because another process would not see input that one process has read ahead."""

    def readline(self, size: int = -1, /) -> str:  # type: ignore[override]  # only whole lines are asked for
        """Return the next line; empty at the end."""
        line = b""
        while not line.endswith(b"\n") and (more := os.read(0, 1)):
            line += more
        return line.decode(errors="replace")

    def isatty(self) -> bool:
        return os.isatty(0)
