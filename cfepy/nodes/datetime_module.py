"""`datetime` on the kernel's clock, in UTC: the host's classes, with the methods that look at a clock or a time zone
replaced. A host library's `datetime` objects count as instances of the node's classes."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.synth import proxy

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


class _Either(type):
    """Instances of the host's class are instances too."""

    def __instancecheck__(cls, instance: object) -> bool:
        return isinstance(instance, cls.__mro__[1])


def datetime_module(universe: Universe) -> ModuleType:
    """The module `datetime` of a universe."""
    import datetime as host

    clock = universe.clock
    utc = host.UTC

    class datetime(host.datetime, metaclass=_Either):
        """A date and time; naive ones are in UTC."""

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
        """A date; today's is that of UTC."""

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
