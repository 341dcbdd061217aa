"""`cfepy report`: a run as an HTML page. The report that a run prints is in `cfepy.cli.run.report`."""

from __future__ import annotations

import argparse
from pathlib import Path

from cfepy.cli.failures import check_writable, writing
from cfepy.cli.looked_at import look_at
from cfepy.ground import SeriesRecorder
from cfepy.reports import About, Collector, page_of

MOST_KEPT = 10_000  # messages of each topic and packet, of which the values are drawn


def run(arguments: argparse.Namespace) -> int:
    """Write the page of the run that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such run, or the page cannot be written.
    """
    path = Path(arguments.output)
    check_writable(path, "--output")
    collector, recorder = Collector(), SeriesRecorder(most=MOST_KEPT)
    looked_at = look_at(arguments, [collector, recorder], collector.policy)
    about = About(looked_at.command, looked_at.schedule, arguments.source, looked_at.warnings)
    with writing(path, "--output"):
        path.write_text(page_of(looked_at.flown, collector, about, recorder), encoding="utf-8")
    print(f"{path}: {path.stat().st_size:,} bytes; open it in a browser")
    return looked_at.status()
