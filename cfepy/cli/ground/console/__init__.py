"""`cfepy console`: an interactive ground console, for a mission that is flown meanwhile, or for any computer over UDP.

`session` carries out lines. `flown_craft` and `remote` are the targets. `pages` lays out telemetry. `completion`
completes lines. `saved` keeps the packets that were sent. `screen` and `plain` are its two user interfaces.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib.util import find_spec
from typing import TYPE_CHECKING, NamedTuple

from cfepy.cli import flight_add_ons
from cfepy.cli.flight_options import check_pace
from cfepy.cli.ground.command_target import RemoteHost, host_of
from cfepy.cli.ground.console.pages import PacketBoard
from cfepy.cli.ground.console.saved import SavedScript
from cfepy.cli.ground.console.session import REPLY, ConsoleSession
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.options import plan_of, refuse_run_options
from cfepy.cli.run.run import told_problems
from cfepy.cli.text_table import show_tables
from cfepy.cli.user_notes import check_writable, note, tell
from cfepy.cli.watched_host import Interrupts
from cfepy.ground import CI_PORT, TO_PORT, dictionary_of, packet_of
from cfepy.io import TypedLines, live_flight, live_name, own_address, send
from cfepy.mission import MissionSpec, read_mission
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.cli.ground.console.flown_craft import FlownCraft
    from cfepy.cli.ground.console.remote import ComputerLink
    from cfepy.pilot import Flown, RunPlan

ANY_ADDRESS = "0.0.0.0"
EXTRA = "the console on a terminal requires the package textual: pip install 'cfepy[console]'; or use --plain"


class Ended(NamedTuple):
    """The result of a session: lines for the user, the problems found, and the exit status."""

    lines: list[str]
    problems: list[str]
    status: int


class Opening:
    """Opens the session that a command line asks for.

    Args:
        arguments: the command line.
        interrupts: reports whether Ctrl-C was pressed.

    Attributes:
        ended: the result of the session; set when it is closed.
    """

    def __init__(self, arguments: argparse.Namespace, interrupts: Interrupts) -> None:
        self.ended: Ended
        self._arguments = arguments
        self._interrupts = interrupts
        if arguments.save_script is not None:
            check_writable(arguments.save_script, "--save-script")

    @contextlib.contextmanager
    def session(self, note: Callable[[str], object]) -> Iterator[ConsoleSession]:
        """Open the session as a context manager. The thread that enters it must also advance time and leave it.

        Args:
            note: receives messages for the user before the run starts.

        Raises:
            UsageError: the options do not allow a session.
        """
        arguments = self._arguments
        live = None if arguments.mission is None else live_name(arguments.mission)
        if live is not None:
            opened = self._attached(live)
        else:
            opened = self._remote() if arguments.udp is not None else self._flown(note)
        with opened as session:
            yield session

    # -- a mission -----------------------------------------------------------------------------------------------------

    @contextlib.contextmanager
    def _flown(self, note: Callable[[str], object]) -> Iterator[ConsoleSession]:
        from cfepy.cli.ground.console.flown_craft import FlownCraft
        from cfepy.cli.run.outputs import recording

        arguments = self._arguments
        plan = replace(plan_of(arguments, [arguments.mission]), script=None)
        with recording(arguments, plan) as journal:
            spec = plan.spec()
            dictionary = dictionary_of(spec)
            saved = SavedScript(dictionary)
            with (
                flight_add_ons.FlightAddOns(arguments, spec.name, note) as add_ons,
                FlownCraft(
                    plan,
                    spec,
                    dictionary,
                    saved,
                    self._interrupts,
                    realtime=arguments.realtime,
                    ports=dict(arguments.port),
                    add_ons=add_ons,
                    journal=journal,
                    note=note,
                ) as craft,
            ):
                session = ConsoleSession(
                    craft, PacketBoard(dictionary), saved, arguments.realtime, arguments.stop_on_failure
                )
                if arguments.script is not None:
                    session.load(arguments.script)
                yield session
                self.ended = self._land(session, craft, plan, add_ons)

    def _land(
        self, session: ConsoleSession, craft: FlownCraft, plan: RunPlan, add_ons: flight_add_ons.FlightAddOns
    ) -> Ended:
        end_ns = craft.stands_ns
        session.end()
        flown = craft.land()
        tables = io.StringIO()
        show_tables(add_ons.tables(flown), tables)
        lines = tables.getvalue().splitlines()
        if self._arguments.save_script is not None:
            lines.append(f"again: {self._save(session, plan, end_ns)}")
        lines.append(f"trace: {flown.trace}")
        return Ended(
            lines,
            [*told_problems(flown), *flown.results.never_happened],
            self._status(session, flown),
        )

    def _save(self, session: ConsoleSession, plan: RunPlan, end_ns: int) -> str:
        """Write the script. Returns the command that repeats the run with it."""
        file = self._arguments.save_script
        again = replace(plan, seconds=None, script=file, stop_on_failure=False).command_line()
        session.saved.heading = ("What was sent in a session of cfepy console. The same run:", again)
        session.saved.write(file, end_ns)
        return again

    def _status(self, session: ConsoleSession, flown: Flown | None) -> int:
        if self._interrupts.asked:
            return INTERRUPTED
        went_wrong = flown is not None and flown.results.problems
        return FOUND_PROBLEMS if session.failed or went_wrong else ENDED_WELL

    # -- a remote target -----------------------------------------------------------------------------------------------

    @contextlib.contextmanager
    def _remote(self) -> Iterator[ConsoleSession]:
        from cfepy.cli.ground.console.remote import UdpLink

        arguments = self._arguments
        host = host_of(arguments.udp, CI_PORT) or RemoteHost(arguments.udp, CI_PORT)
        listen = _listening(arguments.listen)
        spec: MissionSpec | None = None if arguments.names is None else read_mission(arguments.names)
        link = UdpLink(host, listen)

        def greet(session: ConsoleSession) -> None:
            session.say(REPLY, f"commands go to {host}, telemetry comes to port {link.port}")
            self._enable(session, host)

        with self._linked(link, spec, greet) as session:
            yield session

    @contextlib.contextmanager
    def _attached(self, name: str) -> Iterator[ConsoleSession]:
        """Open a session with the flight of another terminal."""
        from cfepy.cli.ground.console.remote import LiveLink

        flight = live_flight(name)
        spec = read_mission(self._arguments.names or flight.script)
        greeting = f"attached to {flight.mission}; commands go to its Software Bus"
        with self._linked(LiveLink(flight), spec, lambda session: session.say(REPLY, greeting)) as session:
            yield session

    @contextlib.contextmanager
    def _linked(
        self, link: ComputerLink, spec: MissionSpec | None, greet: Callable[[ConsoleSession], object]
    ) -> Iterator[ConsoleSession]:
        """Open a session over a connection, which it closes; `greet` begins it."""
        from cfepy.cli.ground.console.remote import RemoteCraft

        arguments = self._arguments
        dictionary = dictionary_of(spec)
        saved = SavedScript(dictionary)
        with RemoteCraft(link, spec, dictionary, saved, self._interrupts) as craft:
            session = ConsoleSession(craft, PacketBoard(dictionary), saved, stop_on_failure=arguments.stop_on_failure)
            greet(session)
            if arguments.script is not None:
                session.load(arguments.script)
            yield session
            end_ns = craft.stands_ns
            session.end()
            lines = []
            if arguments.save_script is not None:
                session.saved.write(arguments.save_script, end_ns)
                lines.append(f"{arguments.save_script}: {session.saved.count} commands")
            self.ended = Ended(lines, [], self._status(session, None))

    def _enable(self, session: ConsoleSession, host: RemoteHost) -> None:
        """Ask TO_LAB to send to this computer, or show the user how to do it."""
        asked: str | None = self._arguments.enable
        elsewhere = (host_of(asked, CI_PORT) or RemoteHost(asked, CI_PORT)) if asked else host
        enable = f"TO_LAB_OUTPUT_ENABLE dest_IP={own_address(elsewhere.name)}"
        if asked is None:
            session.say(REPLY, f"TO_LAB sends no telemetry until you enable it: {enable}")
        elif elsewhere == host:
            session.take(enable)
        else:
            dictionary = session.craft.script.scene.dictionary
            packet = packet_of(dictionary.command("TO_LAB_OUTPUT_ENABLE"), enable.split()[1:])
            if not send(elsewhere.name, elsewhere.port, packet):
                raise UsageError(
                    "no receiver is listening, so telemetry cannot be enabled; start the mission first",
                    file=str(elsewhere),
                )


def _listening(text: str | None) -> RemoteHost:
    """Parse the telemetry address: "HOST:PORT", "HOST", "PORT" or None."""
    if text is None:
        return RemoteHost(ANY_ADDRESS, TO_PORT)
    if text.isdecimal():
        text = f"{ANY_ADDRESS}:{text}"
    host = host_of(text, TO_PORT)
    if host is None:
        raise UsageError(
            f"invalid address {text!r}; expected an address of this computer, such as 127.0.0.1:1235", field="--listen"
        )
    return host


def run(arguments: argparse.Namespace) -> int:
    """Open the console that the command line asks for.

    Returns:
        The exit status.

    Raises:
        UsageError: the options do not allow a session.
    """
    _check(arguments)
    with Interrupts() as interrupts:
        opening = Opening(arguments, interrupts)
        if arguments.plain or not is_terminal():
            _plain(opening)
        else:
            _screen(opening)
    ended = opening.ended
    for line in ended.lines:
        print(line, flush=True)
    tell(ended.problems)
    return ended.status


def is_terminal() -> bool:
    """Return True if standard input and output are a terminal."""
    return sys.stdin.isatty() and sys.stdout.isatty()


_NOT_OF_A_COMPUTER = (
    ("realtime", "--realtime"),
    ("record", "--record"),
    ("port", "--port"),
)


def _check(arguments: argparse.Namespace) -> None:
    if (arguments.mission is None) == (arguments.udp is None):
        raise UsageError("requires one target: cfepy console MISSION, or cfepy console --udp HOST:PORT")
    is_live = arguments.mission is not None and live_name(arguments.mission) is not None
    if arguments.udp is not None or is_live:
        why = f"only valid for a mission, and {arguments.udp or arguments.mission} is a remote target; leave it out"
        refuse_run_options(arguments, why, but=["script", "stop_on_failure"])
        for name, option in (*_NOT_OF_A_COMPUTER, *flight_add_ons.options()):
            if getattr(arguments, name):
                raise UsageError(why, field=option)
        if not is_live:
            return
    for name in ("listen", "enable"):
        if getattr(arguments, name) is not None:
            raise UsageError("only valid with --udp; leave it out", field=f"--{name}")
    if arguments.names is not None and not is_live:
        raise UsageError("only valid with --udp; a local mission brings its own names", field="--mission")
    check_pace(arguments)


def _plain(opening: Opening) -> None:
    from cfepy.cli.ground.console.plain import PlainConsole

    with opening.session(note) as session:
        console = PlainConsole(session, TypedLines(sys.stdin), sys.stdout)
        console.run()
    console.print()


def _screen(opening: Opening) -> None:
    if find_spec("textual") is None:
        raise UsageError(EXTRA)
    from cfepy.cli.ground.console.screen import ConsoleScreen

    ConsoleScreen(opening.session).show()
