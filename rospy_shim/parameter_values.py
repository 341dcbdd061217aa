"""What a parameter can be: the values that XML-RPC carries, since that is how ROS transports them.

They are plain Python values; bytes stand for XML-RPC's base64, a `DateTime` for its dateTime.iso8601. Imports nothing
of cfepy.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

_INT_MAX = 2**31 - 1
_INT_MIN = -(2**31)
_BUILT_IN = (int, float, str, bytes, list, tuple, dict)


@dataclass(frozen=True)
class DateTime:
    """A date and time.

    Args:
        value: as in XML-RPC, "20261121T18:50:00".
    """

    value: str

    def encode(self, out: Any) -> None:
        """Write it into a request, as the values that xmlrpc.client knows do; `out` is a file of text."""
        out.write(f"<value><dateTime.iso8601>{self.value}</dateTime.iso8601></value>\n")


def marshalled(value: Any) -> Any:
    """A copy of a value as it looks after a trip over XML-RPC; bytes stay bytes.

    Raises:
        TypeError: None, a dictionary key that is no string, or an object that XML-RPC cannot carry.
        OverflowError: an integer of more than 32 bits.
    """
    kind = type(value)
    if kind in (bool, float, str, bytes, DateTime):
        return value
    if kind is int:
        if not _INT_MIN <= value <= _INT_MAX:
            raise OverflowError("int exceeds XML-RPC limits")
        return value
    if kind in (list, tuple):
        return [marshalled(item) for item in value]
    if kind is dict:
        if any(not isinstance(key, str) for key in value):
            raise TypeError("dictionary key must be string")
        return {key: marshalled(item) for key, item in value.items()}
    return _of_object(value)


def _of_object(value: Any) -> Any:
    kind = type(value)
    if value is None:
        raise TypeError("cannot marshal None unless allow_none is enabled")
    if kind is bytearray:
        return bytes(value)
    if (wrapped := _wrapped(value)) is not None:
        return wrapped
    if not hasattr(value, "__dict__") or isinstance(value, _BUILT_IN) or kind.__module__ == "datetime":
        raise TypeError(f"cannot marshal {kind} objects")
    return marshalled(dict(vars(value)))


def _wrapped(value: Any) -> bytes | DateTime | None:
    """What a date and time, or a value of xmlrpc.client, stands for; every node has classes of its own for these."""
    match (type(value).__module__, type(value).__name__):
        case ("datetime", "datetime"):
            return DateTime(value.strftime("%Y%m%dT%H:%M:%S"))
        case ("xmlrpc.client", "DateTime"):
            return DateTime(value.value)
        case ("xmlrpc.client", "Binary"):
            return bytes(value.data)
    return None
