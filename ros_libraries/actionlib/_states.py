"""The states of a goal as its client sees them, and their changes by a status from the server."""

from __future__ import annotations

from typing import Any

from actionlib_msgs.msg import GoalStatus


class CommState:
    """Where the talk about a goal has got to, seen from the client."""

    WAITING_FOR_GOAL_ACK = 0
    PENDING = 1
    ACTIVE = 2
    WAITING_FOR_RESULT = 3
    WAITING_FOR_CANCEL_ACK = 4
    RECALLING = 5
    PREEMPTING = 6
    DONE = 7
    LOST = 8

    to_string: Any


class TerminalState:
    """Final states of a goal. The numbers come from actionlib_msgs/GoalStatus."""

    RECALLED = GoalStatus.RECALLED
    REJECTED = GoalStatus.REJECTED
    PREEMPTED = GoalStatus.PREEMPTED
    ABORTED = GoalStatus.ABORTED
    SUCCEEDED = GoalStatus.SUCCEEDED
    LOST = GoalStatus.LOST

    to_string: Any


TERMINAL_STATES = frozenset(value for name, value in vars(TerminalState).items() if name.isupper())


def get_name_of_constant(C: type, n: int) -> str:
    """Return the name of a class's first attribute with a value, e.g. "ACTIVE".

    Of the class GoalStatus, 0 gives "_has_header", which is False, as on ROS.
    """
    for name, constant in vars(C).items():
        if isinstance(constant, int) and constant == n:
            return name
    return f"NO_SUCH_STATE_{n}"


# Nodes write GoalStatus.to_string(status): actionlib adds it to a message class that it does not own.
for _states in (CommState, TerminalState, GoalStatus):
    _states.to_string = classmethod(get_name_of_constant)

_LETTERS = {
    "P": CommState.PENDING,
    "A": CommState.ACTIVE,
    "R": CommState.RECALLING,
    "X": CommState.PREEMPTING,
    "W": CommState.WAITING_FOR_RESULT,
}

# One column for each status by number: PENDING, ACTIVE, PREEMPTED, SUCCEEDED, ABORTED, REJECTED, PREEMPTING, RECALLING,
# RECALLED. Each has the states that the goal passes through in order; "-" none, "!" against the rules.
_TABLE = {
    CommState.WAITING_FOR_GOAL_ACK: "P A AXW AW AW PW AX PR PW",
    CommState.PENDING: "- A AXW AW AW W AX R RW",
    CommState.ACTIVE: "! - XW W W ! X ! !",
    CommState.WAITING_FOR_RESULT: "! - - - - - ! ! -",
    CommState.WAITING_FOR_CANCEL_ACK: "- - XW XW XW W X R RW",
    CommState.RECALLING: "! ! XW XW XW W X - W",
    CommState.PREEMPTING: "! ! W W W ! - ! !",
}


def _path(cell: str) -> tuple[int, ...] | None:
    return None if cell == "!" else tuple(_LETTERS[letter] for letter in cell.strip("-"))


TRANSITIONS = {state: [_path(cell) for cell in row.split()] for state, row in _TABLE.items()}
"""By state and number of the status: the states to pass through, or None when the status must not come now."""
