"""Validation of a journal's frames: kinds of values, sizes, and paths that stay inside a folder.

A journal may come from another person. Frames that pass need no further checks.
"""

from __future__ import annotations

import string
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from typing import Any

from cfepy.journal.snapshots import KINDS
from cfepy.pilot import RunPlan
from cfepy.reading.contained_files import is_contained
from cfepy.reading.input_limits import JOURNAL_FILE_BYTES, JOURNAL_VALUES

FORMAT = 1  # of a journal
Check = Callable[[Any], bool]
_SMALL = 1 << 16  # size in bytes of a frame that cannot expand much
_MOST = 1 << 62  # largest number; virtual times in ns fit


def _whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < _MOST


def _number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < _MOST


def _flag(value: Any) -> bool:
    return isinstance(value, bool)


def _text(value: Any) -> bool:
    return isinstance(value, str) and "\0" not in value


def _digits(value: Any) -> bool:
    return isinstance(value, str) and set(value) <= set(string.hexdigits)


def _data(value: Any) -> bool:
    return isinstance(value, bytes)


def _perhaps(check: Check) -> Check:
    return lambda value: value is None or check(value)


def _list(check: Check) -> Check:
    return lambda value: isinstance(value, (list, tuple)) and all(map(check, value))


def _table(key: Check, check: Check) -> Check:
    return lambda value: isinstance(value, Mapping) and all(map(key, value)) and all(map(check, value.values()))


def _any(value: Any) -> bool:
    return True


def _named(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) == 2 and isinstance(value[0], str)


def _name_of_file(value: Any) -> bool:
    return _text(value) and value not in ("", ".", "..") and "/" not in value


def _variable(value: Any) -> bool:
    return _text(value) and value != "" and "=" not in value


def _point(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) == 3 and _whole(value[0]) and _whole(value[1])


def _gaps(value: Any) -> bool:
    return _list(_whole)(value) and len(value) % 2 == 0


def _instant(value: Any) -> bool:
    """Return whether a value is a time; -1 is before the first part of the run (`Outside.until_ns`)."""
    return _whole(value) or (value == -1 and isinstance(value, int))


def _size(value: Any) -> bool:
    return _whole(value) and value <= JOURNAL_FILE_BYTES


FRAMES: dict[str, dict[str, Check]] = {
    "header": {
        "plan": _any,  # see PLAN
        "paced": _perhaps(_number),
        "policy": _perhaps(_table(_text, _any)),
        "mission": _text,
        "folder": is_contained,
        "startup": is_contained,
        "cwd": is_contained,
        "environ": _table(_variable, _text),
        "versions": _table(_text, _text),
        "host": _table(_text, _text),
        "format": _whole,
    },
    "file": {"path": is_contained, "size": _whole, "sha256": _digits, "packed": _perhaps(_data), "mode": _whole},
    "folder": {"path": is_contained, "names": _table(_name_of_file, _flag)},
    "look": {
        "path": is_contained,
        "kind": lambda value: value in KINDS,
        "size": _whole,
        "mode": _whole,
        "time_ns": _whole,
        "target": _text,
    },
    "pause": {"until_ns": _instant, "visits": _whole, "events": _list(_named)},
    "answer": {"values": _list(_any)},
    "check": {"at": _point, "decisions": _gaps, "decided": _whole},
    "end": {
        "reason": _text,
        "until_ns": _instant,
        "visits": _whole,
        "now_ns": _whole,
        "records": _whole,
        "trace": _text,
        "results": _text,
        "outcome": _table(_text, _any),
        "beside": _list(_text),
    },
}
PLAN: dict[str, Check] = {
    "words": lambda value: _list(_text)(value) and len(value) > 0,
    "command": lambda value: value in ("run", "launch", "node"),
    "launch_args": _list(lambda value: _named(value) and _text(value[0]) and _text(value[1])),
    "seconds": _perhaps(_number),
    "seed": lambda value: isinstance(value, int) and not isinstance(value, bool),
    "board": _perhaps(_text),
    "tasks": _text,
    "schedule": _text,
    "script": _perhaps(_text),
    "stop_on_failure": _flag,
    "faults": _perhaps(_text),
    "play": _perhaps(_text),
    "play_options": _perhaps(_text),
    "stall": _number,
    "guard": _flag,
    "races": _flag,
    "cpp_nodes": _perhaps(_text),
    "settings": _list(lambda value: _named(value) and _text(value[0]) and _text(value[1])),
    "spacecraft_id": _perhaps(_whole),
    "processor_id": _perhaps(_whole),
    "beside": _list(_text),
}
_LATER = {"outcome", "mode", "cpp_nodes", "races", "settings", "play_options", "beside"}  # may be missing


