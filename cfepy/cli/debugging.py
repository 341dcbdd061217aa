"""`cfepy replay` with --break, --step or --pdb: the debugger that the command line asks for."""

from __future__ import annotations

import argparse
import sys
from difflib import get_close_matches
from typing import TextIO

from cfepy.cli.display import Display, PlainDisplay, SilentDisplay
from cfepy.cli.run import View
from cfepy.debugger.debugger import Debugger
from cfepy.es.startup_script import entries
from cfepy.journal.replay import Replay
from cfepy.mission.mission import Mission
from cfepy.mission.processor import CORE_APPS
from cfepy.mission.results import Results
from cfepy.mission.spec import MissionSpec
from cfepy.rtos.units import NS_PER_S
from cfepy.status import UsageError


def debugger_of(arguments: argparse.Namespace, spec: MissionSpec, replay: Replay) -> Debugger:
    """The debugger for a replay.

    Args:
        arguments: of `cfepy replay`; with --step or --pdb, --until is where the first stop is, not the end.
        spec: the mission.
        replay: the replay.

    Raises:
        UsageError: a breakpoint that cannot be, or an application that there is not.
    """
    app = None if arguments.pdb is None else _application(arguments.pdb, spec)
    from_ns = None if arguments.until is None or arguments.stops else round(arguments.until * NS_PER_S)
    return Debugger(
        spec,
        stops=arguments.stops,
        step=arguments.step,
        app=app,
        from_ns=from_ns,
        on_quit=replay.end_here,
        root=replay.stage.root,
    )


def _application(name: str, spec: MissionSpec) -> str:
    """The cFE name of the application or node that a user means."""
    apps = [entry.name for entry in entries(spec.startup_script)]
    nodes = {config.name: app for app, config in spec.ros.nodes.items() if config.name is not None}
    plain = name.lstrip("/")
    for app in (name, nodes.get(plain), plain.upper()):  # a node that names itself has its file's name in capitals
        if app in apps or app in CORE_APPS:
            return str(app)
    known = [*apps, *nodes]
    near = get_close_matches(plain, known, 1) or get_close_matches(plain.upper(), known, 1)
    hint = f"is {near[0]} meant?" if near else f"there are {', '.join(known)}"
    raise UsageError(f"the mission has no application {name!r}; {hint}", field="--pdb")


class DebugView(View):
    """What a person sees of a run that stops: no status line, which would write over what the debugger says.

    Args:
        view: the view without a debugger.
    """

    def __init__(self, view: View) -> None:
        self._view = view

    def display(self, quiet: bool, seconds: float) -> Display:
        """See `View.display`."""
        return SilentDisplay() if quiet else PlainDisplay(sys.stdout)

    def report(self, results: Results, mission: Mission, stream: TextIO) -> None:
        """See `View.report`."""
        self._view.report(results, mission, stream)
