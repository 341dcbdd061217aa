"""Checks of the .msg, .srv and .action files of a package, all at once before a program asks for a type.

A node meets an error only when it first imports the type. The reference is genmsg, which ROS builds packages with: a
definition that it refuses and cfepy accepts gives a warning.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import DEFINITION_BYTES
from cfepy.reading.mistakes import Mistakes
from cfepy.reading.suggestions import like
from cfepy.status import UsageError
from rospy_shim.types.msgs.definition_sources import Definition, OnDisk, messages_of, split_parts, split_service
from rospy_shim.types.msgs.library import Library, shipped
from rospy_shim.types.msgs.packages import Packages
from rospy_shim.types.msgs.spec import BUILTINS, Spec, parse

_LEGAL = re.compile(r"[A-Za-z]\w*", re.ASCII)
_TABBED = re.compile(r"\s*[\w/\[\]]+ *\t")
_KINDS = ("msg", "srv", "action")


class DefinitionFault(NamedTuple):
    """An error in a definition; `is_warning`: cfepy can work with it, but ROS cannot or interprets it differently."""

    error: UsageError
    is_warning: bool = False


def check_definitions(packages: Packages, names: Iterable[str]) -> Iterator[DefinitionFault]:
    """Yield the errors in the definitions of some packages, by file.

    Args:
        packages: the packages to find them in, with those that they need.
        names: names of the packages to check.
    """
    library = Library([OnDisk(packages, Mistakes())], base=shipped())
    for name in names:
        for folder in packages.folders(name):
            for kind in _KINDS:
                for path in sorted((folder / kind).glob(f"*.{kind}")):
                    yield from _Check(name, path, library).faults()


class _Check:
    """Checks one file.

    Args:
        package: its package.
        path: the file.
        library: knows all types.
    """

    def __init__(self, package: str, path: Path, library: Library) -> None:
        self._package = package
        self._path = path
        self._library = library

    def faults(self) -> Iterator[DefinitionFault]:
        """Yield its errors."""
        if not _LEGAL.fullmatch(self._path.stem):
            text = f"invalid type name {self._path.stem!r}; expected a letter, then letters, digits and '_'"
            yield DefinitionFault(self._error(text))
            return
        try:
            definition = Definition(text_limited(self._path, DEFINITION_BYTES, "replace"), str(self._path))
            parts = self._parts(definition)
        except OSError as error:
            yield DefinitionFault(self._error(f"cannot be read: {error.strerror}"))
            return
        except UsageError as error:
            yield DefinitionFault(error)
            return
        if self._path.suffix == ".srv" and len(split_parts(definition)) == 1:
            text = "missing line --- between request and response; everything is read as the request"
            yield DefinitionFault(self._error(text), is_warning=True)
        for name, part in parts.items():
            yield from self._part(name, part)

    def _parts(self, definition: Definition) -> dict[str, Definition]:
        """Return the messages in the file, by name.

        Raises:
            UsageError: it is an action without its three parts.
        """
        stem = self._path.stem
        if self._path.suffix == ".srv":
            return dict(zip((f"{stem}Request", f"{stem}Response"), split_service(definition), strict=True))
        if self._path.suffix == ".action":
            made = messages_of({stem: definition})
            return {stem + part: made[stem + part] for part in ("Goal", "Result", "Feedback")}
        return {stem: definition}

    def _part(self, name: str, part: Definition) -> Iterator[DefinitionFault]:
        mistakes = Mistakes()
        full_name = f"{self._package}/{name}"
        spec = parse(part.text, full_name, part.file, part.first_line, mistakes)
        unknown = [error for field in spec.fields if (error := self._unknown(field.base, field.line)) is not None]
        if not mistakes.errors and not unknown:
            mistakes.attempt(lambda: self._library.spec(full_name))
        yield from map(DefinitionFault, [*mistakes.errors, *unknown])
        yield from (DefinitionFault(error, is_warning=True) for error in self._odd(spec, part))

    def _unknown(self, kind: str, line: int) -> UsageError | None:
        """Return the error about a field of an unknown type."""
        if kind in BUILTINS or self._library.has(kind):
            return None
        package, _, bare = kind.partition("/")
        names = {each: f"{package}/{each}" for each in self._library.names(package) or ()}
        names |= {each: each for each in sorted(BUILTINS) if package == self._package}
        near = [names[each] for each in like(bare, names)]
        hint = f"did you mean {near[0]}?" if near else "add its package, or put it on ROS_PACKAGE_PATH"
        return self._error(f"unknown message type {kind}; {hint}", line)

    def _odd(self, spec: Spec, part: Definition) -> Iterator[UsageError]:
        """Yield the parts that ROS interprets differently."""
        for number, line in enumerate(part.text.split("\n"), part.first_line):
            if _TABBED.match(line.partition("#")[0].rstrip()):
                yield self._error("has a tab after the type, which ROS's genmsg refuses; write a blank", number)
        names: set[str] = set()
        for constant in spec.constants:
            if constant.name in names:
                text = f"the constant {constant.name} is defined twice; rename one of them"
                yield self._error(text, constant.line)
            if not _LEGAL.fullmatch(constant.name):
                text = f"invalid constant name {constant.name!r}; it must begin with a letter"
                yield self._error(text, constant.line)
            names.add(constant.name)

    def _error(self, text: str, line: int | None = None) -> UsageError:
        return UsageError(text, file=self._path, line=line)
