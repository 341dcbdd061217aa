"""`rospy.Time`, `rospy.Duration` and the functions that read the clock (rospy.rostime).

The values are genpy's, under rospy's class names. ROS time is the mission's clock plus the epoch of the run, or the
time on the topic /clock if the parameter /use_sim_time is true. Each node has classes of its own, because `Time.now`
belongs to one simulated computer.
"""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Any, NoReturn

from cfepy.rtos import WaitList
from cfepy.units import NS_PER_S
from rospy_shim.client.shutdown import SPIN_NS
from rospy_shim.types import genpy
from rospy_shim.types.exceptions import ROSInitException, ROSInterruptException, ROSTimeMovedBackwardsException

if TYPE_CHECKING:
    from collections.abc import Callable

    from rospy_shim.client.node import Node


def nanoseconds(duration: Any) -> int:
    """Convert a duration that rospy accepts to ns.

    Args:
        duration: a genpy Duration, or seconds as a number.
    """
    if isinstance(duration, genpy.Duration):
        return duration.secs * NS_PER_S + duration.nsecs
    return round(float(duration) * NS_PER_S) if not isinstance(duration, int) else duration * NS_PER_S


def limit_of(timeout: Any) -> int | None:
    """Convert the longest time of a wait to ns, None for no limit.

    Args:
        timeout: a genpy Duration, seconds as a number, or None.

    Raises:
        TypeError: anything else.
    """
    if timeout is None:
        return None
    if isinstance(timeout, genpy.Duration):
        return nanoseconds(timeout)
    seconds = 0.0 + timeout
    if seconds == inf:
        return None
    return 1 if seconds != seconds else nanoseconds(timeout)  # no time is before NaN


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
        """Return the present ROS time; the class of a node has a working version.

        Raises:
            ROSInitException: always, outside a mission.
        """
        _not_ready()

    def __repr__(self) -> str:
        return f"rospy.Time[{self.to_nsec()}]"


