"""`time` and `datetime` on the kernel's clock, in UTC.

Reading the clock takes the virtual CPU time of one call, so that a loop which polls it makes progress. The classes of
`datetime` are the host's, with the methods that look at a clock or a time zone replaced; a host library's `datetime`
objects count as instances of the node's classes.
"""

from __future__ import annotations

import sys
import time
from time import struct_time
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.made_modules import proxy
from cfepy.nodes.stdlib.locks import wait_ns
from cfepy.rtos import WaitList

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

_MONOTONIC = frozenset(
    getattr(time, name)
    for name in ("CLOCK_MONOTONIC", "CLOCK_MONOTONIC_RAW", "CLOCK_BOOTTIME", "CLOCK_HIGHRES")
    if hasattr(time, name)
)


def cfepy_module(universe: Universe) -> ModuleType:
    """Return a node's package cfepy: the host's, with `compute` for the node's own processor."""
    host = sys.modules[__name__.partition(".")[0]]  # it is loaded, and its layer is above all others

    def compute(seconds: float) -> None:
        host.compute(seconds)
        universe.kernel.compute(round(seconds * 1e9))

    return proxy(host, compute=compute)


class VirtualClock:
    """Clock of a universe. Its functions are methods, because bound methods, like C functions, are not bound again.

    Args:
        universe: the universe that uses the clock.
        epoch_ns: time of day in ns since 1970 (UTC) at which the kernel's clock is 0.
    """

    def __init__(self, universe: Universe, epoch_ns: int) -> None:
        self._universe = universe
        self._kernel = universe.kernel
        self.epoch_ns = epoch_ns
        self._for_ever = WaitList(f"nothing, for ever, in {universe.name}")

    def wait(self, seconds: float | None) -> None:
        """Sleep for a time in seconds; None for no limit."""
        kernel = self._kernel
        if kernel.current is kernel.host:
            raise RuntimeError("only a task can sleep; the host waits with Kernel.run")
        if seconds is None:
            kernel.wait_on(self._for_ever)
        elif seconds > 0:
            kernel.delay(wait_ns(seconds))
        else:
            self._universe.charge()
            kernel.yield_cpu()

    def sleep(self, seconds: float) -> None:
        """`time.sleep`."""
        if seconds < 0:
            raise ValueError("sleep length must be non-negative")
        self.wait(seconds)

    def time(self) -> float:
        """`time.time`."""
        self._universe.charge()
        return (self.epoch_ns + self._kernel.now) / 1e9

    def time_ns(self) -> int:
        """`time.time_ns`."""
        self._universe.charge()
        return self.epoch_ns + self._kernel.now

    def monotonic(self) -> float:
        """`time.monotonic` and `time.perf_counter`."""
        self._universe.charge()
        return self._kernel.now / 1e9

    def monotonic_ns(self) -> int:
        """`time.monotonic_ns` and `time.perf_counter_ns`."""
        self._universe.charge()
        return self._kernel.now

    def process_time_ns(self) -> int:
        """`time.process_time_ns`: virtual CPU time that the node's tasks used."""
        self._universe.charge()
        return self._universe.cpu_ns

    def process_time(self) -> float:
        """`time.process_time`."""
        return self.process_time_ns() / 1e9

    def thread_time_ns(self) -> int:
        """`time.thread_time_ns`: virtual CPU time that the calling task used."""
        self._universe.charge()
        return self._kernel.current.cpu_ns

    def thread_time(self) -> float:
        """`time.thread_time`."""
        return self.thread_time_ns() / 1e9

    def clock_gettime(self, clock: int) -> float:
        """`time.clock_gettime`."""
        return self.clock_gettime_ns(clock) / 1e9

    def clock_gettime_ns(self, clock: int) -> int:
        """`time.clock_gettime_ns`."""
        return self.monotonic_ns() if clock in _MONOTONIC else self.time_ns()

    def gmtime(self, seconds: float | None = None) -> struct_time:
        """`time.gmtime` and `time.localtime`."""
        return time.gmtime(self.time_ns() // 10**9 if seconds is None else seconds)

    def ctime(self, seconds: float | None = None) -> str:
        """`time.ctime`."""
        return time.asctime(self.gmtime(seconds))

    def asctime(self, when: Any = None) -> str:
        """`time.asctime`."""
        return time.asctime(self.gmtime() if when is None else when)

    def strftime(self, form: str, when: Any = None) -> str:
        """`time.strftime`."""
        return time.strftime(form, self.gmtime() if when is None else when)

    def mktime(self, when: Any) -> float:
        """`time.mktime`."""
        from calendar import timegm

        return float(timegm(when))


def time_module(universe: Universe) -> ModuleType:
    """Return the module `time` of a universe."""
    clock = universe.clock
    names = {name: getattr(clock, name) for name in vars(VirtualClock) if hasattr(time, name)}
    return proxy(
        time,
        **names,
        altzone=0,
        daylight=0,
        localtime=clock.gmtime,
        perf_counter=clock.monotonic,
        perf_counter_ns=clock.monotonic_ns,
        timezone=0,
        tzname=("UTC", "UTC"),
        tzset=lambda: None,
    )


class _Either(type):
    """Instances of the host's class are instances too."""

    def __instancecheck__(cls, instance: object) -> bool:
        return isinstance(instance, cls.__mro__[1])


def datetime_module(universe: Universe) -> ModuleType:
    """Return the module `datetime` of a universe."""
    import datetime as host

    clock = universe.clock
    utc = host.UTC

    class datetime(host.datetime, metaclass=_Either):
        """A date and time; naive values are in UTC."""

        @classmethod
        def now(cls, tz: host.tzinfo | None = None) -> Any:
            microseconds = clock.time_ns() // 1000
            now = cls(1970, 1, 1, tzinfo=utc) + host.timedelta(microseconds=microseconds)
            return now.replace(tzinfo=None) if tz is None else now.astimezone(tz)

        @classmethod
        def utcnow(cls) -> Any:
            return cls.now()

        @classmethod
        def today(cls) -> Any:
            return cls.now()

        @classmethod
        def fromtimestamp(cls, timestamp: float, tz: host.tzinfo | None = None) -> Any:
            when = super().fromtimestamp(timestamp, utc)
            return when.replace(tzinfo=None) if tz is None else when.astimezone(tz)

        def timestamp(self) -> float:
            return super().timestamp() if self.tzinfo is not None else self.replace(tzinfo=utc).timestamp()

        def astimezone(self, tz: host.tzinfo | None = None) -> Any:
            aware = self if self.tzinfo is not None else self.replace(tzinfo=utc)
            return host.datetime.astimezone(aware, utc if tz is None else tz)

        def __repr__(self) -> str:
            return f"datetime.{super().__repr__()}"

    class date(host.date, metaclass=_Either):
        """A date; today's date is in UTC."""

        @classmethod
        def today(cls) -> Any:
            return cls.fromtimestamp(clock.time_ns() // 10**9)

        @classmethod
        def fromtimestamp(cls, timestamp: float) -> Any:
            when = host.datetime.fromtimestamp(timestamp, utc)
            return cls(when.year, when.month, when.day)

        def __repr__(self) -> str:
            return f"datetime.{super().__repr__()}"

    for made in (datetime, date):
        made.__module__ = "datetime"
        made.__qualname__ = made.__name__
    return proxy(host, datetime=datetime, date=date)
