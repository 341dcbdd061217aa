"""Clocks (rclpy.clock). ROS's and the system's clock are the mission's clock, the steady one counts from its start."""

from __future__ import annotations

import time
from typing import Any

from rclpy import _seam
from rclpy.clock_type import ClockType
from rclpy.context import Context, get_default_context
from rclpy.duration import S_TO_NS, Duration
from rclpy.exceptions import NotInitializedException
from rclpy.time import Time

__all__ = ["Clock", "ClockType", "ROSClock"]
_LOOK_S = 0.1  # period at which a sleep looks whether the context is shut down


class Clock:
    """A clock of one kind.

    Args:
        clock_type: the kind.

    Raises:
        TypeError: it is not a ClockType.
    """

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> Clock:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        return super().__new__(ROSClock if cls is Clock and clock_type is ClockType.ROS_TIME else cls)

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> None:
        self._clock_type = clock_type

    @property
    def clock_type(self) -> ClockType:
        """The kind."""
        return self._clock_type

    def __repr__(self) -> str:
        return f"Clock(clock_type={self._clock_type.name})"

    def now(self) -> Time:
        """Return the present time."""
        is_steady = self._clock_type is ClockType.STEADY_TIME
        return Time(nanoseconds=_seam.steady_ns() if is_steady else _seam.now_ns(), clock_type=self._clock_type)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Sleep until a time. Returns False if the context is shut down before.

        Raises:
            ValueError: the time is of another kind of clock.
            NotInitializedException: the context is not initialized.
        """
        chosen = context or get_default_context()
        if until.clock_type != self._clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        if not chosen.ok():
            raise NotInitializedException
        while (left := until.nanoseconds - self.now().nanoseconds) > 0:
            time.sleep(min(left / S_TO_NS, _LOOK_S))
            if not chosen.ok():
                return False
        return True

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Sleep for a time; see `sleep_until`."""
        return self.sleep_until(self.now() + rel_time, context)

    def create_jump_callback(self, *args: Any, **options: Any) -> None:
        """Refuse: there are no callbacks for jumps of a clock yet."""
        raise NotImplementedError("cfepy does not have jump callbacks of clocks for nodes of ROS 2 yet")


class ROSClock(Clock):
    """ROS's clock."""

    def __init__(self, **options: Any) -> None:
        super().__init__(clock_type=ClockType.ROS_TIME)

    @property
    def ros_time_is_active(self) -> bool:
        """False: the mission's clock is ROS's time, without a topic /clock."""
        return False