class RosClock:
    """ROS time of one node: the mission's clock, or simulated time, which a node sets through /clock (rospy.rostime).

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._kernel = node.kernel
        self._epoch_ns = node.universe.clock.epoch_ns
        self._ready = False
        self._set: Time | None = None  # simulated time
        self._plain = False  # ready, and the mission's clock counts: the only check of the fast path
        self._cond: Any = None
        self._changed = WaitList("a change of ROS time")
        self.Duration = Duration
        self.Time: type[Time] = type("Time", (Time,), {"__module__": "rospy.rostime", "__slots__": ()})
        self.get_rostime = self._make_now()
        self.Time.now = staticmethod(self.get_rostime)  # type: ignore[method-assign]  # each node has its own class

    def _make_now(self) -> Callable[[], Time]:
        kernel, epoch_ns, charge, cost = self._kernel, self._epoch_ns, self._kernel.charge, self._node.call_ns
        new: Callable[[type[Time]], Time] = object.__new__
        kind = self.Time

        def shift(by_ns: int) -> None:
            """Shift the mission's clock by so many ns."""
            nonlocal epoch_ns
            epoch_ns += by_ns
            self._epoch_ns = epoch_ns

        def get_rostime() -> Time:
            """Return the present ROS time.

            Raises:
                ROSInitException: before `init_node`.
            """
            if cost:
                charge(cost)
            if not self._plain:
                return self.at(self.now_ns())
            value = new(kind)
            value.secs, value.nsecs = divmod(epoch_ns + kernel.now, NS_PER_S)
            return value

        self.shift = shift
        return get_rostime

    def get_time(self) -> float:
        """Return the present ROS time in seconds."""
        return self.get_rostime().to_sec()

    def now_ns(self) -> int:
        """Return the present ROS time in ns.

        Raises:
            ROSInitException: before `init_node`.
        """
        if not self._ready:
            _not_ready()
        return self.wall_ns() if self._set is None else self._set.to_nsec()

    def wall_ns(self) -> int:
        """Return the time of the mission's clock in ns, which is the wall clock of a node."""
        return self._epoch_ns + self._kernel.now

    def at(self, when_ns: int) -> Time:
        """Return an instant as a Time of this node."""
        return self.Time(*divmod(when_ns, NS_PER_S))

    def is_rostime_initialized(self) -> bool:
        """Return True if `init_node` has run."""
        return self._ready

    def set_rostime_initialized(self, val: bool) -> None:
        """Set whether `init_node` has run."""
        self._ready = val
        self._plain = bool(val) and self._set is None

    # -- simulated time ----------------------------------------------------------------------------------------------

    def is_wallclock(self) -> bool:
        """Return True if ROS time is the mission's clock, which is the wall clock of a node."""
        return self._set is None

    def _set_rostime(self, t: Any) -> None:
        """Set simulated time, which stands still until it is set again.

        Raises:
            ValueError: `t` is not a Time.
        """
        if not isinstance(t, genpy.Time):
            raise ValueError(f"simulated time is a Time, not {t.__class__}")
        self._change(self.Time(t.secs, t.nsecs))

    def switch_to_wallclock(self) -> None:
        """End simulated time."""
        self._change(None)

    def _change(self, value: Time | None) -> None:
        self._set = value
        self._plain = self._ready and value is None
        self._kernel.wake_all(self._changed)
        if self._cond is not None:
            with self._cond:
                self._cond.notify_all()

    def get_rostime_cond(self) -> Any:
        """Return a `threading.Condition` that is notified at every change of simulated time."""
        if self._cond is None:
            self._cond = self._node.universe.importer.load("threading").Condition()
        return self._cond

    def init_simtime(self) -> bool:
        """Follow /clock from now on, if the parameter /use_sim_time is true; until its first message, time is 0."""
        self.set_rostime_initialized(True)
        if (
            self._set is None
            and not self._node.graph.tells_time
            and self._node.params.get_param("/use_sim_time", False)
        ):
            clock_message = self._node.library.message_class("rosgraph_msgs/Clock")
            self._node.Subscriber("/clock", clock_message, lambda tick: self._set_rostime(tick.clock), queue_size=1)
            self._set_rostime(self.Time())
        return True

    # -- sleeping ----------------------------------------------------------------------------------------------------

    def wallsleep(self, duration: Any) -> None:
        """Sleep on the mission's clock.

        Args:
            duration: seconds.

        Raises:
            ValueError: it is negative.
            TypeError: it is not a number.
        """
        self._node.universe.importer.load("time").sleep(duration)

    def sleep(self, duration: Any) -> None:
        """Let time pass (rospy.sleep). On the mission's clock, shutdown does not cut it short.

        Args:
            duration: seconds or a Duration; a negative one returns at once.

        Raises:
            TypeError: it is neither.
            ROSTimeMovedBackwardsException: simulated time was set back.
            ROSInterruptException: simulated time is used, and the node is shut down.
        """
        if self._set is not None:
            self._sleep_until(duration)
            return
        if not isinstance(duration, genpy.Duration):
            if duration < 0:
                return
            if duration != duration:
                raise ValueError("Invalid value NaN (not a number)")
        wait = nanoseconds(duration)
        if wait > 0:
            self._kernel.delay(wait)
        elif wait == 0:
            self._node.universe.charge()
            self._kernel.yield_cpu()

    def _sleep_until(self, duration: Any) -> None:
        """Sleep on simulated time; before the first /clock it has not begun."""
        wait, life = nanoseconds(duration), self._node.life
        self._node.universe.charge()
        while (begin := self.now_ns()) == 0 and not life.is_shutdown():
            life.wait(self._changed, SPIN_NS)
        while begin <= self.now_ns() < begin + wait and not life.is_shutdown():
            life.wait(self._changed, SPIN_NS)
        if self.now_ns() < begin:
            raise ROSTimeMovedBackwardsException((begin - self.now_ns()) / NS_PER_S)
        if life.is_shutdown():
            raise ROSInterruptException("ROS shutdown request")


def _not_ready() -> NoReturn:
    raise ROSInitException("time is not initialized. Have you called init_node()?")
