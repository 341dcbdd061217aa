"""Pictures of a run: a trace for Perfetto, an HTML page for a browser, values over time.

What belongs here watches a run through `cfepy.monitors.observer` and draws it: `perfetto` writes while the mission
runs, `collector` sums up (in `bins`) what `page` shows, `curves` draws what `cfepy.ground.series` has recorded. The
numbers themselves come from `cfepy.pilot.results`; `board_fit` has what a mission needs of a board. What judges a run
belongs to `cfepy.monitors`.

The names below are loaded when they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.faces import face

if TYPE_CHECKING:
    from cfepy.reports.board_fit import BoardChange, BoardFit, PoolRow, StackRow, fit_of
    from cfepy.reports.collector import Collector
    from cfepy.reports.curves import Change, Curve, Curves, curves_of, figure_of_matplotlib, picture_of, save, thinned
    from cfepy.reports.page import About, page_of
    from cfepy.reports.page_story import PageStory, StoryRow
    from cfepy.reports.perfetto import PerfettoTrace
    from cfepy.reports.sweep_picture import SweepLine, picture_of_sweep
    from cfepy.reports.trace_events import write_perf_log

__all__ = [
    "About",
    "BoardChange",
    "BoardFit",
    "Change",
    "Collector",
    "Curve",
    "Curves",
    "PageStory",
    "PerfettoTrace",
    "PoolRow",
    "StackRow",
    "StoryRow",
    "SweepLine",
    "curves_of",
    "figure_of_matplotlib",
    "fit_of",
    "page_of",
    "picture_of",
    "picture_of_sweep",
    "save",
    "thinned",
    "write_perf_log",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".board_fit": ("BoardChange", "BoardFit", "PoolRow", "StackRow", "fit_of"),
            ".collector": ("Collector",),
            ".curves": (
                "Change",
                "Curve",
                "Curves",
                "curves_of",
                "figure_of_matplotlib",
                "picture_of",
                "save",
                "thinned",
            ),
            ".page": (
                "About",
                "page_of",
            ),
            ".page_story": (
                "PageStory",
                "StoryRow",
            ),
            ".perfetto": ("PerfettoTrace",),
            ".sweep_picture": ("SweepLine", "picture_of_sweep"),
            ".trace_events": ("write_perf_log",),
        },
    )
