"""`Duration` (rclpy.duration)."""

from __future__ import annotations

from typing import Any

S_TO_NS = 1_000_000_000
_LIMIT = 1 << 63


class Duration:
    """A span of time, in ns as a 64-bit integer."""

    def __init__(self, *, seconds: float = 0, nanoseconds: int = 0) -> None:
        """Make a span.

        Args:
            seconds: seconds, which may be a fraction.
            nanoseconds: ns, which are added.

        Raises:
            OverflowError: it does not fit into 64 bits.
        """
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if not -_LIMIT <= total < _LIMIT:
            raise OverflowError("Total nanoseconds value is too large to store in C duration.")
        self._nanoseconds = total

    @property
    def nanoseconds(self) -> int:
        """The span in ns."""
        return self._nanoseconds

    def to_msg(self) -> Any:
        """Return it as builtin_interfaces/Duration."""
        from builtin_interfaces.msg import Duration as Message

        seconds, nanoseconds = divmod(self._nanoseconds, S_TO_NS)
        return Message(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: Any) -> Duration:
        """Make it from builtin_interfaces/Duration.

        Raises:
            TypeError: it is another message.
        """
        if not hasattr(msg, "sec") or not hasattr(msg, "nanosec"):
            raise TypeError("Must pass a builtin_interfaces.msg.Duration object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self._nanoseconds})"

    def __str__(self) -> str:
        if self._nanoseconds in (_LIMIT - 1, -_LIMIT):
            return "Infinite"
        return f"{self._nanoseconds} nanoseconds"

    def __eq__(self, other: object) -> bool:
        return self._nanoseconds == other._nanoseconds if isinstance(other, Duration) else NotImplemented

    def __lt__(self, other: object) -> bool:
        return self._nanoseconds < other._nanoseconds if isinstance(other, Duration) else NotImplemented

    def __le__(self, other: object) -> bool:
        return self._nanoseconds <= other._nanoseconds if isinstance(other, Duration) else NotImplemented

    def __gt__(self, other: object) -> bool:
        return self._nanoseconds > other._nanoseconds if isinstance(other, Duration) else NotImplemented

    def __ge__(self, other: object) -> bool:
        return self._nanoseconds >= other._nanoseconds if isinstance(other, Duration) else NotImplemented

    __hash__ = None  # type: ignore[assignment]  # as in rclpy


Infinite = Duration(nanoseconds=_LIMIT - 1)
