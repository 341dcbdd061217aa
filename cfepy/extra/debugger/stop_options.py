"""The options of `cfepy replay` that stop the whole mission for the debugger."""

from __future__ import annotations

import argparse

from cfepy.cli.parser import add_example


def add_stops(replay: argparse.ArgumentParser) -> None:
    """Add the options to the command replay."""
    add_example(replay, "cfepy replay run.cfepy --break /joint_states --pdb ARM_CONTROL")
    replay.add_argument(
        "--break",
        dest="stops",
        action="append",
        default=[],
        metavar="WHAT",
        help="stop at an event (APP:ID or APP:ERROR), a MsgId, a packet, a topic, or a message for which an expression "
        "is true: 'topic == \"/odom\" and msg.x > 3'; may be given several times",
    )
    replay.add_argument("--step", action="store_true", help="stop at each record, from --until on")
    replay.add_argument(
        "--pdb",
        metavar="APP",
        help="open Python's debugger in this application: at its first line, at the first stop of --break, or from "
        "--until on; and at an exception that ends it",
    )
    replay.add_argument(
        "--back",
        action="store_true",
        help="also stop at the end of the run, or at --until; at each stop b, rc and bt WHAT go back in time, in "
        "Python's debugger rstep and rcontinue",
    )
    replay.add_argument(
        "--back-to",
        metavar="WHAT",
        help="stop at the last time of WHAT, as for --break, or of an expression about variables: 'self.state == 3'",
    )
    replay.add_argument(
        "--gdb",
        metavar="APP",
        help="open gdb on this process; it stops at the main function of this compiled application, or at the first "
        "stop of --break or --until",
    )
