"""The state machine of a lifecycle node (rcl_lifecycle)."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from typing import NamedTuple

from rclpy._rclpy_pybind11 import RCLError
from rclpy.logging import get_logger

STATES = {
    0: "unknown",
    1: "unconfigured",
    2: "inactive",
    3: "active",
    4: "finalized",
    10: "configuring",
    11: "cleaningup",
    12: "shuttingdown",
    13: "activating",
    14: "deactivating",
    15: "errorprocessing",
}
"""Labels of the states by their numbers, as in lifecycle_msgs/State."""
_BEGINNINGS = (
    (1, "configure", 1, 10),
    (2, "cleanup", 2, 11),
    (3, "activate", 2, 13),
    (4, "deactivate", 3, 14),
    (5, "shutdown", 1, 12),
    (6, "shutdown", 2, 12),
    (7, "shutdown", 3, 12),
)
_ENDS = {10: (10, 2, 1), 11: (20, 1, 2), 13: (30, 3, 2), 14: (40, 2, 3), 12: (50, 4, 4), 15: (60, 1, 4)}
"""For each state of a transition the number of its success, and the states after success and failure."""
_ERROR_PROCESSING = 15


class TransitionCallbackReturn(Enum):
    """Results of a callback for a transition."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99

    def __str__(self) -> str:
        return f"TransitionCallbackReturnType.{self.name}"

    def to_label(self) -> str:
        """Return the label of the transition that follows."""
        return f"transition_{self.name.lower()}"


class StateTransition(NamedTuple):
    """One transition; states by their numbers."""

    number: int
    label: str
    start: int
    goal: int


def _ends(state: int) -> list[StateTransition]:
    """Return the transitions that end a state, by the result of its callback."""
    number, success, failure = _ENDS[state]
    goals = {"success": success, "failure": failure, "error": 4 if state == _ERROR_PROCESSING else _ERROR_PROCESSING}
    return [
        StateTransition(number + shift, f"transition_{word}", state, goal)
        for shift, (word, goal) in enumerate(goals.items())
    ]


def _all() -> list[StateTransition]:
    found: list[StateTransition] = []
    for number, label, start, goal in _BEGINNINGS:
        found.append(StateTransition(number, label, start, goal))
        if label != "shutdown" or number == _BEGINNINGS[-1][0]:
            found += _ends(goal)
    return found + _ends(_ERROR_PROCESSING)


TRANSITIONS = _all()
"""All transitions, in the order of rcl."""


class StateMachine:
    """The state of one node.

    Args:
        tell: called with the numbers of the old and the new state after each transition.
    """

    def __init__(self, tell: Callable[[int, int], object]) -> None:
        self._tell = tell
        self.state = 1

    @property
    def current_state(self) -> tuple[int, str]:
        """Number and label of the state."""
        return self.state, STATES[self.state]

    def available(self) -> list[StateTransition]:
        """Return the transitions that begin in this state."""
        return [each for each in TRANSITIONS if each.start == self.state]

    def number_of(self, label: str) -> int:
        """Return the number of a transition of this state by its label.

        Raises:
            RCLError: there is none.
        """
        return self._find(label, "label").number

    def trigger(self, key: int | str) -> None:
        """Make a transition, by its number or label.

        Raises:
            RCLError: the state does not have it.
        """
        found = self._find(key, "number" if isinstance(key, int) else "label")
        self.state = found.goal
        self._tell(found.start, found.goal)

    def _find(self, key: int | str, field: str) -> StateTransition:
        found = next((each for each in self.available() if getattr(each, field) == key), None)
        if found is None:
            text = f"No transition matching {key} found for current state {STATES[self.state]}"
            get_logger("rcl_lifecycle").warning(text)
            raise RCLError("Transition is not registered.")
        return found
