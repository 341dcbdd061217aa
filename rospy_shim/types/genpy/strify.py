"""Messages as text: `strify_message`, which makes the text of `str(msg)`, `print(msg)` and `rostopic echo`.

The layout is genpy's: YAML-like, nested messages indented by two spaces, strings in double quotes, nanoseconds padded
to nine places. PyYAML is loaded only for strings that need escapes and for lists of strings.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rospy_shim.types.genpy.rostime import Time, TVal

_PLAIN_LIMIT = 60  # YAML folds longer strings over several lines
_Filter = Callable[[Any], list[str]]


def strify_message(
    val: Any,
    indent: str = "",
    time_offset: Time | None = None,
    current_time: Time | None = None,
    field_filter: _Filter | None = None,
    fixed_numeric_width: int | None = None,
) -> str:
    """Return the text of a message or of a field's value.

    Args:
        val: the message or value.
        indent: put before each line of a message.
        time_offset: Times are printed relative to this one.
        current_time: not used, as in genpy.
        field_filter: returns the names of the fields of a message to print; they are printed in the message's order.
        fixed_numeric_width: width of integers in columns, and digits of floats, cut to the width.
    """
    return _Writer(time_offset, field_filter, fixed_numeric_width).text(val, indent)


class _Writer:
    __slots__ = ("fields_of", "offset", "width")

    def __init__(self, offset: Time | None, fields_of: _Filter | None, width: int | None) -> None:
        self.offset, self.fields_of, self.width = offset, fields_of, width

    def text(self, val: Any, indent: str) -> str:
        kind = type(val)
        if kind in (int, float) and self.width is not None:
            return self.number(val)
        if kind in (int, float, bool):
            return str(val)
        if isinstance(val, str):
            return _quoted(val)
        if isinstance(val, TVal):
            return self.time(val, indent)
        if kind in (list, tuple):
            return self.items(val, indent)
        if hasattr(val, "_get_types"):
            return self.message(val, indent)
        return str(val)

    def number(self, val: float) -> str:
        if not isinstance(val, float):
            return f"{val:{self.width}d}"
        text = f"{val:.{self.width}f}"
        return text[: max(text.find("."), self.width or 0)]

    def time(self, val: TVal, indent: str) -> str:
        if self.offset is not None and isinstance(val, Time):
            val = val - self.offset
        if self.width is not None:
            return f"\n{indent}secs: {self.number(val.secs)}\n{indent}nsecs: {self.number(val.nsecs)}"
        return f"\n{indent}secs: {val.secs}\n{indent}nsecs: {val.nsecs:9d}"

    def items(self, val: Any, indent: str) -> str:
        if len(val) == 0:
            return "[]"
        first = val[0]
        if type(first) in (int, float) and self.width is not None:
            return "[" + ", ".join(self.number(item) for item in val) + "]"
        if type(first) in (int, float, bool):
            return str(list(val))
        if isinstance(first, str):
            return _string_list(val, indent)
        return "\n" + "\n".join(f"{indent}- {self.text(item, indent + '  ')}" for item in val)

    def message(self, val: Any, indent: str) -> str:
        chosen = list(self.fields_of(val)) if self.fields_of is not None else val.__slots__
        fields = [pair for pair in zip(val.__slots__, val._slot_types, strict=False) if pair[0] in chosen]
        lines = [f"{indent}{name}: {self.field(getattr(val, name), kind, indent)}" for name, kind in fields]
        text = "\n".join(lines)
        return "\n" + text if indent else text

    def field(self, val: Any, field_type: str, indent: str) -> str:
        if field_type.startswith("uint8["):
            val = bytes_as_list(val)
        return self.text(val, indent + "  ")


def bytes_as_list(val: Any) -> Any:
    """Return the numbers of a field of bytes, which may be held as bytes, or as a text with a character for each."""
    if isinstance(val, str):
        return [ord(each) for each in val]
    return list(val) if isinstance(val, bytes) else val


def _quoted(val: str) -> str:
    if not val:
        return "''"
    if (
        type(val) is str
        and len(val) < _PLAIN_LIMIT
        and val.isascii()
        and val.isprintable()
        and '"' not in val
        and "\\" not in val
    ):
        return f'"{val}"'
    import yaml

    text: str = yaml.dump(val, default_style='"')
    return text.rstrip("\n")


def _string_list(val: Any, indent: str) -> str:
    """Return strings as YAML.

    Raises:
        AssertionError: they are in a tuple, for which YAML has another notation: genpy cannot print a message with one.
    """
    if type(val) is tuple:
        raise AssertionError
    import yaml

    text: str = yaml.dump(val, default_flow_style=False)
    return "\n" + "\n".join(indent + line for line in text.rstrip("\n").splitlines())
