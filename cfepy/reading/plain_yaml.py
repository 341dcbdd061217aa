"""YAML of files and of texts inside files, read within limits: the only way for cfepy to read YAML.

A document is checked before any value is built from it. The check counts expanded values: aliases that multiply or
contain themselves, nested lists, long numbers (`cfepy.reading.input_limits`). Any error in a value is a YamlError with
its line. `cfepy.reading.marked_yaml` reads files whose values keep their lines. PyYAML is loaded when there is a text
to read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from cfepy.reading.input_limits import YAML_BYTES, YAML_DEPTH, YAML_DIGITS, YAML_VALUES

_NUMBER = re.compile(r"[-+0-9][0-9a-fA-F_:.xXoO]*")
_QUOTED = ("'", '"', "|", ">")
_TOO_DEEP = "exceeded maximum nesting depth"
"""The error of the libyaml in PyYAML 6.0.4 and later; it reads ahead, so its limit can apply before `_Sizes`."""
_FLAWED = (ValueError, AttributeError, LookupError, TypeError, ArithmeticError)
"""The exceptions of PyYAML's constructors for a value that does not match its tag, such as `!!timestamp soon`."""


class YamlError(ValueError):
    """Exception for a text that is not YAML or exceeds a limit.

    Args:
        text: the error.
        line: its line, from 1; None if unknown.
    """

    def __init__(self, text: str, line: int | None = None) -> None:
        super().__init__(text if line is None else f"{text}, line {line} of it")
        self.text = text
        self.line = line


def safe_loader() -> type[Any]:
    """Return PyYAML's safe loader, the fast one if it was built."""
    import yaml

    found: type[Any] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    return found


def plain_yaml(text: str, loader: type[Any] | None = None) -> Any:
    """Return the value of a YAML text with one document, or None if it is empty.

    Args:
        text: the document.
        loader: a loader derived from `safe_loader`; None for `safe_loader` itself.

    Raises:
        YamlError: if it is not YAML or exceeds a limit.
    """
    with opened(text, loader) as found:
        node = found.get_single_node()
        return None if node is None else _document(found, node)


def plain_documents(text: str) -> list[Any]:
    """Return the values of the documents of a YAML text; see `plain_yaml` for the errors."""
    values = []
    with opened(text) as found:
        while found.check_node():
            values.append(_document(found, found.get_node()))
    return values


@contextmanager
def opened(text: str, loader: type[Any] | None = None) -> Iterator[Any]:
    """Open PyYAML's loader on a text within the limits; see `plain_yaml` for the errors, also of code inside the `with`
    block.
    """
    import yaml

    make = safe_loader() if loader is None else loader
    used: Any = None
    try:
        _check(text, make)
        used = make(text)
        yield used
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = None if mark is None else mark.line + 1
        if error.problem == _TOO_DEEP:
            raise YamlError("is nested too deeply", line) from None
        hint = "; indent with blanks, not with tabs" if mark is not None and _is_tab(text, mark) else ""
        raise YamlError(f"is not YAML: {error.problem or error.context}{hint}", line) from None
    except yaml.reader.ReaderError as error:
        raise _control_character(text, error) from None
    except yaml.YAMLError as error:
        raise YamlError(f"is not YAML: {error}") from None
    except UnicodeError:
        raise YamlError("is not YAML: it has characters that are not allowed in text") from None
    finally:
        if used is not None:
            used.dispose()


def _is_tab(text: str, mark: Any) -> bool:
    lines = text.split("\n")
    return bool(mark.line < len(lines) and lines[mark.line][mark.column : mark.column + 1] == "\t")


def _control_character(text: str, error: Any) -> YamlError:
    """Return the error about a character that YAML does not allow; libyaml gives its position in bytes."""
    code = error.character if isinstance(error.character, int) else ord(error.character)
    line = text.encode("utf-8", "surrogatepass")[: error.position].count(b"\n") + 1
    return YamlError(f"is not YAML: it has the control character 0x{code:02X}; remove it", line)


