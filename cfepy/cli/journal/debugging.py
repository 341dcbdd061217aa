"""`cfepy replay` with --break, --step, --pdb, --gdb or --back: the debugger that the command line asks for."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import TextIO

from cfepy.attachment import Attachment
from cfepy.cli.display import Display, PlainDisplay, SilentDisplay
from cfepy.cli.failures import tell
from cfepy.cli.main import ENDED_WELL
from cfepy.cli.run.outputs import Outputs
from cfepy.cli.run.run import View, fly_again
from cfepy.debugger import Debugger, GdbSession, Journey
from cfepy.journal import Replay
from cfepy.mission import CORE_APPS, MissionSpec
from cfepy.pilot import Flown
from cfepy.status import UsageError
from cfepy.suggestions import did_you_mean
from cfepy.units import NS_PER_S


def fly_with_debugger(
    arguments: argparse.Namespace, replay: Replay, view: View, looking_on: Sequence[Attachment]
) -> tuple[int, Replay]:
    """Fly a replay that stops, and fly it again whenever its user goes back.

    Args:
        arguments: of `cfepy replay`.
        replay: the replay.
        view: what is shown of it.
        looking_on: what else watches each flight.

    Returns:
        The exit status, and the last of the replays.
    """
    if arguments.gdb is not None and (arguments.back or arguments.back_to is not None):
        raise UsageError("gdb stays in one flight, and there is no way back from it", field="--back")
    journey = None if arguments.gdb is not None else Journey(arguments.back, arguments.back_to)
    while True:
        debugger, shown = debugger_of(arguments, replay, journey), DebugView(view, journey)
        replay.attachments.append(debugger)
        status = fly_again(arguments, replay, shown)
        if journey is None or not journey.flies_again:
            break
        journey.flies_again = False
        replay = replay.anew()
        replay.attachments += looking_on
    if journey is not None and journey.is_silent:
        tell(["the run did not come there again: it goes another way each time, and there is no way back in it"])
    tell(debugger.missed)
    return status, replay


def debugger_of(arguments: argparse.Namespace, replay: Replay, journey: Journey | None) -> Debugger:
    """The debugger for a replay.

    Args:
        arguments: of `cfepy replay`; with --step, --pdb or --gdb, --until is where the first stop is, not the end.
        replay: the replay.
        journey: what its flights have in common; None for no way back.

    Raises:
        UsageError: a breakpoint that cannot be, or an application that there is not.
    """
    spec = replay.stage.spec()
    if arguments.pdb is not None and arguments.gdb is not None:
        raise UsageError("one debugger at a time: --pdb or --gdb", field="--gdb")
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
    )


def _application(name: str, spec: MissionSpec, option: str) -> str:
    """The cFE name of the application or node that a user means."""
    apps = [entry.name for entry in spec.entries]
    nodes = {config.name: app for app, config in spec.ros.nodes.items() if config.name is not None}
    plain = name.lstrip("/")
    for app in (name, nodes.get(plain), plain.upper()):  # a node that names itself has its file's name in capitals
        if app in apps or app in CORE_APPS:
            return str(app)
    known = [*apps, *nodes]
    hint = did_you_mean(plain, known, f"there are {', '.join(known)}")
    raise UsageError(f"the mission has no application {name!r}; {hint}", field=option)


class DebugView(View):
    """What a person sees of a run that stops: no status line, which would write over what the debugger says.

    Args:
        view: the view without a debugger.
        journey: of the replay; what its user has seen before is not shown again.
    """

    def __init__(self, view: View, journey: Journey | None) -> None:
        super().__init__(view.quiet)
        self._view = view
        self._journey = journey

    def display(self, seconds: float) -> Display:
        """See `View.display`."""
        return SilentDisplay() if self.quiet else _LateDisplay(sys.stdout, self._journey)

    def report(self, flown: Flown) -> None:
        """See `View.report`."""
        self._view.report(flown)

    def end(self, flown: Flown, outputs: Outputs, longer: str) -> int:
        """See `View.end`."""
        if self._journey is not None and self._journey.flies_again:
            return ENDED_WELL
        return self._view.end(flown, outputs, longer)


class _LateDisplay(PlainDisplay):
    """Lines, but for those that come while a replay is on its way to where its user wants to be.

    Args:
        stream: where to.
        journey: of the replay.
    """

    def __init__(self, stream: TextIO, journey: Journey | None) -> None:
        super().__init__(stream)
        self._journey = journey

    def line(self, text: str) -> None:
        """See `Display.line`."""
        if self._journey is None or not self._journey.is_silent:
            super().line(text)
