"""`Waitable`: an entity that consists of several others (rclpy.waitable)."""

from __future__ import annotations

from typing import Any

from rclpy._entity import Call, Entity


class Waitable(Entity):
    """Base of actions, and of other things with several entities.

    Args:
        callback_group: its group.
    """

    def __init__(self, callback_group: Any) -> None:
        self.callback_group = callback_group
        self.callback_group.add_entity(self)
        self._futures: list[Any] = []

    def add_future(self, future: Any) -> None:
        """Let the executor that runs this object run the callbacks of a future."""
        self._futures.append(future)

    def remove_future(self, future: Any) -> None:
        """Forget a future."""
        self._futures.remove(future)

    def take_data(self) -> Any:
        """Take the work of the entities."""
        raise NotImplementedError("Must be implemented by subclass")

    async def execute(self, taken_data: Any) -> None:
        """Do the work that `take_data` returned."""
        raise NotImplementedError("Must be implemented by subclass")

    def take_work(self, executor: Any) -> Call:
        """Take the work; see `Entity.take_work`."""
        data = self.take_data()
        for future in self._futures:
            future._set_executor(executor)
        return self.execute, (data,)
