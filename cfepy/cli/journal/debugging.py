"""`cfepy replay` with --break, --step, --pdb or --gdb: the debugger that the command line asks for."""

from __future__ import annotations

import argparse
import sys

from cfepy.cli.display import Display, PlainDisplay, SilentDisplay
from cfepy.cli.run.outputs import Outputs
from cfepy.cli.run.run import View
from cfepy.debugger import Debugger, GdbSession
from cfepy.journal import Replay
from cfepy.mission import CORE_APPS, MissionSpec
from cfepy.pilot import Flown
from cfepy.status import UsageError
from cfepy.suggestions import did_you_mean
from cfepy.units import NS_PER_S


def debugger_of(arguments: argparse.Namespace, replay: Replay) -> Debugger:
    """The debugger for a replay.

    Args:
        arguments: of `cfepy replay`; with --step, --pdb or --gdb, --until is where the first stop is, not the end.
        replay: the replay.

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
    """

    def __init__(self, view: View) -> None:
        super().__init__(view.quiet)
        self._view = view

    def display(self, seconds: float) -> Display:
        """See `View.display`."""
        return SilentDisplay() if self.quiet else PlainDisplay(sys.stdout)

    def report(self, flown: Flown) -> None:
        """See `View.report`."""
        self._view.report(flown)

    def end(self, flown: Flown, outputs: Outputs, longer: str) -> int:
        """See `View.end`."""
        return self._view.end(flown, outputs, longer)
