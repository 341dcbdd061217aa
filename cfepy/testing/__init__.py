"""Testing missions with pytest: the fixture `mission`, exploration of schedules, Hypothesis strategies.

What belongs here is used by tests of flight software: the plugin (`plugin`), which pytest finds by itself, the booting
of missions for tests (`missions`) and generated inputs (`strategies`). A mission under test is a `Flight` of
`cfepy.flight`, what judges every run belongs to `cfepy.monitors`. docs/how_to/testing.md has examples. Everything here
is imported when it is first asked for, so that no other test-suite pays for it. The central file is
`cfepy/testing/missions.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.flight import ExpectationError, Flight
    from cfepy.testing.explore_mark import explore
    from cfepy.testing.missions import Missions

__all__ = ["ExpectationError", "Flight", "Missions", "explore"]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            "cfepy.flight": ("ExpectationError", "Flight"),
            ".explore_mark": ("explore",),
            ".missions": ("Missions",),
        },
    )
