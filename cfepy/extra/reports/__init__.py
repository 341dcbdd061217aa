"""Pictures of a run: a trace for Perfetto, an HTML page for a browser, values over time.

A module belongs here if it watches a run through `cfepy.monitors.observer` and draws it: `perfetto` writes while the
mission runs, `collector` sums up (in `bins`) the data of `page`, `curves` draws the recordings of
`cfepy.ground.series`. The numbers themselves come from `cfepy.pilot.results`; `board_fit` computes a mission's
requirements for a board. Modules that judge a run belong to `cfepy.monitors`. The central file is
`cfepy/extra/reports/page.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.reports.board_fit import BoardChange, BoardFit, PoolRow, StackRow, fit_of
    from cfepy.extra.reports.collector import Collector
    from cfepy.extra.reports.curves import (
        DPI,
        Change,
        Curve,
        Curves,
        curves_of,
        figure_of_matplotlib,
        picture_of,
        save,
        thinned,
    )
    from cfepy.extra.reports.page import About, page_of
    from cfepy.extra.reports.page_story import PageStory, StoryRow
    from cfepy.extra.reports.perfetto import PerfettoTrace
    from cfepy.extra.reports.trace_events import write_perf_log

__all__ = [
    "DPI",
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
    "curves_of",
    "figure_of_matplotlib",
    "fit_of",
    "page_of",
    "picture_of",
    "save",
    "thinned",
    "write_perf_log",
]

if not TYPE_CHECKING:  # a type checker sees only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".board_fit": ("BoardChange", "BoardFit", "PoolRow", "StackRow", "fit_of"),
            ".collector": ("Collector",),
            ".curves": (
                "DPI",
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
            ".trace_events": ("write_perf_log",),
        },
    )
