"""The options of `cfepy replay` that stop the whole mission for the debugger."""

from __future__ import annotations

import argparse


def add_stops(replay: argparse.ArgumentParser) -> None:
    """Add the options to the command replay."""
    replay.add_argument(
        "--break",
        dest="stops",
        action="append",
        default=[],
        metavar="WHAT",
        help="stop at an event (APP:ID or APP:ERROR), at a MsgId, packet or topic by its name, or at messages of which "
        "a Python expression holds, such as 'topic == \"/odom\" and msg.x > 3'; may be given several times",
    )
    replay.add_argument("--step", action="store_true", help="stop at everything that happens, from --until on")
    replay.add_argument(
        "--pdb",
        metavar="APP",
        help="open Python's debugger in this application: at its first line, at the first stop of --break, or from "
        "--until on; and where an exception ends it",
    )
    replay.add_argument(
        "--back",
        action="store_true",
        help="stop at the end of the run, or at --until, too; at each stop, b goes back to what happened before, rc to "
        "the last breakpoint, bt WHAT to the last time at which something happened or held, and in Python's debugger "
        "there are rstep and rcontinue",
    )
    replay.add_argument(
        "--back-to",
        metavar="WHAT",
        help="stop at the last time at which WHAT, as of --break, happened, or at which an expression about variables "
        "held, such as 'self.state == 3'",
    )
    replay.add_argument(
        "--gdb",
        metavar="APP",
        help="open gdb on this process, with the symbols of compiled applications: it stops at the main function of "
        "this application, or at the first stop of --break or --until",
    )
