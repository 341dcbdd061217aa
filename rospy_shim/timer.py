"""`rospy.Timer`: a thread that calls back at a fixed period (rospy.timer.Timer).

It is a `threading.Thread` of the node's own `threading`, so that an exception in the callback ends it the way Python
shows it, and nodes can join it. Imports nothing of cfepy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from cfepy.rtos.units import NS_PER_S
from rospy_shim.exceptions import ROSInterruptException
from rospy_shim.rostime import Duration, Time

if TYPE_CHECKING:
    from rospy_shim.node import Node


class TimerEvent(NamedTuple):
    """What a timer tells its callback; the three `last_` values are None the first time."""

    last_expected: Time | None
    last_real: Time | None
    current_expected: Time
    current_real: Time
    last_duration: float | None


TimerEvent.__module__ = "rospy.timer"


def make_timer(node: Node) -> type:
    """The class `rospy.Timer` of a node."""
    threading = node.universe.importer.load("threading")
    base: Any = threading.Thread

    class Timer(base):  # type: ignore[misc]  # the base exists in the node's module universe only
        """Calls a function periodically in a thread of its own.

        Args:
            period: a Duration.
            callback: takes a TimerEvent.
            oneshot: call it once.
            reset: go on when simulated time is set back; without it the timer then ends with the exception.
        """

        def __init__(self, period: Duration, callback: Any, oneshot: bool = False, reset: bool = False) -> None:
            super().__init__()
            self._period = period
            self._callback = callback
            self._oneshot = oneshot
            self._reset = reset
            self._shutdown = False
            self.daemon = True
            self.start()

        def shutdown(self) -> None:
            """No further call."""
            self._shutdown = True

        def run(self) -> None:
            """The thread."""
            clock, life = node.clock, node.life
            rate = node.Rate(NS_PER_S / self._period.to_nsec(), reset=self._reset)
            expected = clock.get_rostime() + self._period
            last_expected = last_real = last_duration = None
            while not life.is_shutdown() and not self._shutdown:
                try:
                    rate.sleep()
                except ROSInterruptException:
                    if life.is_shutdown():
                        break
                    raise
                if self._shutdown or life.is_shutdown():
                    break
                real, began = clock.get_rostime(), clock.wall_ns()
                self._callback(TimerEvent(last_expected, last_real, expected, real, last_duration))
                if self._oneshot:
                    break
                last_duration = (clock.wall_ns() - began) / NS_PER_S
                last_expected, last_real = expected, real
                expected += self._period

    Timer.__module__ = "rospy.timer"
    Timer.__qualname__ = "Timer"
    return Timer
