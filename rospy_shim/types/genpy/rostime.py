"""Seconds and nanoseconds of ROS 1: `TVal`, `Time` and `Duration` under the names of genpy.rostime.

Arithmetic, comparison and rounding are those of genpy 0.6 (pinned by recorded behaviour in the tests), also in
surprising cases: the difference of two Times is a plain genpy Duration while all other results keep the class of the
operand, a Time is never negative, and `Time(1) > Duration(1)` is a TypeError.
"""

from __future__ import annotations

from numbers import Integral
from typing import Any, ClassVar, TypeVar

_NS = 1_000_000_000
_NUMBERS: Any = (Integral, float)
_Self = TypeVar("_Self", bound="TVal")


class TVal:
    """A pair of integers, seconds and nanoseconds, kept so that 0 <= nsecs < 10**9 (genpy.rostime.TVal)."""

    __module__ = "genpy.rostime"
    __slots__ = ["secs", "nsecs"]  # noqa: RUF023  # the order is visible to nodes
    _slot_types: ClassVar[list[str]] = ["int32", "int32"]
    __kind__: ClassVar[str] = "TVal"

    secs: int
    nsecs: int

    def __init__(self, secs: Any = 0, nsecs: Any = 0) -> None:
        """Make a value of `secs` s and `nsecs` ns, or of a float `secs` alone.

        Raises:
            ValueError: `secs` is not an integer and `nsecs` is given as well.
        """
        if type(secs) is int or isinstance(secs, Integral):
            whole, rest = int(secs), int(nsecs)
        elif nsecs != 0:
            raise ValueError("if secs is a float, nsecs cannot be set")
        else:
            whole, rest = _split(secs)
        self.secs = whole + rest // _NS
        self.nsecs = rest % _NS

    @classmethod
    def from_sec(cls: type[_Self], float_secs: float) -> _Self:
        """Make a value from seconds; the fraction is cut, not rounded, to whole nanoseconds."""
        return cls(*_split(float_secs))

    def is_zero(self) -> bool:
        """Return True if both parts are zero."""
        return self.secs == 0 and self.nsecs == 0

    def set(self, secs: int, nsecs: int) -> None:
        """Set both parts unchanged, without carrying."""
        self.secs = secs
        self.nsecs = nsecs

    def canon(self) -> None:
        """Carry whole seconds out of the nanoseconds."""
        carry, self.nsecs = divmod(self.nsecs, _NS)
        self.secs += carry

    def to_sec(self) -> float:
        """Return the value in seconds."""
        return float(self.secs) + float(self.nsecs) / 1e9

    def to_nsec(self) -> int:
        """Return the value in nanoseconds."""
        return self.secs * _NS + self.nsecs

    def __getstate__(self) -> list[int]:
        return [self.secs, self.nsecs]

    def __setstate__(self, state: list[int]) -> None:
        self.secs, self.nsecs = state

    def __reduce_ex__(self, protocol: Any) -> Any:
        if type(self) in (TVal, Time, Duration):
            # "genpy" is a module inside a node only, so the host's pickle must not look the class up there.
            return _rebuild, (self.__kind__, self.secs, self.nsecs)
        return super().__reduce_ex__(protocol)

    def __hash__(self) -> int:
        return hash((self.secs, self.nsecs))

    def __str__(self) -> str:
        return str(self.to_nsec())

    def __repr__(self) -> str:
        return f"genpy.{self.__kind__}[{self.to_nsec()}]"

    def __bool__(self) -> bool:
        return not self.is_zero()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TVal):
            return False
        return self.secs == other.secs and self.nsecs == other.nsecs

    def __lt__(self, other: Any) -> bool:
        return _compare(self, other) < 0 if _alike(self, other) else NotImplemented

    def __le__(self, other: Any) -> bool:
        return _compare(self, other) <= 0 if _alike(self, other) else NotImplemented

    def __gt__(self, other: Any) -> bool:
        return _compare(self, other) > 0 if _alike(self, other) else NotImplemented

    def __ge__(self, other: Any) -> bool:
        return _compare(self, other) >= 0 if _alike(self, other) else NotImplemented


def _split(seconds: Any) -> tuple[int, int]:
    whole = int(seconds)
    return whole, int((seconds - whole) * _NS)


