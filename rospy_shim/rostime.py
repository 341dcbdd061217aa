"""`rospy.Time`, `rospy.Duration` and the functions that read the clock (rospy.rostime).

The values are genpy's, under rospy's class names; ROS time is the mission's clock plus the epoch of the run. Each node
has classes of its own, because `Time.now` belongs to one simulated computer. Imports nothing of cfepy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NoReturn

from cfepy.rtos.units import NS_PER_S
from rospy_shim import genpy
from rospy_shim.exceptions import ROSInitException

if TYPE_CHECKING:
    from collections.abc import Callable

    from rospy_shim.node import Node


def nanoseconds(duration: Any) -> int:
    """A duration as rospy accepts it, in ns.

    Args:
        duration: a genpy Duration, or seconds as a number.
    """
    if isinstance(duration, genpy.Duration):
        return duration.secs * NS_PER_S + duration.nsecs
    return round(float(duration) * NS_PER_S) if not isinstance(duration, int) else duration * NS_PER_S


class Duration(genpy.Duration):
    """rospy.Duration: a signed span of time."""

    __module__ = "rospy.rostime"
    __slots__ = ()

    def __repr__(self) -> str:
        return f"rospy.Duration[{self.to_nsec()}]"


class Time(genpy.Time):
    """rospy.Time: an instant of ROS time; `now` is added for each node."""

    __module__ = "rospy.rostime"
    __slots__ = ()

    @classmethod
    def from_seconds(cls, float_secs: float) -> Time:
        """The old name of `from_sec`."""
        return cls.from_sec(float_secs)

    @staticmethod
    def now() -> Time:
        """The present ROS time; the class that a node gets has a working one.

        Raises:
            ROSInitException: always, outside a mission.
        """
        _not_ready()

    def __repr__(self) -> str:
        return f"rospy.Time[{self.to_nsec()}]"


class RosClock:
    """ROS time of one node.

    Args:
        node: whose clock it is.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._kernel = node.kernel
        self._epoch_ns = node.universe.clock.epoch_ns
        self._ready = False
        self.Duration = Duration
        self.Time: type[Time] = type("Time", (Time,), {"__module__": "rospy.rostime", "__slots__": ()})
        self.get_rostime = self._make_now()
        self.Time.now = staticmethod(self.get_rostime)  # type: ignore[method-assign]  # each node has its own class

    def _make_now(self) -> Callable[[], Time]:
        kernel, epoch_ns, charge, cost = self._kernel, self._epoch_ns, self._kernel.charge, self._node.call_ns
        new: Callable[[type[Time]], Time] = object.__new__
        kind = self.Time

        def get_rostime() -> Time:
            """The present ROS time.

            Raises:
                ROSInitException: before `init_node`.
            """
            if not self._ready:
                _not_ready()
            if cost:
                charge(cost)
            value = new(kind)
            value.secs, value.nsecs = divmod(epoch_ns + kernel.now, NS_PER_S)
            return value

        return get_rostime

    def get_time(self) -> float:
        """The present ROS time in seconds."""
        return self.get_rostime().to_sec()

    def now_ns(self) -> int:
        """The present ROS time in ns.

        Raises:
            ROSInitException: before `init_node`.
        """
        if not self._ready:
            _not_ready()
        return self._epoch_ns + self._kernel.now

    def at(self, when_ns: int) -> Time:
        """An instant as a Time of this node."""
        return self.Time(*divmod(when_ns, NS_PER_S))

    def is_rostime_initialized(self) -> bool:
        """Whether `init_node` has run."""
        return self._ready

    def set_rostime_initialized(self, value: bool) -> None:
        """What `init_node` calls."""
        self._ready = value

    def is_wallclock(self) -> bool:
        """Always True: to a node the mission's clock is the wall clock."""
        return True

    def wallsleep(self, duration: Any) -> None:
        """Sleep for seconds or a Duration; not at all when it is negative."""
        self.sleep(duration)

    def sleep(self, duration: Any) -> None:
        """rospy.sleep: let a time pass; shutdown does not cut it short.

        Args:
            duration: seconds or a Duration; nothing happens when it is negative.

        Raises:
            TypeError: neither.
        """
        if not isinstance(duration, genpy.Duration) and duration < 0:
            return
        wait = nanoseconds(duration)
        if wait > 0:
            self._kernel.delay(wait)
        elif wait == 0:
            self._node.universe.charge()
            self._kernel.yield_cpu()


def _not_ready() -> NoReturn:
    raise ROSInitException("time is not initialized. Have you called init_node()?")
