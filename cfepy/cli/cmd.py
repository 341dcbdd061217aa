"""`cfepy cmd`: send a command by its name to a flight computer, or fly a mission for it and show what it causes."""

from __future__ import annotations

import argparse
import sys
from fnmatch import fnmatchcase

from cfepy.cli.failures import booting
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.table import Table, show_tables
from cfepy.cli.target import Host, check_is_mission, dictionary_for, host_of
from cfepy.io import udp
from cfepy.mission.command_trial import Trial, try_command
from cfepy.mission.dictionary import Dictionary
from cfepy.mission.ground import CI_PORT
from cfepy.mission.spec import read_mission
from cfepy.mission.values import line_of, packet_of
from cfepy.msg import Command
from cfepy.rtos.units import NS_PER_S
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Send, list or show commands.

    Returns:
        The exit status.

    Raises:
        UsageError: no such mission, host, command or field.
    """
    target: str | None = arguments.target
    host = host_of(target, CI_PORT) if target is not None else None
    if target is not None and host is None:
        check_is_mission(target)
    mission = arguments.mission if host is not None or target is None else target
    dictionary = dictionary_for(mission)
    if arguments.list is not None:
        return _list(dictionary, arguments.list)
    if arguments.show is not None:
        return _show(dictionary.command(arguments.show))
    if target is None or arguments.name is None:
        raise UsageError("say where to, and which command: cfepy cmd MISSION|HOST NAME; --list shows the names")
    declared = dictionary.command(arguments.name)
    packet = packet_of(declared, arguments.fields)
    if arguments.hex:
        print(packet.hex())
        return ENDED_WELL
    if host is not None:
        return _send(host, declared, packet)
    return _fly(target, dictionary, declared, packet, arguments.seconds)


def _send(host: Host, declared: Command, packet: bytes) -> int:
    if not udp.send(host.name, host.port, packet):
        print(f"cfepy: {host}: nobody listens there; {declared.name} is lost", file=sys.stderr)
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
    table = Table(f"{declared.name}: {declared.text}", ("field", "type", "offset", "bytes"), right=(2, 3))
    offset = declared.length - declared.payload.size
    for cell in declared.payload.cells():
        table.add(cell.path, cell.type, str(offset + cell.offset), str(cell.size))
    table.note = f"MsgId 0x{declared.msg_id:04X}, function code {_code(declared)}, {declared.length} bytes"
    show_tables([table], sys.stdout)
    return ENDED_WELL


def _code(declared: Command) -> str:
    return "none" if declared.code is None else str(declared.code)


def _say_problems(dictionary: Dictionary) -> None:
    for problem in dictionary.problems:
        print(f"cfepy: {problem}", file=sys.stderr)


def _fly(target: str, dictionary: Dictionary, declared: Command, packet: bytes, seconds: float) -> int:
    spec = read_mission(target)
    with booting(spec.script):
        trial = try_command(spec, dictionary, packet, seconds)
    print(f"{trial.sent_ns / NS_PER_S:.3f} {declared.name} sent to {', '.join(trial.receivers) or 'nobody'}")
    _say_what_followed(trial, dictionary)
    sys.stdout.flush()
    for problem in trial.problems:
        print(f"cfepy: {problem}", file=sys.stderr)
    return ENDED_WELL if trial.receivers and not trial.errors and not trial.problems else FOUND_PROBLEMS


def _say_what_followed(trial: Trial, dictionary: Dictionary) -> None:
    for event in trial.events:
        print(f"{event.at_ns / NS_PER_S:.3f} {event.app} {event.event_id} {event.type_name}: {event.text}")
    for seen in trial.telemetry:
        decoded = dictionary.decode(seen.packet)
        print(f"{seen.at_ns / NS_PER_S:.3f} {decoded.name} {decoded.problem or line_of(decoded.values)}")
