"""Testing missions with pytest: the fixture `mission`, exploration of schedules, Hypothesis strategies.

Code for tests of flight software belongs here: the plugin (`plugin`), which pytest finds by itself, the booting of
missions for tests (`missions`) and generated inputs (`strategies`). A mission under test is a `Flight` of
`cfepy.flight`; checking runs belongs to `cfepy.monitors`. See docs/how_to/testing.md for examples. Everything here is
loaded on first use, so other test suites are not slowed down. The central file is `cfepy/testing/missions.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.flight import ExpectationError, Flight
    from cfepy.testing.explore_mark import explore
    from cfepy.testing.missions import Missions

__all__ = ["ExpectationError", "Flight", "Missions", "explore"]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            "cfepy.flight": ("ExpectationError", "Flight"),
            ".explore_mark": ("explore",),
            ".missions": ("Missions",),
        },
    )
