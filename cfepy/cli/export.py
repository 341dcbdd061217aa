"""`cfepy export xtce`: write what a mission's packets mean for a ground system."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from cfepy.cli.failures import booting, writing
from cfepy.cli.main import ENDED_WELL
from cfepy.mission import read_mission
from cfepy.mission.dictionary import dictionary_of
from cfepy.mission.topics import surveyed_topics
from cfepy.mission.xtce import xtce_of


def run(arguments: argparse.Namespace) -> int:
    """Export the mission that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such mission, it cannot boot, or the file cannot be written.
    """
    spec = read_mission(arguments.mission)
    dictionary = dictionary_of(spec)
    with booting(spec.script):
        dictionary.learn(surveyed_topics(spec))
    for problem in dictionary.problems:
        print(f"cfepy: {problem}", file=sys.stderr)
    document = xtce_of(spec.name, dictionary)
    if arguments.output is None:
        sys.stdout.write(document)
        return ENDED_WELL
    with writing(arguments.output, "--output"):
        Path(arguments.output).write_text(document, encoding="utf-8")
    return ENDED_WELL
