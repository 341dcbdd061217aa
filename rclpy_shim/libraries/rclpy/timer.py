"""`Timer` and `Rate` (rclpy.timer)."""

from __future__ import annotations

import inspect
import threading
from collections.abc import Callable
from typing import Any, NamedTuple

from rclpy import _seam
from rclpy._entity import NEVER, Call, Entity, nothing
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.exceptions import ROSInterruptException
from rclpy.time import Time


class TimerInfo(NamedTuple):
    """The times of one call of a timer."""

    expected_call_time: Time
    actual_call_time: Time


class Timer(Entity):
    """Calls a function periodically; `Node.create_timer` makes one.

    Args:
        callback: the function; with an argument annotated as `TimerInfo`, it gets the times of the call.
        callback_group: its group.
        timer_period_ns: period in ns.
        clock: its clock.
        context: its context.
        autostart: False waits for `reset`.
    """

    def __init__(
        self,
        callback: Callable[..., Any] | None,
        callback_group: Any,
        timer_period_ns: int,
        clock: Clock,
        *,
        context: Context | None = None,
        autostart: bool = True,
    ) -> None:
        if timer_period_ns < 0:
            from rclpy._rclpy_pybind11 import RCLError

            raise RCLError("failed to create timer: timer period must be non-negative")
        self.callback = callback
        self.callback_group = callback_group
        self._clock = clock
        self._period_ns = timer_period_ns
        self._is_canceled = not autostart
        self._last_ns = self._now()
        self._next_ns = self._last_ns + timer_period_ns
        self.due_ns = self._next_ns if autostart else NEVER
        self._wants_info = callback is not None and _wants_info(callback)

    def _now(self) -> int:
        return int(_seam.steady_ns())

    @property
    def clock(self) -> Clock:
        """Its clock."""
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        """The period in ns, which can be changed; the next call follows after the old one."""
        return self._period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        self._period_ns = int(value)
        _seam.ring()

    def ready(self) -> bool:
        """Return True if a call is due."""
        return not self._is_canceled and self._now() >= self._next_ns

    is_still_ready = ready

    def is_ready(self) -> bool:
        """Return True if a call is due."""
        return self.ready()

    def take_work(self, executor: Any) -> Call | None:
        """Begin a call, and plan the next one; periods that were missed are left out. See `Entity.take_work`."""
        if self._is_canceled:
            return None
        now, expected = self._now(), self._next_ns
        self._last_ns = now
        self._next_ns += self._period_ns
        if self._next_ns < now:
            if self._period_ns == 0:
                self._next_ns = now
            else:
                self._next_ns += (now - self._next_ns + self._period_ns - 1) // self._period_ns * self._period_ns
        self.due_ns = self._next_ns
        function = self.callback or nothing
        if not self._wants_info:
            return function, ()
        kind = self._clock.clock_type
        shift = 0 if kind is ClockType.STEADY_TIME else _seam.now_ns() - now
        times = (Time(nanoseconds=each + shift, clock_type=kind) for each in (expected, now))
        return function, (TimerInfo(*times),)

    def is_canceled(self) -> bool:
        """Return True if it was cancelled."""
        return self._is_canceled

    def cancel(self) -> None:
        """Call the function no more, until `reset`."""
        self._is_canceled = True
        self.due_ns = NEVER

    def reset(self) -> None:
        """Begin a period now."""
        self._is_canceled = False
        self._last_ns = self._now()
        self._next_ns = self.due_ns = self._last_ns + self._period_ns
        _seam.ring()

    def time_since_last_call(self) -> int:
        """Return the ns since the last call, or since the start."""
        return self._now() - self._last_ns

    def time_until_next_call(self) -> int | None:
        """Return the ns until the next call, negative if it is late; None if it was cancelled."""
        return None if self._is_canceled else self._next_ns - self._now()

    def destroy(self) -> None:
        """Call the function no more."""
        self.cancel()

    def __enter__(self) -> Timer:
        return self

    def __exit__(self, *error: object) -> None:
        self.destroy()


class Rate:
    """Sleeps until the next period of a timer; `Node.create_rate` makes one. An executor must run in another thread.

    Args:
        timer: its timer.
        context: its context.
    """

    def __init__(self, timer: Timer, *, context: Context) -> None:
        self._timer = timer
        self._condition = threading.Condition()
        self._ticks = 0
        self._is_shut_down = False
        self._is_destroyed = False
        timer.callback = self._tick
        context.on_shutdown(self._on_shutdown)

    def _tick(self) -> None:
        with self._condition:
            self._ticks += 1
            self._condition.notify_all()

    def _on_shutdown(self) -> None:
        self._is_shut_down = True
        self.destroy()

    def destroy(self) -> None:
        """End the timer, and all sleeps."""
        self._is_destroyed = True
        self._timer.destroy()
        with self._condition:
            self._condition.notify_all()

    def sleep(self) -> None:
        """Sleep until the next period.

        Raises:
            ROSInterruptException: the context is shut down.
            RuntimeError: the rate was destroyed.
        """
        with self._condition:
            before = self._ticks
            while self._ticks == before and not self._is_destroyed:
                self._condition.wait()
        if self._is_shut_down:
            raise ROSInterruptException
        if self._is_destroyed:
            raise RuntimeError("Rate cannot sleep because it has been destroyed")


def _wants_info(callback: Callable[..., Any]) -> bool:
    """Return True if the annotation of an argument is `TimerInfo`."""
    try:
        return any(each.annotation is TimerInfo for each in inspect.signature(callback).parameters.values())
    except (TypeError, ValueError):
        return False
