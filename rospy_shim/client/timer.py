"""`rospy.Rate` and `rospy.Timer`: a loop pacer that keeps to its grid, and a thread that calls back periodically.

A loop that is late catches up; one that is more than two periods late starts a new grid, all in integers. A timer is a
`threading.Thread` of the node's own `threading`. So an exception in the callback ends it with Python's usual output,
and nodes can join it (rospy.timer).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from cfepy.units import NS_PER_S
from rospy_shim.client.rostime import Duration, Time
from rospy_shim.types.exceptions import ROSInterruptException, ROSTimeMovedBackwardsException

if TYPE_CHECKING:
    from rospy_shim.client.node import Node


class TimerEvent:
    """The argument of a timer's callback; the three `last_` values are None the first time."""

    __module__ = "rospy.timer"

    def __init__(
        self,
        last_expected: Time | None,
        last_real: Time | None,
        current_expected: Time,
        current_real: Time,
        last_duration: float | None,
    ) -> None:
        self.last_expected, self.last_real = last_expected, last_real
        self.current_expected, self.current_real = current_expected, current_real
        self.last_duration = last_duration


def make_timer(node: Node) -> type:
    """Make the class `rospy.Timer` of a node."""
    threading = node.universe.importer.load("threading")
    base: Any = threading.Thread

    class Timer(base):  # type: ignore[misc]  # the base exists in the node's module universe only
        """Calls a function periodically in a thread of its own.

        Args:
            period: a Duration.
            callback: takes a TimerEvent.
            oneshot: call it once.
            reset: go on when simulated time is set back; otherwise the timer ends with the exception.
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
            """Stop calling."""
            self._shutdown = True

        def run(self) -> None:
            """Run the thread."""
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
                if self._shutdown:
                    break  # on the wall clock a timer that sleeps at the shutdown calls once more, as in ROS
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


class Rate:
    """Sleeps so that a loop runs at a given rate; each node has a subclass that knows the node."""

    __module__ = "rospy.timer"
    __node__: ClassVar[Node]

    def __init__(self, hz: float, reset: bool = False) -> None:
        """Start the first period now.

        Args:
            hz: rate in Hz; a negative one never sleeps.
            reset: when simulated time is set back during a sleep, start a new period instead of raising.

        Raises:
            ROSInitException: before `init_node`.
            ZeroDivisionError: a rate of 0.
        """
        node = self.__node__
        self.__last_ns = node.clock.now_ns()
        self.__period_ns = int(1e9 / hz)
        self._reset = reset
        self.__kernel = node.kernel
        self.__clock = node.clock
        self.__charge = node.universe.charge

    @property
    def sleep_dur(self) -> Duration:
        """The period."""
        return Duration(0, self.__period_ns)

    @sleep_dur.setter
    def sleep_dur(self, value: Any) -> None:
        self.__period_ns = value.to_nsec()

    @property
    def last_time(self) -> Time:
        """The beginning of the present period."""
        return self.__node__.clock.at(self.__last_ns)

    @last_time.setter
    def last_time(self, value: Any) -> None:
        self.__last_ns = value.to_nsec()

    def remaining(self) -> Duration:
        """Return the remaining time of the present period."""
        now = self.__node__.clock.now_ns()
        return Duration(0, self.__period_ns - (now - min(now, self.__last_ns)))

    def sleep(self) -> None:
        """Sleep until the present period ends.

        Raises:
            ROSTimeMovedBackwardsException: simulated time was set back, and the Rate was made without `reset`.
            ROSInterruptException: simulated time is used, and the node is shut down.
        """
        if not self.__clock.is_wallclock():
            self.__sleep_on_simulated_time()
            return
        kernel = self.__kernel
        now = self.__clock.wall_ns()
        period = self.__period_ns
        end = min(now, self.__last_ns) + period  # the clock may have been set back
        if end > now:
            kernel.delay(end - now)
        else:
            self.__charge()
        self.__last_ns = end if now - end <= 2 * period else now

    def __sleep_on_simulated_time(self) -> None:
        """Sleep as `sleep` does, on a clock that others set, also back."""
        clock, now = self.__clock, self.__clock.now_ns()
        self.__last_ns = min(now, self.__last_ns)
        try:
            clock.sleep(Duration(0, self.__last_ns + self.__period_ns - now))
        except ROSTimeMovedBackwardsException:
            if not self._reset:
                raise
            self.__last_ns = clock.now_ns()
            return
        end = self.__last_ns + self.__period_ns
        self.__last_ns = end if now - end <= 2 * self.__period_ns else now


def make_rate(node: Node) -> type[Rate]:
    """Make the class `rospy.Rate` of a node."""
    return type("Rate", (Rate,), {"__module__": Rate.__module__, "__node__": node})
