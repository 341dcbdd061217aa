"""`GuardCondition`: wakes an executor from any thread (rclpy.guard_condition)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy import _seam
from rclpy._entity import Call, Entity, nothing
from rclpy.context import Context, get_default_context


class GuardCondition(Entity):
    """A condition that triggers a callback.

    Args:
        callback: called by the executor after `trigger`; may be a coroutine function, or None.
        callback_group: its group.
        context: its context; None takes the default one.
    """

    def __init__(self, callback: Callable[[], Any] | None, callback_group: Any, context: Context | None = None) -> None:
        self.callback = callback
        self.callback_group = callback_group
        self.context = context or get_default_context()
        self._is_triggered = False

    def trigger(self) -> None:
        """Let the executor call the callback."""
        self._is_triggered = True
        _seam.ring()

    def ready(self) -> bool:
        """Return True if it was triggered since the last `take`."""
        return self._is_triggered

    def take_work(self, executor: Any) -> Call:
        """Reset it; see `Entity.take_work`."""
        self._is_triggered = False
        return self.callback or nothing, ()

    def destroy(self) -> None:
        """Forget a trigger."""
        self._is_triggered = False
