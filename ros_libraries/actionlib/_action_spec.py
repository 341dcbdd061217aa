"""The message classes of an action, extracted from its *Action class."""

from __future__ import annotations

from typing import Any

from .exceptions import ActionException


class ActionTypes:
    """Classes of an action.

    Args:
        spec: class of the *Action message.

    Raises:
        ActionException: `spec` is not such a class.
    """

    def __init__(self, spec: Any) -> None:
        try:
            whole = spec()
            self.ActionSpec = spec
            self.ActionGoal = type(whole.action_goal)
            self.ActionResult = type(whole.action_result)
            self.ActionResultType = type(whole.action_result.result)
            self.ActionFeedback = type(whole.action_feedback)
        except AttributeError:
            raise ActionException(f"Type is not an action spec: {spec}") from None

    def give_to(self, owner: object) -> None:
        """Set the classes as attributes, which user code looks at."""
        vars(owner).update(vars(self))
