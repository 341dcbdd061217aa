"""What the command line understands of the ground's side: cmd, tlm, export. Imports only argparse."""

from __future__ import annotations

import argparse

from cfepy.cli.arguments import MISSION_HELP, count_of, seconds_of

DICTIONARY_HELP = "take names from this mission (default: the services and the apps that cfepy brings along)"


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_cmd(commands)
    _add_tlm(commands)
    _add_export(commands)


def _add_cmd(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    cmd = commands.add_parser(
        "cmd",
        help="send a command by its name, or list the commands",
        description="Send a command to a flight computer, or to a mission that is flown for it in virtual time.",
        epilog="exit status: 0 well, 1 an ERROR or CRITICAL event followed, an application died, or nobody takes it; "
        "2 bad usage",
    )
    cmd.add_argument(
        "target",
        nargs="?",
        metavar="MISSION|HOST[:PORT]",
        help="a mission, or where CI_LAB listens: 127.0.0.1, or any name with a port (default: 1234)",
    )
    cmd.add_argument("name", nargs="?", metavar="NAME", help="such as CFE_ES_NOOP")
    cmd.add_argument("fields", nargs="*", metavar="FIELD=VALUE", help="others are zero")
    cmd.add_argument("--mission", metavar="MISSION", help=DICTIONARY_HELP)
    cmd.add_argument("--list", nargs="?", const="*", metavar="PATTERN", help="list the commands, such as '*_NOOP'")
    cmd.add_argument("--show", metavar="NAME", help="show a command's fields")
    cmd.add_argument("--hex", action="store_true", help="print the command's bytes instead of sending them")
    cmd.add_argument(
        "--for",
        dest="seconds",
        type=seconds_of,
        default=2.0,
        metavar="SECONDS",
        help="virtual seconds to wait for what it causes (default: 2)",
    )
    cmd.set_defaults(module="cmd")


def _add_tlm(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    tlm = commands.add_parser(
        "tlm",
        help="show telemetry by name",
        description="Show telemetry that arrives over UDP, or that of a mission which is flown in virtual time.",
        epilog="exit status: 0 well, 1 no packet came, 2 bad usage, 130 ended by Ctrl-C",
    )
    tlm.add_argument(
        "words",
        nargs="*",
        metavar="[MISSION|HOST[:PORT]] NAME|MID",
        help="a mission, or this computer's address to listen at (default: any, port 1235); the packets (default: all)",
    )
    tlm.add_argument("--mission", metavar="MISSION", help=DICTIONARY_HELP)
    tlm.add_argument("--enable", metavar="HOST[:PORT]", help="ask TO_LAB there to begin to send (default port: 1234)")
    tlm.add_argument("--count", type=count_of, metavar="N", help="end after so many packets")
    tlm.add_argument(
        "--for",
        dest="seconds",
        type=seconds_of,
        metavar="SECONDS",
        help="end after so many seconds (default: a mission flies for 10, else until Ctrl-C)",
    )
    tlm.add_argument("--json", action="store_true", help="a JSON object for each packet, a line each")
    tlm.set_defaults(module="tlm")


def _add_export(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    export = commands.add_parser(
        "export",
        help="write a mission's commands and telemetry for a ground system",
        description="Describe a mission's packets in XTCE 1.2, which ground systems read.",
    )
    export.add_argument("format", choices=("xtce",), help="XTCE 1.2, an XML format")
    export.add_argument("mission", metavar="MISSION", help=MISSION_HELP)
    export.add_argument("-o", "--output", metavar="FILE", help="where to (default: standard output)")
    export.set_defaults(module="export")
