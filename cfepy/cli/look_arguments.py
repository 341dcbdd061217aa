"""What the command line understands of looking at a run: trace, report. Imports only argparse."""

from __future__ import annotations

import argparse

from cfepy.cli.arguments import add_end, add_launch_arguments, add_machine, seconds_of
from cfepy.cli.journal_arguments import add_source

REPORT_FILE = "report.html"
_SOURCE_HELP = "a journal that `cfepy run --record FILE` wrote, or a mission as `cfepy run` takes it, which is flown"
_STATUS = """exit status:
  0    it was written
  1    it was written, but the replay was not the run of the journal
  2    bad usage, or a mission that cannot boot
  130  ended by Ctrl-C"""


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_trace(commands)
    _add_report(commands)


def _add_trace(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    trace = _command(
        commands,
        "trace",
        "show everything that happened in a run, or write it for Perfetto",
        "Print what happened in a run, a line each: virtual time, task, what. With --perfetto write it to a file that "
        "ui.perfetto.dev opens.",
    )
    trace.add_argument("--perfetto", metavar="FILE", help="write a trace in the Trace Event Format to this file")
    trace.add_argument("--from", dest="from_s", type=seconds_of, metavar="SECONDS", help="only from this virtual time")
    trace.add_argument("--to", dest="to_s", type=seconds_of, metavar="SECONDS", help="only up to this virtual time")
    trace.add_argument("--task", action="append", default=[], metavar="NAME", help="only this task, or 'ARM*'; again")
    trace.add_argument(
        "--topic",
        action="append",
        default=[],
        metavar="NAME",
        help="only messages of this topic, packet or MsgId that are sent, or '/arm/*'; again for more",
    )


def _add_report(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    report = _command(
        commands,
        "report",
        "write a run as an HTML page",
        "Write one HTML page about a run, which needs nothing else: timeline, rates, latencies, pipes, processor time, "
        "events, console, deadlines.",
    )
    report.add_argument(
        "-o", "--output", default=REPORT_FILE, metavar="FILE", help=f"the page (default: {REPORT_FILE})"
    )


def _command(
    commands: argparse._SubParsersAction[argparse.ArgumentParser], name: str, help_text: str, description: str
) -> argparse.ArgumentParser:
    command = commands.add_parser(
        name,
        help=help_text,
        description=description,
        epilog=_STATUS,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    command.add_argument("source", metavar="FILE|MISSION", help=_SOURCE_HELP)
    add_end(command)
    add_machine(command)
    command.add_argument("--script", metavar="FILE", help="carry out a mission script")
    add_launch_arguments(command)
    command.add_argument(
        "--until", type=seconds_of, metavar="SECONDS", help="end the replay of a journal at this virtual time"
    )
    add_source(command)
    command.set_defaults(module="trace" if name == "trace" else "report_page", stop_on_failure=False)
    return command
