"""`cfepy graph`: senders, messages and receiving pipes, as text, as a drawing, for graphviz, or for programs."""

from __future__ import annotations

import argparse
import shutil
import sys

from cfepy.cli.ground.survey_flight import survey_plan, surveyed
from cfepy.cli.json_output import check_json, write_json, write_text
from cfepy.cli.main import ENDED_WELL
from cfepy.ground import Survey, graph_dot, graph_of, graph_svg, graph_text

WIDEST = 100  # characters of a line if the output is not a terminal


def run(arguments: argparse.Namespace) -> int:
    """Fly the mission that the command line names for a while, and show its graph.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such mission, it cannot boot, or a file cannot be written.
    """
    check_json(arguments)
    survey = Survey()
    with surveyed(*survey_plan(arguments), [survey]) as mission:
        graph = graph_of(mission, survey.senders)
    graph = graph if arguments.everything else graph.of_interest()
    write_json(arguments, graph.to_dict())
    for option, make in (("svg", graph_svg), ("dot", graph_dot)):
        file = getattr(arguments, option)
        if file is not None:
            write_text(file, make(graph), f"--{option}", arguments)
    width = min(shutil.get_terminal_size().columns, WIDEST) if sys.stdout.isatty() else WIDEST
    sys.stdout.write(graph_text(graph, width))
    return ENDED_WELL
