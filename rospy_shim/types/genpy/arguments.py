"""`fill_message_args` and `get_printable_message_args` of genpy.message: YAML-like values into a message, and its field
names for a usage line.

Command-line tools and some nodes use them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from rospy_shim.types.genpy.errors import MessageException
from rospy_shim.types.genpy.message import Message
from rospy_shim.types.genpy.rostime import Duration, Time, TVal

_NO_KEYS: Mapping[str, Any] = {}
_TIMES: Mapping[str, type[TVal]] = {"time": Time, "duration": Duration}


class ArgumentFiller:
    """`fill_message_args` for one set of message types."""

    def __init__(self, class_of: Callable[[str], Any]) -> None:
        """Make a filler.

        Args:
            class_of: returns the message class by full name, or None if there is no such class; for arrays of messages.
        """
        self._class_of = class_of

    def fill_message_args(self, msg: Any, msg_args: Any, keys: Mapping[str, Any] = _NO_KEYS) -> None:
        """Set a message's fields from plain values.

        Args:
            msg: the message.
            msg_args: a list with one value per field, or a list that holds one dict of values by field name.
            keys: words that stand for a whole message or time, e.g. "now" or "auto".

        Raises:
            MessageException: a field or word that does not exist, or too few, too many or unfit values.
            ValueError: something that is neither a list nor a dict where a message's fields are expected.
        """
        given = [] if msg_args is None else msg_args
        alone = len(given) == 1 and type(given[0]) is dict
        self._fill(msg, given[0] if alone else given, keys, "")

    def _fill(self, msg: Any, values: Any, keys: Mapping[str, Any], prefix: str) -> None:
        if not isinstance(msg, (Message, TVal)):
            raise ValueError(f"msg must be a Message instance: {msg}")
        if type(values) is dict:
            for name, value in values.items():
                self._set(msg, name, "" if value is None else value, keys, prefix)
        elif type(values) is list:
            _check_count(msg, values)
            for name, value in zip(msg.__slots__, values, strict=True):
                self._set(msg, name, value, keys, prefix)
        else:
            raise ValueError(f"invalid msg_args type: {values}")

    def _set(self, msg: Any, name: str, value: Any, keys: Mapping[str, Any], prefix: str) -> None:
        if name not in msg.__slots__:
            raise MessageException(f"No field name [{prefix}{name}]")
        old = getattr(msg, name)
        if isinstance(old, (Message, TVal)):
            if type(value) is str:
                if value not in keys:
                    raise MessageException(f"No key named [{value}]")
                setattr(msg, name, keys[value])
            elif isinstance(old, TVal) and type(value) is int:
                setattr(msg, name, _time_of(old, value))
            else:
                self._fill(old, value, keys, f"{prefix}{name}.")
        elif type(old) is list:
            self._set_array(msg, name, value, keys, prefix)
        else:
            setattr(msg, name, value)

    def _set_array(self, msg: Any, name: str, values: Any, keys: Mapping[str, Any], prefix: str) -> None:
        if type(values) not in (list, tuple):
            kind = type(values).__name__
            raise MessageException(f"Field [{prefix}{name}] must be a list or tuple instead of: {kind}")
        base, _, length = msg._slot_types[msg.__slots__.index(name)].rstrip("]").partition("[")
        if length and len(values) != int(length):
            counts = f"{len(values)} != {length}"
            raise MessageException(f"Field [{prefix}{name}] has incorrect number of elements: {counts}")
        if "/" not in base and base not in _TIMES:
            setattr(msg, name, values)
            return
        cls = _TIMES.get(base) or self._class_of(base)
        if cls is None:
            problem = f"Cannot instantiate messages for field [{prefix}{name}] : cannot load class {base}"
            raise MessageException(problem)
        getattr(msg, name)[:] = [self._item(cls(), value, keys, prefix) for value in values]

    def _item(self, item: Any, value: Any, keys: Mapping[str, Any], prefix: str) -> Any:
        if isinstance(item, TVal) and type(value) is int:
            return _time_of(item, value)
        self._fill(item, value, keys, prefix)
        return item


def _time_of(old: TVal, nanoseconds: int) -> TVal:
    """Return a time given as one number; genpy converts it to a float and loses the last digits, and so does this."""
    found: TVal = type(old).from_sec(nanoseconds / 1e9)
    return found


def _check_count(msg: Any, values: list[Any]) -> None:
    if len(values) != len(msg.__slots__):
        problem = "Too many" if len(values) > len(msg.__slots__) else "Not enough"
        raise MessageException(f"{problem} arguments:\n * Given: {values}\n * Expected: {msg.__slots__}")


def get_printable_message_args(msg: Any, buff: Any = None, prefix: str = "") -> str:
    """Return dotted names of all fields, nested ones included, with spaces between.

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
