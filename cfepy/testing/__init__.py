"""Testing missions with pytest: the fixture `mission`, exploration of schedules, Hypothesis strategies.

pytest finds the plugin (`cfepy.testing.plugin`) by itself; docs/testing.md shows what can be done with it. Everything
here is imported when it is first asked for, so that no other test-suite pays for it.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cfepy.testing.errors import ExpectationError
    from cfepy.testing.exploration import explore
    from cfepy.testing.flight import Flight
    from cfepy.testing.missions import Missions

__all__ = ["ExpectationError", "Flight", "Missions", "explore"]

_PLACES = {"ExpectationError": "errors", "Flight": "flight", "Missions": "missions", "explore": "exploration"}


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_PLACES[name]}"), name)
