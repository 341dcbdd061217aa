"""`Time`: a point in time of one kind of clock (rclpy.time)."""

from __future__ import annotations

from typing import Any

from rclpy.clock_type import ClockType
from rclpy.duration import S_TO_NS, Duration

CONVERSION_CONSTANT = S_TO_NS
_LIMIT = 1 << 63


class Time:
    """A point in time, in ns as a 64-bit integer."""

    def __init__(
        self, *, seconds: float = 0, nanoseconds: int = 0, clock_type: ClockType = ClockType.SYSTEM_TIME
    ) -> None:
        """Make a point in time.

        Args:
            seconds: seconds, which may be a fraction.
            nanoseconds: ns, which are added.
            clock_type: kind of its clock.

        Raises:
            TypeError: `clock_type` is not a ClockType.
            ValueError: it is negative.
            OverflowError: it does not fit into 64 bits.
        """
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if seconds < 0:
            raise ValueError("Seconds value must not be negative")
        if nanoseconds < 0:
            raise ValueError("Nanoseconds value must not be negative")
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if total >= _LIMIT:
            raise OverflowError("Total nanoseconds value is too large to store in C time point.")
        self._nanoseconds = total
        self._clock_type = clock_type

    @property
    def nanoseconds(self) -> int:
        """The time in ns."""
        return self._nanoseconds

    @property
    def clock_type(self) -> ClockType:
        """The kind of its clock."""
        return self._clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Return whole seconds and the ns beyond them."""
        return divmod(self._nanoseconds, S_TO_NS)

    def to_msg(self) -> Any:
        """Return it as builtin_interfaces/Time."""
        from builtin_interfaces.msg import Time as Message

        seconds, nanoseconds = self.seconds_nanoseconds()
        return Message(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: Any, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        """Make it from builtin_interfaces/Time.

        Raises:
            TypeError: it is another message.
        """
        if not hasattr(msg, "sec") or not hasattr(msg, "nanosec"):
            raise TypeError("Must pass a builtin_interfaces.msg.Time object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self._nanoseconds}, clock_type={self._clock_type.name})"

    def __add__(self, other: object) -> Time:
        if not isinstance(other, Duration):
            return NotImplemented
        return self._moved(self._nanoseconds + other.nanoseconds)

    __radd__ = __add__

    def __sub__(self, other: object) -> Any:
        if isinstance(other, Time):
            if self._clock_type != other._clock_type:
                raise TypeError("Can't subtract times with different clock types")
            return Duration(nanoseconds=self._nanoseconds - other._nanoseconds)
        if isinstance(other, Duration):
            return self._moved(self._nanoseconds - other.nanoseconds)
        return NotImplemented

    def _moved(self, nanoseconds: int) -> Time:
        try:
            return Time(nanoseconds=nanoseconds, clock_type=self._clock_type)
        except OverflowError as error:
            raise OverflowError("Addition leads to overflow in C storage.") from error
        except ValueError as error:
            raise ValueError("Subtraction leads to negative time.") from error

    def _other(self, other: Time) -> int:
        if self._clock_type != other._clock_type:
            raise TypeError("Can't compare times with different clock types")
        return other._nanoseconds

    def __eq__(self, other: object) -> bool:
        return self._nanoseconds == self._other(other) if isinstance(other, Time) else NotImplemented

    def __lt__(self, other: object) -> bool:
        return self._nanoseconds < self._other(other) if isinstance(other, Time) else NotImplemented

    def __le__(self, other: object) -> bool:
        return self._nanoseconds <= self._other(other) if isinstance(other, Time) else NotImplemented

    def __gt__(self, other: object) -> bool:
        return self._nanoseconds > self._other(other) if isinstance(other, Time) else NotImplemented

    def __ge__(self, other: object) -> bool:
        return self._nanoseconds >= self._other(other) if isinstance(other, Time) else NotImplemented

    __hash__ = None  # type: ignore[assignment]  # as in rclpy
