"""Text form of field values: `ValU32=0x10 PacketID.AppName=HK Masks=1,2,3`.

A field is named by its path in the packet's layout, an enumeration value by its name or number.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache, partial
from typing import Any

from cfepy.msg import Cell, Command, Layout, Measurement, ValueNames, command
from cfepy.reading.mistakes import each_of
from cfepy.reading.suggestions import expected, known_as
from cfepy.status import UsageError

_TRUTH = {"true": 1, "false": 0, "1": 1, "0": 0}
_INDICES = re.compile(r"(\[\d+\])+")


def packet_of(declared: Command, words: Iterable[str]) -> bytes:
    """Return the bytes of a command from `field=value` words; missing fields are zero.

    Args:
        declared: the command.
        words: numbers as in Python (0x10, -3, 2.5), texts as they are, arrays with commas between their items.

    Raises:
        UsageError: for all unknown fields and values that do not fit; `field` is the field's path.
    """
    payload = bytearray(declared.payload.size)
    cells = {cell.path: cell for cell in declared.payload.cells()}
    given: set[str] = set()

    def set_field(word: str) -> None:
        path, equals, text = word.partition("=")
        if not equals:
            raise UsageError(f"invalid field value {word!r}; expected FIELD=VALUE")
        path = path if path in cells else known_as(path, cells)
        if path in given:
            raise UsageError("is given twice; remove one", field=path)
        given.add(path)
        for cell, item in _targets(declared.name, cells, path, text):
            declared.payload.put(cell, parse_cell(cell, item), payload)

    each_of(partial(set_field, word) for word in words)
    return bytes(command(declared.msg_id, declared.code or 0, bytes(payload)))


def _targets(owner: str, cells: Mapping[str, Cell], path: str, text: str) -> Iterable[tuple[Cell, str]]:
    """Return the cells and values that a word sets."""
    if path in cells:
        return [(cells[path], text)]
    items = [cell for cell in cells.values() if _is_item(cell.path, path)]
    if not items:
        raise unknown_field(owner, cells, path)
    texts = text.split(",") if text else []
    if len(texts) > len(items):
        raise UsageError(f"must have at most {len(items)} items, not {len(texts)}", field=path)
    return zip(items, texts, strict=False)


def _is_item(path: str, array: str) -> bool:
    return path.startswith(array + "[") and _INDICES.fullmatch(path, len(array)) is not None


def unknown_field(owner: str, paths: Iterable[str], path: str) -> UsageError:
    """Return the error for a missing field, with the existing ones.

    Args:
        owner: owner of the fields.
        paths: all paths.
        path: the missing path.
    """
    known = list(dict.fromkeys(re.sub(_INDICES, "", each) for each in paths))
    if not known:
        return UsageError(f"{owner} has no fields", field=path)
    return UsageError(f"unknown field of {owner}; {expected(path, known)}", field=path)


def parse_cell(cell: Cell, text: str) -> int | float | str:
    """Return the value of a field from its text, which may be the name of a value.

    Args:
        cell: the field.
        text: its text.

    Raises:
        UsageError: if the text is not such a value.
    """
    if cell.names is None or text[:1].isdigit() or text[:1] in ("+", "-"):
        return parse_value(cell.type, text, cell.path)
    try:
        return cell.names.number(text)
    except UsageError as error:
        raise UsageError(error.text, field=cell.path) from None


def parse_value(kind: str, text: str, path: str) -> int | float | str:
    """Return a value from its text.

    Args:
        kind: its type, such as "u16", "f32", "bool", "char[20]".
        text: its text.
        path: path of the field, for the error.

    Raises:
        UsageError: if the text is not such a value.
    """
    if kind.startswith("char"):
        return text
    try:
        if kind == "bool":
            return _TRUTH[text.lower()]
        return float(text) if kind in ("f32", "f64") else int_of(text)
    except (ValueError, KeyError):
        wanted = {"bool": "true or false", "f32": "a number", "f64": "a number"}.get(kind, "an integer")
        raise UsageError(f"must be {wanted}, not {text!r}", field=path) from None


def int_of(text: str) -> int:
    """Return an integer written as 16, 0x10 or 0b10000; leading zeros of a decimal number are ignored.

    Raises:
        ValueError: if the text is not an integer.
    """
    return int(text, 10) if text.lstrip("+-").isdigit() else int(text, 0)


def number_of(text: str) -> int | float:
    """Return a number of any kind, or true or false.

    Raises:
        ValueError: if the text is neither.
    """
    if text.lower() in _TRUTH:
        return _TRUTH[text.lower()]
    try:
        return int_of(text)
    except ValueError:
        return float(text)


def flat(values: Any, path: str = "") -> dict[str, Any]:
    """Return nested values by path: {"PacketID.AppName": "HK", "Counts[0]": 1}; texts and bytes are one value."""
    if isinstance(values, Mapping):
        inner = [(f"{path}.{key}" if path else str(key), value) for key, value in values.items()]
    elif isinstance(values, Sequence) and not isinstance(values, str | bytes):
        inner = [(f"{path}[{number}]", value) for number, value in enumerate(values)]
    else:
        return {path: values}
    return {name: leaf for each, value in inner for name, leaf in flat(value, each).items()}


def line_of(values: Mapping[str, Any], layout: Layout | None = None, raw: bool = False) -> str:
    """Return values on one line: `Count=3 PacketID.AppName=HK Masks=1,2,3`, without structs of zeros that end an array.

    Args:
        values: nested values.
        layout: their layout, for the names of values and for measurements; None shows numbers.
        raw: whether measurements are shown as their raw numbers.
    """
    return " ".join(f"{path}={text}" for path, text in texts_of(values, layout, raw).items())


def texts_of(values: Mapping[str, Any], layout: Layout | None = None, raw: bool = False) -> dict[str, str]:
    """As `line_of`, the texts by path."""
    names = {} if layout is None else named_fields(layout)
    texts = {path: names[path].text(int(text)) if path in names else text for path, text in shown(values)}
    measured = {} if layout is None or raw else measured_fields(layout)
    if measured:
        numbers = flat(values)
        for path in texts:
            items = [path] if path in measured else [each for each in measured if each.rpartition("[")[0] == path]
            if items:
                texts[path] = ",".join(measured[each].text(numbers[each]) for each in items)
    return texts


@lru_cache(maxsize=256)
def measured_fields(layout: Layout) -> Mapping[str, Measurement]:
    """Return the fields of a layout that measure something, by path."""
    return {cell.path: cell.measurement for cell in layout.cells() if cell.measurement is not None}


def violations_of(values: Mapping[str, Any], layout: Layout | None) -> dict[str, str]:
    """Return the limits, `RED` or `YELLOW`, that fields violate, by path.

    Args:
        values: nested values.
        layout: their layout; None for none.
    """
    measured = {} if layout is None else measured_fields(layout)
    numbers = flat(values) if measured else {}
    found = {path: each.violated(each.value(numbers[path])) for path, each in measured.items() if path in numbers}
    return {path: name for path, name in found.items() if name}


@lru_cache(maxsize=256)
def named_fields(layout: Layout) -> Mapping[str, ValueNames]:
    """Return the fields of a layout with named values, by path."""
    return {cell.path: cell.names for cell in layout.cells() if cell.names is not None}


def shown(values: Any, path: str = "") -> Iterable[tuple[str, str]]:
    """Return paths and texts of values for display: an array of numbers is one value, structs of zeros at its end are
    left out.

    Args:
        values: nested values.
        path: common path.
    """
    if isinstance(values, Mapping):
        for key, value in values.items():
            yield from shown(value, f"{path}.{key}" if path else str(key))
    elif isinstance(values, list | tuple) and any(isinstance(item, Mapping | list | tuple) for item in values):
        for number, item in enumerate(_without_zeros(values)):
            yield from shown(item, f"{path}[{number}]")
    elif isinstance(values, list | tuple):
        yield path, ",".join(map(text_of, values))
    else:
        yield path, text_of(values)


def _without_zeros(items: Sequence[Any]) -> Sequence[Any]:
    """Return an array up to its last item that is not all zero."""
    end = max((number for number, item in enumerate(items, 1) if any(flat(item).values())), default=0)
    return items[:end]


def text_of(value: Any) -> str:
    """Return the text of a value: bytes as hexadecimal digits, a text in quotes if it is not one word."""
    if isinstance(value, bytes | bytearray):
        return value.hex()
    if isinstance(value, float):
        return f"{value:.7g}"
    if isinstance(value, str):
        printable = value.encode("utf-8", "backslashreplace").decode()
        return printable if printable and not re.search(r"[\s\"=,]", printable) else f'"{printable}"'
    return str(int(value)) if isinstance(value, bool) else str(value)