def constructed(loader: Any, node: Any) -> Any:
    """Return the Python value of a node without nodes inside it.

    Raises:
        YamlError: if it does not match its tag.
    """
    try:
        return loader.construct_object(node)
    except _FLAWED as error:
        raise _flaw(node, error) from None


def _document(loader: Any, node: Any) -> Any:
    try:
        return loader.construct_document(node)
    except _FLAWED as error:
        flawed = next((each for each in _scalars(node) if _is_flawed(loader, each)), node)
        raise error if isinstance(error, YamlError) else _flaw(flawed, error) from None


def _scalars(node: Any) -> Iterator[Any]:
    if node.id == "scalar":
        yield node
        return
    for each in node.value:
        for part in each if isinstance(each, tuple) else (each,):
            yield from _scalars(part)


def _is_flawed(loader: Any, node: Any) -> bool:
    try:
        loader.construct_object(node)
    except Exception:
        return True
    return False


def _flaw(node: Any, error: Exception) -> YamlError:
    kind = str(node.tag).rpartition(":")[2]
    return YamlError(f"has an invalid {kind}: {error}", node.start_mark.line + 1)


def _check(text: str, loader: type[Any]) -> None:
    """Check a text event by event, and refuse one that exceeds a limit."""
    if len(text) > YAML_BYTES:
        raise YamlError(f"has more than {YAML_BYTES:,} characters; split it")
    found = loader(text)
    try:
        _Sizes().take(found)
    finally:
        found.dispose()


class _Sizes:
    """Counts the values of a text with its aliases expanded."""

    def __init__(self) -> None:
        self._inside: list[tuple[str | None, int]] = []  # anchors of open nodes, and the number of values before each
        self._values = 0
        self._sizes: dict[str, int | None] = {}  # by anchor; None for a node that is not complete

    def take(self, loader: Any) -> None:
        """Count all events of a loader."""
        from yaml import events

        while loader.check_event():
            event = loader.get_event()
            if isinstance(event, events.CollectionStartEvent):
                self._begin(event)
            elif isinstance(event, events.CollectionEndEvent):
                self._end()
            elif isinstance(event, events.ScalarEvent):
                self._scalar(event)
            elif isinstance(event, events.AliasEvent):
                self._alias(event)
            elif isinstance(event, events.DocumentStartEvent):
                self._sizes.clear()

    def _add(self, values: int, event: Any) -> None:
        self._values += values
        if self._values > YAML_VALUES:
            what = f"has more than {YAML_VALUES:,} values when its aliases are written out; split it"
            raise YamlError(what, event.start_mark.line + 1)

    def _begin(self, event: Any) -> None:
        if len(self._inside) == YAML_DEPTH:
            raise YamlError(f"is nested too deeply: more than {YAML_DEPTH} levels", event.start_mark.line + 1)
        self._inside.append((event.anchor, self._values))
        if event.anchor is not None:
            self._sizes[event.anchor] = None
        self._add(1, event)

    def _end(self) -> None:
        anchor, before = self._inside.pop()
        if anchor is not None:
            self._sizes[anchor] = self._values - before

    def _scalar(self, event: Any) -> None:
        self._add(1, event)
        if event.anchor is not None:
            self._sizes[event.anchor] = 1
        is_text = event.style in _QUOTED and event.tag is None
        if len(event.value) > YAML_DIGITS and not is_text and _NUMBER.fullmatch(event.value):
            raise YamlError(f"has a number with more than {YAML_DIGITS:,} digits", event.start_mark.line + 1)

    def _alias(self, event: Any) -> None:
        size = self._sizes.get(event.anchor, 1)  # the composer reports a missing anchor
        if size is None:
            raise YamlError("has an alias that contains itself", event.start_mark.line + 1)
        self._add(size, event)
