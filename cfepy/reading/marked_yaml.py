"""YAML with the line of every value, so that errors can name it.

`load` returns a tree of `Marked`. It refuses a file that is not YAML, exceeds a limit (`cfepy.reading.plain_yaml`), has
a duplicate key, or has a key that is not text. A reader of the tree reports mistakes to `Mistakes`, which raises the
first one or collects all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import YAML_BYTES
from cfepy.reading.plain_yaml import YamlError, constructed, opened
from cfepy.status import UsageError
from cfepy.units import TIME_UNITS

MOST = (1 << 62) - 1  # the largest time in ns
MOST_SECONDS = 1e9
T = TypeVar("T")


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
        return UsageError(text, file=self.file, line=self.line, field=self.field or None)

    def mapping(self, known: Iterable[str] | None = None) -> dict[str, Marked]:
        """Return the value as a mapping, empty if there is no value.

        Args:
            known: the allowed keys; None for any.

        Raises:
            UsageError: if it is not a mapping or has an unknown key.
        """
        if self.value is None:
            return {}
        if not isinstance(self.value, dict):
            raise self.fail(f"must be a mapping of names to values, not {self.plain()!r}")
        allowed = None if known is None else tuple(known)
        for name, item in self.value.items():
            if allowed is not None and name not in allowed:
                raise item.unknown(allowed)
        return self.value

    def unknown(self, known: Iterable[str]) -> UsageError:
        """Return the error to raise about an unknown key."""
        return self.fail(f"unknown field; known fields are {', '.join(known)}")

    def items(self) -> list[Marked]:
        """Return the value as a list, empty if there is no value.

        Raises:
            UsageError: if it is not a list.
        """
        if self.value is None:
            return []
        if not isinstance(self.value, list):
            raise self.fail(f"must be a list, not {self.plain()!r}")
        return self.value

    def integer(self, lowest: int = 0, highest: int = MOST) -> int:
        """Return the value as a whole number from `lowest` to `highest`.

        Raises:
            UsageError: if it is not.
        """
        if not isinstance(self.value, int) or isinstance(self.value, bool) or self.value < lowest:
            raise self.fail(f"must be a whole number of at least {lowest}, not {self.plain()!r}")
        if self.value > highest:
            raise self.fail(f"must be at most {highest}, not {self.value}")
        return self.value

    def text(self) -> str:
        """Return the value as text.

        Raises:
            UsageError: if it is not text.
        """
        if not isinstance(self.value, str):
            raise self.fail(f"must be text, not {self.plain()!r}; put it in quotes")
        return self.value

    def flag(self) -> bool:
        """Return the value as true or false.

        Raises:
            UsageError: if it is neither.
        """
        if not isinstance(self.value, bool):
            raise self.fail(f"must be true or false, not {self.plain()!r}")
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
            raise self.fail(f"must be a time such as 0.5, 0.5 s or 20 ms, not {self.plain()!r}") from None

    def plain(self) -> Any:
        """Return the value without its marks."""
        if isinstance(self.value, dict):
            return {name: item.plain() for name, item in self.value.items()}
        return [item.plain() for item in self.value] if isinstance(self.value, list) else self.value


def _split(text: str) -> tuple[str, str]:
    """Return a number and its unit."""
    number = text.rstrip("abcdefghijklmnopqrstuvwxyz ")
    return number, text[len(number) :].strip() or "s"


class Mistakes:
    """Collects mistakes while a file is read, or ends the reading at the first one.

    Args:
        keep: collect all, as a check of the file does; otherwise raise the first one, as before a run.

    Attributes:
        errors: the collected mistakes.
    """

    def __init__(self, keep: bool = False) -> None:
        self.errors: list[UsageError] = []
        self._keep = keep

    def add(self, error: UsageError) -> None:
        """Report a mistake.

        Raises:
            UsageError: the mistake, unless mistakes are collected.
        """
        if not self._keep:
            raise error
        self.errors.append(error)

    def attempt(self, read: Callable[[], T]) -> T | None:
        """Return the result of `read`, or None if it fails; see `add` for the errors."""
        try:
            return read()
        except UsageError as error:
            self.add(error)
            return None

    def mapping(self, entry: Marked) -> dict[str, Marked]:
        """Return a value as a mapping with any keys, or an empty one if it is not a mapping; see `add` for the
        errors.
        """
        return self.attempt(entry.mapping) or {}

    def fields(self, entry: Marked, known: Iterable[str]) -> Iterator[tuple[str, Marked]]:
        """Yield the known keys of a mapping with their values, and report unknown keys; see `add` for the errors."""
        allowed = tuple(known)
        for name, item in self.mapping(entry).items():
            if name in allowed:
                yield name, item
            else:
                self.add(item.unknown(allowed))


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
        raise UsageError(f"cannot be read: {error.strerror}", file=path) from None
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
    return Marked(constructed(loader, node), path, line, field)


def _pairs(loader: Any, node: Any, path: Path, field: str) -> Iterator[tuple[str, Marked]]:
    seen: set[str] = set()
    for key_node, value_node in node.value:
        key = _mark(loader, key_node, path, field)
        name = key.text()
        if name in seen:
            raise key.fail(f"{name!r} is given twice; remove one")
        seen.add(name)
        yield name, _mark(loader, value_node, path, f"{field}.{name}" if field else name)
