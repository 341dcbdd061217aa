"""`fill_message_args` and `get_printable_message_args` of genpy.message: YAML-like values into a message, and its field
names for a usage line. Command-line tools and some nodes use them. Imports nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from rospy_shim.genpy.errors import MessageException
from rospy_shim.genpy.message import Message
from rospy_shim.genpy.rostime import Duration, Time, TVal

_NO_KEYS: Mapping[str, Any] = {}
_TIMES: Mapping[str, type[TVal]] = {"time": Time, "duration": Duration}


class ArgumentFiller:
    """`fill_message_args` for one set of message types."""

    def __init__(self, class_of: Callable[[str], Any]) -> None:
        """Make a filler.

        Args:
            class_of: message class by full name, for arrays of messages.
        """
        self._class_of = class_of

    def fill_message_args(self, msg: Any, msg_args: Any, keys: Mapping[str, Any] = _NO_KEYS) -> None:
        """Set a message's fields from plain values.

        Args:
            msg: the message.
            msg_args: a list with one value per field, or a list that holds one dict of values by field name.
            keys: words that stand for a whole value, e.g. "now" or "auto".

        Raises:
            MessageException: a field that does not exist, or too few, too many or unfit values.
            ValueError: something that is neither a list nor a dict where a message's fields are expected.
        """
        alone = len(msg_args) == 1 and type(msg_args[0]) is dict
        self._fill(msg, msg_args[0] if alone else msg_args, keys, "")

    def _fill(self, msg: Any, values: Any, keys: Mapping[str, Any], prefix: str) -> None:
        if isinstance(values, dict):
            for name, value in values.items():
                if name not in msg.__slots__:
                    raise MessageException(f"No field name [{prefix}{name}]")
                self._set(msg, name, value, keys, prefix)
        elif isinstance(values, list):
            _check_count(msg, values, prefix)
            for name, value in zip(msg.__slots__, values, strict=True):
                self._set(msg, name, value, keys, prefix)
        elif values is None:
            raise MessageException(f"No value for field [{prefix.rstrip('.')}]")
        else:
            raise ValueError(f"invalid msg_args type: {values}")

    def _set(self, msg: Any, name: str, value: Any, keys: Mapping[str, Any], prefix: str) -> None:
        old = getattr(msg, name)
        if isinstance(old, (Message, TVal)):
            if isinstance(value, str) and value in keys:
                setattr(msg, name, keys[value])
            else:
                self._fill_one(old, value, keys, f"{prefix}{name}.")
        elif isinstance(old, list):
            setattr(msg, name, self._items(msg, name, value, keys, prefix))
        else:
            setattr(msg, name, "" if value is None else value)

    def _fill_one(self, old: Any, value: Any, keys: Mapping[str, Any], prefix: str) -> None:
        if isinstance(old, TVal) and isinstance(value, int):
            old.set(value // 1_000_000_000, value % 1_000_000_000)
        else:
            self._fill(old, value, keys, prefix)

    def _items(self, msg: Any, name: str, values: Any, keys: Mapping[str, Any], prefix: str) -> list[Any]:
        if not isinstance(values, (list, tuple)):
            kind = type(values).__name__
            raise MessageException(f"Field [{prefix}{name}] must be a list or tuple instead of: {kind}")
        base, _, length = msg._slot_types[msg.__slots__.index(name)].rstrip("]").partition("[")
        if length and len(values) != int(length):
            counts = f"{len(values)} != {length}"
            raise MessageException(f"Field [{prefix}{name}] has incorrect number of elements: {counts}")
        if "/" not in base and base not in _TIMES:
            return list(values)
        made = [(_TIMES.get(base) or self._class_of(base))() for _ in values]
        for item, value in zip(made, values, strict=True):
            self._fill_one(item, value, keys, f"{prefix}{name}[].")
        return made


def _check_count(msg: Any, values: list[Any], prefix: str) -> None:
    if len(values) == len(msg.__slots__):
        return
    problem = "Too many" if len(values) > len(msg.__slots__) else "Not enough"
    expected = [prefix + name for name in msg.__slots__]
    raise MessageException(f"{problem} arguments:\n * Given: {values}\n * Expected: {expected}")


def get_printable_message_args(msg: Any, buff: Any = None, prefix: str = "") -> str:
    """Dotted names of all fields, nested ones included, with spaces between.

    Args:
        msg: the message.
        buff: text file to write to instead of returning, as genpy uses it in its recursion.
        prefix: put before each name.
    """
    names = " ".join(_names(msg, prefix))
    if buff is not None:
        buff.write(names + " ")
        names = str(buff.getvalue()).rstrip()
    return names


def _names(msg: Any, prefix: str) -> list[str]:
    names: list[str] = []
    for name in msg.__slots__:
        value = getattr(msg, name)
        names += _names(value, f"{prefix}{name}.") if isinstance(value, Message) else [prefix + name]
    return names
