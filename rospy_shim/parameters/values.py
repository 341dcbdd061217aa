"""The values of parameters, limited to those of XML-RPC, and their text in ROS's parameter tables.

They are plain Python values; bytes stand for XML-RPC's base64, a `DateTime` for its dateTime.iso8601. As text a value
is JSON: `10`, `2.5`, `true`, `[1, 2]`, `{}` for an empty namespace. A text needs quotes only if it would be read as
another value: `hello`, but `"10"`. Bytes are `{"!!binary": "aGVsbG8="}`, a date and time is `{"!!timestamp":
"20261121T18:50:00"}`. A name is the full one. Characters that no ROS name has are written `%XX` as in a URL.
"""

from __future__ import annotations

import base64
import binascii
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from cfepy.reading.input_limits import PARAMETER_DEPTH

_INT_MAX = 2**31 - 1
_INT_MIN = -(2**31)
_BUILT_IN = (int, float, str, bytes, list, tuple, dict)
_BINARY, _TIME, _ESCAPED = "!!binary", "!!timestamp", "!!map"
_MARKS = (_BINARY, _TIME, _ESCAPED)
_BRACKETS = ("[", "{", '"')
_ODD = re.compile(rb"[^!-~]|[%/]")
_ESCAPE = re.compile(r"%([0-9A-F]{2})")
_DATE_TIME = re.compile(r"\d{5,8}T\d\d:\d\d:\d\d")
"""A year that counts from 1900, as in a struct tm of a node in C++, has fewer digits."""
_NOT_IN_XML = re.compile("[\x00-\x08\x0b-\x1f\ud800-\udfff\ufffe\uffff]")
_NO_NAME = "%"  # the part of a name that has no characters


@dataclass(frozen=True)
class DateTime:
    """A date and time.

    Args:
        value: as in XML-RPC, "20261121T18:50:00".
    """

    value: str

    def encode(self, out: Any) -> None:
        """Write it into a request, as the value classes of xmlrpc.client do; `out` is a text file."""
        out.write(f"<value><dateTime.iso8601>{self.value}</dateTime.iso8601></value>\n")


def marshalled(value: Any) -> Any:
    """Return a copy of a value as it is after a transfer over XML-RPC; bytes stay bytes.

    Raises:
        TypeError: None, a dictionary key that is not a string, or an object that XML-RPC cannot carry.
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
        try:
            raise KeyError(kind)  # xmlrpc.client looks the type up first, and a traceback shows both
        except KeyError:
            raise TypeError(f"cannot marshal {kind} objects")  # noqa: B904
    return marshalled(dict(vars(value)))


def _wrapped(value: Any) -> bytes | DateTime | None:
    """Return the plain value of a date and time, or of a value of xmlrpc.client; every node has its own classes for
    these.
    """
    match (type(value).__module__, type(value).__name__):
        case ("datetime", "datetime"):
            return DateTime(value.strftime("%Y%m%dT%H:%M:%S"))
        case ("xmlrpc.client", "DateTime"):
            return DateTime(value.value)
        case ("xmlrpc.client", "Binary"):
            return bytes(value.data)
    return None


def through_xml(method: str, caller: str, *arguments: Any) -> tuple[Any, ...]:
    """Return arguments of a call of the master as it receives them: XML normalizes line ends to a line feed.

    Args:
        method: method of the master.
        caller: name of the calling node.
        arguments: marshalled values.

    Raises:
        ExpatError: a text has a character that XML does not have; the position is relative to the request.
    """
    if not any(map(_has_odd_text, arguments)):
        return arguments
    from xmlrpc.client import dumps, loads

    request = dumps((caller, *arguments), method, encoding="utf-8")
    return tuple(map(marshalled, loads(request.encode("utf-8", "xmlcharrefreplace"))[0][1:]))


def _has_odd_text(value: Any) -> bool:
    if type(value) is dict:
        return any(map(_has_odd_text, value)) or any(map(_has_odd_text, value.values()))
    if type(value) is list:
        return any(map(_has_odd_text, value))
    return type(value) is str and _NOT_IN_XML.search(value) is not None


def leaves_of(name: str, value: Any) -> Iterator[tuple[str, str]]:
    """Yield (name, text) of every parameter in a value; an empty namespace counts as a parameter, except the root.

    Args:
        name: name of the value, "" for the root; written as in a table.
        value: a parameter's, or a dictionary of them.
    """
    if type(value) is not dict or not value:
        if name:
            yield name, text_of(value)
        return
    for key, inner in value.items():
        yield from leaves_of(f"{name}/{written(key)}", inner)


def leaf_names(name: str, value: Any) -> Iterator[str]:
    """Yield the names of `leaves_of`, without the texts."""
    if type(value) is not dict or not value:
        if name:
            yield name
        return
    for key, inner in value.items():
        yield from leaf_names(f"{name}/{written(key)}", inner)


def least_size(value: Any, most: int) -> int:
    """Return the minimum number of characters of a value's text; counting stops at one more than `most`."""
    size, waiting = 0, [value]
    while waiting and size <= most:
        each = waiting.pop()
        size += len(each) if isinstance(each, str | bytes) else 1
        if isinstance(each, dict):
            size += sum(map(len, each))
            waiting.extend(each.values())
        elif isinstance(each, list):
            waiting.extend(each)
    return size


