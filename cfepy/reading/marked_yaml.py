"""YAML with the line of every value, so that errors can name it.

`load` returns a tree of `Marked`. It refuses a file that is not YAML, exceeds a limit (`cfepy.reading.plain_yaml`), has
a duplicate key, or has a key that is not text. A reader of the tree collects mistakes in
`cfepy.reading.mistakes.Mistakes`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cfepy.reading.input_files import text_limited, unreadable
from cfepy.reading.input_limits import YAML_BYTES
from cfepy.reading.plain_yaml import YamlError, constructed, opened
from cfepy.reading.suggestions import expected
from cfepy.status import UsageError, together
from cfepy.units import TIME_UNITS

MOST = (1 << 62) - 1  # the largest time in ns
MOST_SECONDS = 1e9
MOST_SHOWN = 80
"""Characters of a value in an error."""


@dataclass(frozen=True, slots=True)
class Marked:
    """A value of a file with its position.

    Attributes:
        value: a scalar, a list of Marked, or a dict of text to Marked.
        file: the file of the value.
        line: its line in the file, from 1.
        field: dotted path, "limits.sb_max_pipes"; "" for the whole file.
    """

    value: Any
    file: Path
    line: int
    field: str

    def fail(self, text: str) -> UsageError:
        """Return the error to raise about this value; `text` describes the mistake and the remedy."""
        return UsageError(text, file=self.file, line=self.line or None, field=self.field or None)

    def mapping(self, known: Iterable[str] | None = None) -> dict[str, Marked]:
        """Return the value as a mapping, empty if there is no value.

        Args:
            known: the allowed keys; None for any.

        Raises:
            UsageError: if it is not a mapping, or for all unknown keys together.
        """
        if self.value is None:
            return {}
        if not isinstance(self.value, dict):
            raise self.fail(f"must be a mapping of names to values, not {self.shown()}")
        if known is not None:
            allowed = tuple(known)
            unknown = [item.unknown(name, allowed) for name, item in self.value.items() if name not in allowed]
            if unknown:
                raise together(unknown)
        return self.value

    def unknown(self, name: str, known: Iterable[str]) -> UsageError:
        """Return the error to raise about the unknown key of this value.

        Args:
            name: the key.
            known: the allowed keys.
        """
        return self.fail(f"unknown field; {expected(name, known)}")

    def items(self) -> list[Marked]:
        """Return the value as a list, empty if there is no value.

        Raises:
            UsageError: if it is not a list.
        """
        if self.value is None:
            return []
        if not isinstance(self.value, list):
            raise self.fail(f"must be a list, not {self.shown()}")
        return self.value

    def integer(self, lowest: int = 0, highest: int = MOST) -> int:
        """Return the value as a whole number from `lowest` to `highest`.

        Raises:
            UsageError: if it is not.
        """
        if not isinstance(self.value, int) or isinstance(self.value, bool) or self.value < lowest:
            raise self.fail(f"must be a whole number of at least {lowest}, not {self.shown()}")
        if self.value > highest:
            raise self.fail(f"must be at most {highest}, not {self.value}")
        return self.value

    def text(self) -> str:
        """Return the value as text.

        Raises:
            UsageError: if it is not text.
        """
        if not isinstance(self.value, str):
            raise self.fail(f"must be text, not {self.shown()}; put it in quotes")
        return self.value

    def written(self) -> str:
        """Return a single value as text: text itself, a number, or true or false.

        Raises:
            UsageError: if it is nothing, a list, a mapping or a date.
        """
        if not isinstance(self.value, str | int | float):
            raise self.fail(f"must be text or a number, not {self.shown()}; put it in quotes")
        return str(self.value)

    def flag(self) -> bool:
        """Return the value as true or false.

        Raises:
            UsageError: if it is neither.
        """
        if not isinstance(self.value, bool):
            raise self.fail(f"must be true or false, not {self.shown()}")
        return self.value

    def time(self) -> int:
        """Return the value as a time in ns. It is a number of seconds, or has a unit: 0.5, "0.5 s", "20 ms", "50 us".

        Raises:
            UsageError: if it is not a time.
        """
        number, unit = (self.value, "s") if not isinstance(self.value, str) else _split(self.value)
        try:
            if isinstance(number, bool) or not 0 <= float(number) < MOST_SECONDS:
                raise ValueError
            return round(float(number) * TIME_UNITS[unit])
        except (TypeError, ValueError, KeyError):
            raise self.fail(f"must be a time such as 0.5, 0.5 s or 20 ms, not {self.shown()}") from None

    def plain(self) -> Any:
        """Return the value without its marks."""
        if isinstance(self.value, dict):
            return {name: item.plain() for name, item in self.value.items()}
        return [item.plain() for item in self.value] if isinstance(self.value, list) else self.value

    def shown(self) -> str:
        """Return the value for an error, as YAML has it; a long one is cut."""
        text = _shown(self.value)
        return text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]}..."


def _shown(value: Any) -> str:
    if isinstance(value, Marked):
        return _shown(value.value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name}: {_shown(item)}" for name, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_shown, value)) + "]"
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return "true" if value else "false"
    if type(value).__name__ in ("date", "datetime"):
        return f"the date {value}"
    return "bytes" if isinstance(value, bytes) else repr(value)


def _split(text: str) -> tuple[str, str]:
    """Return a number and its unit."""
    number = text.rstrip("abcdefghijklmnopqrstuvwxyz ")
    return number, text[len(number) :].strip() or "s"


def load(path: Path, *, handed: bool = False) -> Marked:
    """Read a YAML file.

    Args:
        path: the file.
        handed: whether the path is from the command line; see `cfepy.reading.input_files.open_input`.

    Raises:
        UsageError: if it cannot be read or is not valid YAML.
    """
    try:
        text = text_limited(path, YAML_BYTES, handed=handed)
    except OSError as error:
        raise unreadable(path, error) from None
    except UnicodeDecodeError:
        raise UsageError("is not UTF-8 text", file=path) from None
    try:
        with opened(text) as loader:
            node = loader.get_single_node()
            return Marked(None, path, 1, "") if node is None else _mark(loader, node, path, "")
    except YamlError as error:
        raise UsageError(error.text, file=path, line=error.line) from None


def _mark(loader: Any, node: Any, path: Path, field: str) -> Marked:
    """Return a composed node as Marked; the loader's own constructor turns scalars into Python values."""
    line = node.start_mark.line + 1
    if node.id != "scalar" and not node.tag.endswith((":map", ":seq", ":omap", ":set")):
        raise YamlError(f"unknown tag {node.tag}; leave it out", line)
    if node.id == "mapping":
        return Marked(dict(_pairs(loader, node, path, field)), path, line, field)
    if node.id == "sequence":
        items = [_mark(loader, item, path, f"{field}[{index}]") for index, item in enumerate(node.value)]
        return Marked(items, path, line, field)
    try:
        return Marked(constructed(loader, node), path, line, field)
    except YamlError as error:
        raise UsageError(error.text, file=path, line=error.line, field=field or None) from None


def _pairs(loader: Any, node: Any, path: Path, field: str) -> Iterator[tuple[str, Marked]]:
    seen: set[str] = set()
    for key_node, value_node in node.value:
        key = _mark(loader, key_node, path, field)
        name = key.text()
        if name in seen:
            raise key.fail(f"{name!r} is given twice; remove one")
        seen.add(name)
        yield name, _mark(loader, value_node, path, f"{field}.{name}" if field else name)