def _alike(left: TVal, right: object) -> bool:
    return isinstance(right, (Time if isinstance(left, Time) else Duration if isinstance(left, Duration) else TVal))


def _compare(left: TVal, right: TVal) -> int:
    return left.to_nsec() - right.to_nsec()


def _rebuild(kind: str, secs: int, nsecs: int) -> TVal:
    value = {"TVal": TVal, "Time": Time, "Duration": Duration}[kind]()
    value.secs, value.nsecs = secs, nsecs
    return value


class Time(TVal):
    """An instant, counted from the epoch; never negative (genpy.rostime.Time)."""

    __module__ = "genpy.rostime"
    __slots__ = ["secs", "nsecs"]  # noqa: RUF023  # the order is visible to nodes
    __kind__ = "Time"

    def __init__(self, secs: Any = 0, nsecs: Any = 0) -> None:
        """Make an instant.

        Raises:
            TypeError: it would be before the epoch.
        """
        super().__init__(secs, nsecs)
        if self.secs < 0:
            raise TypeError("time values must be positive")

    def to_time(self) -> float:
        """Return the same as `to_sec`, in the unit of time.time()."""
        return self.to_sec()

    __hash__ = TVal.__hash__

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Time):
            return False
        return self.secs == other.secs and self.nsecs == other.nsecs

    def __add__(self, other: Any) -> Any:
        if not isinstance(other, Duration):
            return NotImplemented
        return type(self)(self.secs + other.secs, self.nsecs + other.nsecs)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        if isinstance(other, Time):
            return Duration(self.secs - other.secs, self.nsecs - other.nsecs)
        if isinstance(other, Duration):
            return type(self)(self.secs - other.secs, self.nsecs - other.nsecs)
        return NotImplemented


class Duration(TVal):
    """A signed span of time; -0.5 s is held as (-1, 500000000) (genpy.rostime.Duration)."""

    __module__ = "genpy.rostime"
    __slots__ = ["secs", "nsecs"]  # noqa: RUF023  # the order is visible to nodes
    __kind__ = "Duration"

    __hash__ = TVal.__hash__

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Duration):
            return False
        return self.secs == other.secs and self.nsecs == other.nsecs

    def __neg__(self) -> Any:
        return type(self)(-self.secs, -self.nsecs)

    def __abs__(self) -> Any:
        return -self if self.secs < 0 else self

    def __add__(self, other: Any) -> Any:
        if isinstance(other, (Duration, Time)):
            kind = type(other) if isinstance(other, Time) else type(self)
            return kind(self.secs + other.secs, self.nsecs + other.nsecs)
        return NotImplemented

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        if not isinstance(other, Duration):
            return NotImplemented
        return type(self)(self.secs - other.secs, self.nsecs - other.nsecs)

    def __mul__(self, factor: Any) -> Any:
        if isinstance(factor, Integral):
            return type(self)(self.secs * int(factor), self.nsecs * int(factor))
        if isinstance(factor, float):
            return type(self).from_sec(self.to_sec() * factor)
        return NotImplemented

    __rmul__ = __mul__

    # genpy divides in float seconds, so remainders carry float rounding; nodes may depend on the exact result.

    def __floordiv__(self, divisor: Any) -> Any:
        if isinstance(divisor, Duration):
            return int(self.to_sec() // divisor.to_sec())
        if isinstance(divisor, _NUMBERS):
            return type(self).from_sec(self.to_sec() // divisor)
        return NotImplemented

    def __truediv__(self, divisor: Any) -> Any:
        if isinstance(divisor, Duration):
            return self.to_sec() / divisor.to_sec()
        if isinstance(divisor, _NUMBERS):
            return type(self).from_sec(self.to_sec() / divisor)
        return NotImplemented

    def __mod__(self, divisor: Any) -> Any:
        if isinstance(divisor, Duration):
            return type(self).from_sec(self.to_sec() % divisor.to_sec())
        return NotImplemented

    def __divmod__(self, divisor: Any) -> Any:
        if not isinstance(divisor, Duration):
            return NotImplemented
        quotient, rest = divmod(self.to_sec(), divisor.to_sec())
        return int(quotient), type(self).from_sec(rest)
