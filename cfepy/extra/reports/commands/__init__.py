"""The commands trace, report and plot, which show a run; their options are defined here.

A command belongs here if it shows the events of a run, either from a journal or from a mission that it flies.
"""

from __future__ import annotations

import argparse

from cfepy.cli.options import (
    LOOK_STATUS,
    VALUES_HELP,
    add_from,
    add_json,
    add_looked_at,
    add_mission_or_node,
    add_output,
    add_perfetto,
    add_raw,
    add_run_options,
)

REPORT_FILE, PLOT_FILE = "report.html", "plot.png"
LEAST_INCHES, MOST_INCHES = 1.0, 100.0


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_trace(commands)
    _add_report(commands)
    _add_plot(commands)


def _add_trace(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    trace = _command(
        commands,
        "trace",
        "show all records of a run, or write them for Perfetto",
        "Print the records of a run, a line each: virtual time, task, call. With --perfetto write them to a file that "
        "ui.perfetto.dev opens.",
        "run.cfepy --topic '/arm/*' --from 2",
        "capture --for 5 --perfetto run.json",
    )
    add_perfetto(trace)
    add_from(trace)
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
        "capture --for 20 -o capture.html",
        "run.cfepy",
    )
    add_output(report, REPORT_FILE, REPORT_FILE)


def _add_plot(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    plot = _command(
        commands,
        "plot",
        "draw values over time",
        "Draw fields of ROS topics and cFE packets over virtual time into a PNG, SVG or PDF file. An array gives a "
        "line for each of its items; a text, such as the phase of a mission, marks where it changes.",
        "capture /joint_states.position /phase -o plot.png",
        "run.bag /odom/pose/pose/position --subplots",
    )
    plot.add_argument("names", metavar="NAME.FIELD", nargs="+", help=VALUES_HELP)
    add_output(plot, f"{PLOT_FILE}; also .svg and .pdf", PLOT_FILE)
    add_raw(plot)
    plot.add_argument("--subplots", action="store_true", help="each NAME.FIELD in axes of its own")
    add_from(plot)
    plot.add_argument("--title", metavar="TEXT", help="above it (default: the run)")
    plot.add_argument("--size", type=size_of, metavar="WxH", help="in inches (default: 10x4.5, higher with more axes)")


def add_board_report(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the action report to the command board."""
    report = actions.add_parser(
        "report",
        help="show RAM by owner, flash, CPU, headroom, and changes that make a mission fit",
        description="Run a mission on a board with as much RAM as it asks for; report the RAM, flash and CPU time that "
        "it needs, and the fewest changes that make it fit.",
        examples=("cfepy board report capture --board rx64m", "cfepy board report my_mission --for 60 --json -"),
        epilog="exit status: 0 it fits, 1 it does not, 2 bad usage, or a mission that cannot boot",
    )
    add_mission_or_node(report)
    add_run_options(report)
    add_json(report, "the report")
    report.set_defaults(module=f"{__name__}.board_report")


def size_of(text: str) -> tuple[float, float]:
    """Parse width and height in inches, for argparse."""
    try:
        width, height = map(float, text.lower().split("x"))
    except ValueError:
        width = height = 0.0
    if not (LEAST_INCHES <= width <= MOST_INCHES and LEAST_INCHES <= height <= MOST_INCHES):
        raise argparse.ArgumentTypeError(
            f"invalid size {text!r}; expected WIDTHxHEIGHT such as 10x4.5, each "
            f"{LEAST_INCHES:g} to {MOST_INCHES:g} inches"
        )
    return width, height


def _command(
    commands: argparse._SubParsersAction[argparse.ArgumentParser],
    name: str,
    help_text: str,
    description: str,
    *examples: str,
) -> argparse.ArgumentParser:
    command = commands.add_parser(
        name,
        help=help_text,
        description=description,
        examples=[f"cfepy {name} {each}" for each in examples],
        epilog=LOOK_STATUS,
    )
    add_looked_at(command, with_bags=name == "plot")
    command.set_defaults(module=f"{__name__}.{'page' if name == 'report' else name}")
    return command
