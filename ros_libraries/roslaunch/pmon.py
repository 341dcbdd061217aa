"""A node that was started, as a process to monitor (roslaunch.pmon)."""

from __future__ import annotations

from roslaunch import _processes  # type: ignore[attr-defined]  # made for the node, by the mission

PATIENCE_S = 15.0  # how long roslaunch waits for a process that was asked to end


class Process:
    """A node that was started.

    Args:
        name: its name in texts.
        app: the name of its application.
    """

    def __init__(self, name: str, app: str) -> None:
        self.name = name
        self._app = app

    def is_alive(self) -> bool:
        """Return whether it still runs."""
        return bool(_processes.is_alive(self._app))

    def stop(self, errors: list[str] | None = None) -> None:
        """End it, and wait until it has ended."""
        _processes.stop(self._app, PATIENCE_S)
