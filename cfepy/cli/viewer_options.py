"""Options of commands whose runs others may look at while they go on; `cfepy.cli.viewers` does what they say."""

from __future__ import annotations

import argparse


def add_viewers(parser: argparse.ArgumentParser) -> None:
    """Programs that look at the run while it goes on."""
    viewers = parser.add_argument_group("programs that look at the run while it goes on")
    viewers.add_argument(
        "--foxglove",
        metavar="[HOST:]PORT",
        help="serve Foxglove: topics, telemetry, events, parameters and services, both ways; on 127.0.0.1, if no host "
        "is given, and with --realtime at the pace of the wall clock",
    )
    viewers.add_argument(
        "--rosbridge",
        metavar="[HOST:]PORT",
        help="serve clients of rosbridge, such as roslibjs and roslibpy: topics, services and parameters, both ways",
    )
    viewers.add_argument(
        "--viewer-origin",
        action="append",
        default=[],
        metavar="ORIGIN",
        help="let pages of a web site connect from a browser without a token, such as https://example.org; those of "
        "this computer may in any case",
    )
    viewers.add_argument(
        "--viewer-token",
        metavar="TOKEN",
        help="what such a program must know to connect (default: that of the variable CFEPY_VIEWER_TOKEN; from "
        "other computers always one, which is made and shown if nobody gives one)",
    )
