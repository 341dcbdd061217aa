"""Callback groups (rclpy.callback_groups): the callbacks of a group that may run at a time.

The single-threaded executor runs one callback at a time. A group matters to it only while a coroutine waits.
"""

from __future__ import annotations

from typing import Any


class CallbackGroup:
    """Base of the groups."""

    def __init__(self) -> None:
        self.entities: list[Any] = []
        self._active: list[Any] = []

    def add_entity(self, entity: Any) -> None:
        """Add an entity, whose callback belongs to the group."""
        if entity not in self.entities:
            self.entities.append(entity)

    def has_entity(self, entity: Any) -> bool:
        """Return True if an entity belongs to the group."""
        return entity in self.entities

    def can_execute(self, entity: Any) -> bool:
        """Return True if the callback of an entity may run now."""
        raise NotImplementedError

    def beginning_execution(self, entity: Any) -> bool:
        """Note that a callback begins. Returns False if it must not."""
        if not self.can_execute(entity):
            return False
        self._active.append(entity)
        return True

    def ending_execution(self, entity: Any) -> None:
        """Note the end of a callback."""
        if entity in self._active:
            self._active.remove(entity)


class ReentrantCallbackGroup(CallbackGroup):
    """A group whose callbacks run side by side."""

    def can_execute(self, entity: Any) -> bool:
        """Return True: its callbacks may run at any time."""
        return True


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """A group of which one callback runs at a time."""

    def can_execute(self, entity: Any) -> bool:
        """Return True if none of its callbacks runs."""
        return not self._active