def problem_of(kind: str, body: Any) -> str | None:
    """Return the error in a frame; None if it is valid. Unknown kinds and fields are from a later version."""
    wanted = FRAMES.get(kind)
    if wanted is None:
        return None
    if not isinstance(body, Mapping):
        return f"a frame {kind!r} is not a mapping"
    if kind == "header" and _whole(body.get("format")) and body["format"] != FORMAT:
        return None  # it has other fields
    found = _problem(kind, body, wanted)
    if found is None and kind == "file" and body["packed"] is not None and not _size(body["size"]):
        return f"the file {body['path']} must have at most {JOURNAL_FILE_BYTES:,} bytes, not {body['size']:,}"
    if found is None and kind == "header":
        needed = {each.name for each in fields(RunPlan) if each.default is MISSING and each.default_factory is MISSING}
        plan = body["plan"]
        return _problem("plan", plan, PLAN, needed) if isinstance(plan, Mapping) else "its plan is not a mapping"
    return found


def _problem(
    kind: str, body: Mapping[Any, Any], wanted: Mapping[str, Check], needed: set[str] | None = None
) -> str | None:
    for name, check in wanted.items():
        if name not in body:
            if name in (needed if needed is not None else set(wanted) - _LATER):
                return f"a frame {kind!r} has no {name!r}"
        elif not check(body[name]):
            shown = repr(body[name])
            return f"{name!r} of a frame {kind!r} cannot be {shown if len(shown) < 80 else shown[:80] + '...'}"
    return None


# -- before a frame is unpacked (github.com/msgpack/msgpack/blob/master/spec.md) ---------------------------------------

_PLAIN = dict(zip(range(0xCA, 0xD9), (4, 8, 1, 2, 4, 8, 1, 2, 4, 8, 2, 3, 5, 9, 17), strict=True))
"""Number of bytes that follow, by first byte: floating-point numbers, integers, short extensions."""
_SIZED = {0xC4: 1, 0xC5: 2, 0xC6: 4, 0xC7: 1, 0xC8: 2, 0xC9: 4, 0xD9: 1, 0xDA: 2, 0xDB: 4}
"""Number of bytes of the length that follows: data, extensions and texts."""
_COUNTED = {0xDC: (2, 1), 0xDD: (4, 1), 0xDE: (2, 2), 0xDF: (4, 2)}
"""Number of bytes of the count that follows, and values per item: lists and mappings."""


def check_values(data: bytes) -> None:
    """Refuse packed data that would expand too much: an empty list takes one byte packed and sixty in memory.

    Raises:
        ValueError: if it has too many values, or is cut off.
    """
    if len(data) <= _SMALL:
        return
    at, left = 0, 1
    for _ in range(JOURNAL_VALUES):
        if not left:
            return
        if at >= len(data):
            raise ValueError("a frame is truncated")
        step, inner = _value_at(data, at)
        at += step
        left += inner - 1
    raise ValueError(f"a frame has more than {JOURNAL_VALUES:,} values; record a shorter run")


def _value_at(data: bytes, at: int) -> tuple[int, int]:
    """Return the size of a packed value in bytes, and the number of values in it."""
    first = data[at]
    if 0x80 <= first < 0xA0:
        return 1, (first & 15) * (2 if first < 0x90 else 1)
    if 0xA0 <= first < 0xC0:
        return 1 + (first & 31), 0
    width = _SIZED.get(first)
    if width is not None:
        is_extension = 0xC7 <= first <= 0xC9
        return 1 + width + is_extension + int.from_bytes(data[at + 1 : at + 1 + width], "big"), 0
    if first in _COUNTED:
        width, each = _COUNTED[first]
        return 1 + width, each * int.from_bytes(data[at + 1 : at + 1 + width], "big")
    return 1 + _PLAIN.get(first, 0), 0
