"""`Context`: the life of rclpy in a program, from `init` to `shutdown` (rclpy.context)."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from rclpy import _seam
from rclpy._names import parse_arguments
from rclpy._rclpy_pybind11 import UnknownROSArgsError
from rclpy.logging import get_logging_severity_from_string, set_logger_level

_defaults: list[Context] = []


class Context:
    """A context; nodes, executors and guard conditions belong to one."""

    def __init__(self) -> None:
        self._is_up = False
        self._was_signalled = False
        self._hooks: list[Callable[[], object]] = []
        self.arguments: list[str] = []

    def init(
        self, args: list[str] | None = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        """Initialize the context.

        Args:
            args: command line; None takes sys.argv.
            initialize_logging: accepted.
            domain_id: accepted; a mission has one domain.

        Raises:
            RuntimeError: it is initialized already, or the command line has a wrong argument of ROS.
        """
        if self._is_up:
            raise RuntimeError("Context.init() must only be called once")
        if domain_id is not None and domain_id < 0:
            raise RuntimeError(f"Domain id ({domain_id}) should not be lower than zero.")
        self.arguments = list(sys.argv if args is None else args)
        said = parse_arguments(self.arguments)
        if said.refused:
            raise UnknownROSArgsError(said.refused)
        for name, level in said.log_levels.items():
            set_logger_level(name, get_logging_severity_from_string(level))
        self._is_up, self._was_signalled = True, False
        _seam.program.life.add_shutdown_hook(lambda reason: self.try_shutdown())

    def ok(self) -> bool:
        """Return True if the context is initialized and not shut down."""
        return self._is_up and not _seam.program.life.is_shutdown()

    def is_alive(self) -> bool:
        """Return the same as `ok`, without the time that a call of cFE takes."""
        return self._is_up and not _seam.program.life.over

    def shutdown(self) -> None:
        """Shut the context down and call its hooks. After a signal that has done so, the first call has no effect.

        Raises:
            RuntimeError: it is not initialized, or is shut down.
        """
        if self._was_signalled:
            self._was_signalled = False
            return
        if not self._is_up:
            raise RuntimeError("Context must be initialized before it can be shutdown")
        self.try_shutdown()

    def try_shutdown(self) -> None:
        """Shut the context down, unless it is not initialized or is shut down."""
        if not self._is_up:
            return
        self._is_up = False
        hooks, self._hooks = self._hooks, []
        for hook in hooks:
            hook()
        _seam.ring()

    def shut_down_by_signal(self) -> None:
        """Shut the context down because of a signal."""
        self._was_signalled = self._is_up
        self.try_shutdown()

    def on_shutdown(self, callback: Callable[[], object]) -> None:
        """Add a function that is called at the shutdown.

        Raises:
            TypeError: it cannot be called.
        """
        if not callable(callback):
            raise TypeError("callback should be a callable, got {}", type(callback))
        self._hooks.append(callback)

    def get_domain_id(self) -> int:
        """Return the domain, which is 0 in a mission."""
        return 0

    def __enter__(self) -> Context:
        return self

    def __exit__(self, *error: Any) -> None:
        self.try_shutdown()


def get_default_context() -> Context:
    """Return the default context; made at first use."""
    if not _defaults:
        _defaults.append(Context())
    return _defaults[0]
