"""`cfepy cmd`: send a command by its name to a flight computer, or fly a mission for it and show its effects."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from fnmatch import fnmatchcase

from cfepy.cli.ground.command_target import RemoteHost, check_is_mission, dictionary_for, host_of
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.options import LONGEST_S, plan_of, refuse_run_options
from cfepy.cli.text_table import Table, show_paragraph, show_tables
from cfepy.cli.user_notes import tell, tell_briefly
from cfepy.ground import CI_PORT, EVENT_IDS, CommandTrial, DecodedEvent, Dictionary, dictionary_of, packet_of
from cfepy.io import live_flight, live_name, udp
from cfepy.mission import Seen, TopicMessage, read_mission
from cfepy.msg import Command
from cfepy.pilot import RunPlan, never_happened, takeoff
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

ANSWER_S = 2.0  # virtual time to wait for the effects of a command
COMPANY_S = 5.0  # and for a receiver, counted from when all processors are on: they have to find each other


def run(arguments: argparse.Namespace) -> int:
    """Send, list or show commands.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such mission, host, command or field.
    """
    target: str | None = arguments.target
    live = None if target is None else live_name(target)
    if live is not None:
        return _attach(live, arguments)
    host = host_of(target, CI_PORT) if target is not None else None
    plan = None
    if target is not None and host is None:
        check_is_mission(target)
        plan = plan_of(arguments, [target])
    dictionary = dictionary_for(arguments.mission) if plan is None else dictionary_of(plan.spec())
    if arguments.list is not None:
        return _list(dictionary, arguments.list)
    if arguments.show is not None:
        return _show(dictionary.command(arguments.show))
    if target is None or arguments.name is None:
        raise UsageError("missing target or command name: cfepy cmd MISSION|HOST NAME; --list shows the command names")
    declared = dictionary.command(arguments.name)
    packet = packet_of(declared, arguments.fields)
    if arguments.hex:
        print(packet.hex())
        return ENDED_WELL
    if host is not None:
        refuse_run_options(arguments, f"only valid for a mission, and {host} is a remote target; leave it out")
        return _send(host, declared, packet)
    assert plan is not None
    return _fly(plan, dictionary, declared, packet)


def _attach(name: str, arguments: argparse.Namespace) -> int:
    """Send a command to a running flight, and show the events of the next seconds."""
    refuse_run_options(arguments, "only valid for a mission to be run; leave it out", but=["seconds"])
    if arguments.name is None:
        raise UsageError("missing command name; cfepy cmd MISSION --list shows the command names")
    with live_flight(name) as flight:
        dictionary = dictionary_of(read_mission(arguments.mission or flight.script))
        declared = dictionary.command(arguments.name)
        flight.listen(telemetry=sorted(EVENT_IDS))
        answer = flight.ask({"op": "send", "packet": packet_of(declared, arguments.fields)})
        receivers = ", ".join(answer["receivers"]) or "no receiver"
        print(f"{answer['at_ns'] / NS_PER_S:.3f} {declared.name} sent to {receivers}")
        errors = 0
        for message in flight.messages(ANSWER_S if arguments.seconds is None else arguments.seconds):
            if not isinstance(message, TopicMessage):
                packet, at_ns = message
                event = DecodedEvent.of(Seen(at_ns, packet, ""))
                errors += event.type_name in ("ERROR", "CRITICAL")
                show_paragraph(_event_line(event), sys.stdout)
                sys.stdout.flush()
    return ENDED_WELL if answer["receivers"] and not errors else FOUND_PROBLEMS


def _event_line(event: DecodedEvent) -> str:
    return f"{event.at_ns / NS_PER_S:.3f} {event.app} {event.event_id} {event.type_name}: {event.text}"


def _send(host: RemoteHost, declared: Command, packet: bytes) -> int:
    if not udp.send(host.name, host.port, packet):
        print(f"cfepy: {host}: no receiver is listening; {declared.name} was not delivered", file=sys.stderr)
        return FOUND_PROBLEMS
    print(f"{declared.name} sent to {host}, {len(packet)} bytes")
    return ENDED_WELL


def _list(dictionary: Dictionary, pattern: str) -> int:
    table = Table("Commands", ("name", "MsgId", "code", "what it does"), right=(2,))
    for name, each in sorted(dictionary.commands.items()):
        if fnmatchcase(name, pattern.upper()):
            table.add(name, f"0x{each.msg_id:04X}", _code(each), each.text)
    show_tables([table], sys.stdout)
    _say_problems(dictionary)
    return ENDED_WELL if table.rows else FOUND_PROBLEMS


def _show(declared: Command) -> int:
    table = Table(f"{declared.name}: {declared.text}", ("field", "type", "offset", "bytes", "values"), right=(2, 3))
    offset = declared.length - declared.payload.size
    for cell in declared.payload.cells():
        names = "" if cell.names is None else str(cell.names)
        table.add(cell.path, cell.type, str(offset + cell.offset), str(cell.size), names)
    table.note = f"MsgId 0x{declared.msg_id:04X}, function code {_code(declared)}, {declared.length} bytes"
    show_tables([table], sys.stdout)
    return ENDED_WELL


def _code(declared: Command) -> str:
    return "none" if declared.code is None else str(declared.code)


def _say_problems(dictionary: Dictionary) -> None:
    for problem in dictionary.problems:
        print(f"cfepy: {problem}", file=sys.stderr)


def _fly(plan: RunPlan, dictionary: Dictionary, declared: Command, packet: bytes) -> int:
    """Fly a mission until it is OPERATIONAL, send the command, and show its effects for the seconds of the plan."""
    trial = CommandTrial(dictionary, packet)
    seconds = ANSWER_S if plan.seconds is None else plan.seconds
    with takeoff(replace(plan, seconds=LONGEST_S), attachments=[trial]) as run:
        tell_briefly(run.notes)
        trial.run(run.run_until, seconds, _patience(plan))
        problems = run.problems()
        unstruck = never_happened(run.mission)
    print(f"{trial.sent_ns / NS_PER_S:.3f} {declared.name} sent to {', '.join(trial.receivers) or 'no receiver'}")
    _say_what_followed(trial, dictionary)
    tell((*problems, *unstruck))
    return ENDED_WELL if trial.receivers and not trial.errors and not problems else FOUND_PROBLEMS


def _patience(plan: RunPlan) -> float:
    companions = plan.companions()
    return COMPANY_S + max(begins_ns for *_, begins_ns in companions) / NS_PER_S if companions else 0


def _say_what_followed(trial: CommandTrial, dictionary: Dictionary) -> None:
    for event in trial.events:
        show_paragraph(_event_line(event), sys.stdout)
    for seen in trial.telemetry:
        decoded = dictionary.decode(seen.packet)
        show_paragraph(f"{seen.at_ns / NS_PER_S:.3f} {decoded.name} {decoded.problem or decoded.line()}", sys.stdout)