def depth_of(value: Any) -> int:
    """Return the nesting depth of lists and namespaces in a value; 0 for a plain one."""
    depth, level = 0, [value]
    while level := [each for each in level if isinstance(each, dict | list)]:
        depth += 1
        if depth > PARAMETER_DEPTH:
            break
        level = [inner for each in level for inner in (each.values() if isinstance(each, dict) else each)]
    return depth


def written(part: str) -> str:
    """Return one part of a name as it is written in a table."""
    if not part:
        return _NO_NAME
    raw = part.encode("utf-8", "surrogatepass")
    return _ODD.sub(lambda match: b"%%%02X" % match[0][0], raw).decode("ascii")


def parts_of(name: str) -> list[str]:
    """Return the parts of a name in a table.

    Raises:
        ValueError: it is not a full name.
    """
    first, *parts = name.split("/")
    if first or not parts or "" in parts:
        raise ValueError(f"invalid name {name!r}; expected a full name such as /robot/rate")
    return ["" if part == _NO_NAME else _read_part(part) for part in parts]


def _read_part(part: str) -> str:
    if "%" in _ESCAPE.sub("", part):
        raise ValueError(f"invalid escape in {part!r}; expected %00 to %FF")
    raw = re.sub(rb"%([0-9A-F]{2})", lambda match: bytes([int(match[1], 16)]), part.encode("ascii"))
    return raw.decode("utf-8", "surrogatepass")


def text_of(value: Any) -> str:
    """Return the text of a value; ASCII in one line."""
    if type(value) is str and _is_plain(value):
        return value
    return json.dumps(_portable(value))


def value_of(text: str) -> Any:
    """Parse the text of a value.

    Raises:
        ValueError: it begins as JSON does and is not, or ROS cannot carry the value.
    """
    try:
        found = json.loads(text)
    except ValueError:
        if text.startswith(_BRACKETS) or not text:
            raise ValueError(f"invalid JSON {text!r}; a text that begins like JSON requires quotes") from None
        return text
    except RecursionError:
        raise ValueError("is nested too deeply") from None
    return _restored(found)


def json_of(value: Any) -> str:
    """Return a value as JSON with its texts in quotes, for nodes in C++."""
    return json.dumps(_portable(value))


def of_json(text: str) -> Any:
    """Parse the value of a JSON text.

    Raises:
        ValueError: it is not JSON, or ROS cannot carry the value.
    """
    try:
        found = json.loads(text)
    except RecursionError:
        raise ValueError("is nested too deeply") from None
    return _restored(found)


def _is_plain(text: str) -> bool:
    """Return True if a text needs no quotes."""
    if not text or not (text.isascii() and text.isprintable()) or text != text.strip() or text.startswith(_BRACKETS):
        return False
    try:
        json.loads(text)
    except ValueError:
        return True
    return False


def _portable(value: Any) -> Any:
    """Convert a value to JSON's types."""
    if type(value) is bytes:
        return {_BINARY: base64.b64encode(value).decode("ascii")}
    if type(value) is DateTime:
        return {_TIME: value.value}
    if type(value) is list:
        return [_portable(item) for item in value]
    if type(value) is not dict:
        return value
    plain = {key: _portable(item) for key, item in value.items()}
    return {_ESCAPED: plain} if _is_marked(value) else plain


def _restored(value: Any) -> Any:
    if type(value) is list:
        return [_restored(item) for item in value]
    if type(value) is dict:
        if not _is_marked(value):
            return {key: _restored(item) for key, item in value.items()}
        ((mark, inner),) = value.items()
        if mark == _ESCAPED:
            return {key: _restored(item) for key, item in dict(inner).items()}
        return _bytes(inner) if mark == _BINARY else _date_time(inner)
    if value is None:
        raise ValueError("null is not a value of a ROS parameter")
    if type(value) is int and not _INT_MIN <= value <= _INT_MAX:
        raise ValueError(f"{value} has more than 32 bits")
    return value


def _is_marked(value: dict[str, Any]) -> bool:
    return len(value) == 1 and next(iter(value)) in _MARKS


def _date_time(text: Any) -> DateTime:
    if not isinstance(text, str) or not _DATE_TIME.fullmatch(text):
        raise ValueError(f"invalid date and time {text!r}; expected a form such as 20261121T18:50:00")
    return DateTime(text)


def _bytes(text: Any) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, TypeError, ValueError) as error:
        raise ValueError(f"invalid base 64 {text!r}: {error}") from None
