"""A `Library` turns definitions into specs, fingerprints and classes, each made once, at first use.

It searches its sources in order. The library of the shipped packages is `shipped()`. A node's library extends it by the
packages that the node brings along.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import NamedTuple

from cfepy.reading.input_limits import MESSAGE_DEPTH, MESSAGE_FIELDS, MESSAGE_VALUES
from cfepy.status import UsageError
from rospy_shim.types.genpy.message import Message
from rospy_shim.types.msgs.classes import MessageClass, ServiceClass, build_class, build_service
from rospy_shim.types.msgs.definition_sources import (
    Definition,
    Definitions,
    Kind,
    Shipped,
    Source,
    Texts,
    split_service,
)
from rospy_shim.types.msgs.spec import BUILTINS, PRIMITIVES, Spec, full_text, md5_text, md5sum, parse, split_full_text

_PARTS = ("Request", "Response")
_KINDS: tuple[Kind, ...] = ("msg", "srv")
_OBJECT = 20  # weight of a message or a text in an array, in values


class _Size(NamedTuple):
    """The size of a type: nesting depth, fields without those in arrays, values in arrays of fixed length."""

    depth: int
    fields: int
    values: int


class Library:
    """Message types by full name, e.g. "std_msgs/String"; everything is made once, at first use."""

    def __init__(
        self,
        sources: Sequence[Source],
        restore: Callable[[str], Message] | None = None,
        *,
        module: str | None = None,
        base: Library | None = None,
    ) -> None:
        """Make a library.

        Args:
            sources: sources of definitions, in order.
            restore: see `classes.build_class`.
            module: value of the classes' `__module__`; None for ROS's "package.msg._Name".
            base: library of all packages that the sources lack. Its definitions are used unchanged, except for types in
                which one from the sources is nested; classes are made anew, because a program may change them.
        """
        self._sources, self._restore, self._module = tuple(sources), restore, module
        self._base = base
        self._packages: dict[tuple[str, Kind], Definitions | None] = {}
        self._specs: dict[str, Spec] = {}
        self._md5sums: dict[str, str] = {}
        self._full_texts: dict[str, str] = {}
        self._classes: dict[str, MessageClass] = {}
        self._services: dict[str, ServiceClass] = {}
        self._opening: list[str] = []
        self._own: dict[str, bool] = {}
        self._sizes: dict[str, _Size] = {}

    def packages(self) -> list[str]:
        """Return the names of all packages, sorted."""
        below = self._base.packages() if self._base is not None else []
        return sorted({*below, *(name for source in self._sources for name in source.packages())})

    def names(self, package: str, kind: Kind = "msg") -> list[str] | None:
        """Return the names of the messages or services of a package, sorted; None if there are none."""
        found = self._package(package, kind)
        return None if found is None else sorted(found)

    def has(self, full_name: str, kind: Kind = "msg") -> bool:
        """Return True if a message or service type is known."""
        package, _, name = full_name.partition("/")
        return name in (self._package(package, kind) or {})

    def text(self, full_name: str, kind: Kind = "msg") -> str:
        """Return the definition of a message or service as it was written.

        Raises:
            UsageError: there is no such type.
        """
        package, _, name = full_name.partition("/")
        found = (self._package(package, kind) or {}).get(name)
        if found is None:
            raise UsageError(f"unknown {kind} type {full_name!r}; check that its package is on ROS_PACKAGE_PATH")
        return found.text

    def spec(self, full_name: str) -> Spec:
        """Return the parsed definition of a type.

        Raises:
            UsageError: there is no such type, or its text has an error, or it contains itself.
        """
        if self._base is not None and not self._is_own(full_name):
            return self._base.spec(full_name)
        found = self._specs.get(full_name)
        if found is None:
            definition = self._definition(full_name)
            found = parse(definition.text, full_name, definition.file, definition.first_line)
            self._open_nested(found)
            self._specs[full_name] = found
        return found

    def md5sum(self, full_name: str) -> str:
        """Return the md5sum of a type."""
        if self._base is not None and not self._is_own(full_name):
            return self._base.md5sum(full_name)
        found = self._md5sums.get(full_name)
        if found is None:
            found = self._md5sums[full_name] = md5sum(self.spec(full_name), self.md5sum)
        return found

    def full_text(self, full_name: str) -> str:
        """Return the definition of a type and of all types in it."""
        if self._base is not None and not self._is_own(full_name):
            return self._base.full_text(full_name)
        found = self._full_texts.get(full_name)
        if found is None:
            found = self._full_texts[full_name] = full_text(self.spec(full_name), self.spec)
        return found

    def message_class(self, full_name: str) -> MessageClass:
        """Return the class of a type.

        Raises:
            UsageError: as for `spec`.
        """
        found = self._classes.get(full_name)
        if found is None:
            spec = self.spec(full_name)
            found = self._classes[full_name] = build_class(spec, self, self._restore, self._module_of(full_name))
        return found

    def service_class(self, full_name: str) -> ServiceClass:
        """Return the class of a service, with its request and response classes.

        Raises:
            UsageError: there is no such service, or its text has an error.
        """
        found = self._services.get(full_name)
        if found is None:
            if not self.has(full_name, "srv"):
                raise UsageError(f"unknown service type {full_name!r}; check that its package is on ROS_PACKAGE_PATH")
            parts = [self.message_class(full_name + part) for part in _PARTS]
            texts = [md5_text(self.spec(full_name + part), self.md5sum) for part in _PARTS]
            found = self._services[full_name] = build_service(full_name, parts[0].__module__, texts, *parts)
        return found

    def _module_of(self, full_name: str) -> str:
        if self._module is not None:
            return self._module
        package, _, name = full_name.partition("/")
        if self.has(full_name):
            return f"{package}.msg._{name}"
        return f"{package}.srv._{name.removesuffix('Request').removesuffix('Response')}"

    def _is_own(self, full_name: str) -> bool:
        """Return True if a type is made here: it, or a type nested in it, is from a package that the base lacks or
        has otherwise.
        """
        if self._base is None:
            return True
        known = self._own.get(full_name)
        if known is None:
            package = full_name.partition("/")[0]
            known = any(self._from_sources(package, kind) is not None for kind in _KINDS)
            known = known or any(self._is_own(nested) for nested in self._base.spec(full_name).message_types)
            self._own[full_name] = known
        return known

    def _package(self, name: str, kind: Kind) -> Definitions | None:
        found = self._from_sources(name, kind)
        return self._base._package(name, kind) if found is None and self._base is not None else found

    def _from_sources(self, name: str, kind: Kind) -> Definitions | None:
        key = (name, kind)
        if key not in self._packages:
            found = (source.package(name, kind) for source in self._sources)
            self._packages[key] = next((package for package in found if package is not None), None)
        return self._packages[key]

    def _definition(self, full_name: str) -> Definition:
        package, _, name = full_name.partition("/")
        found = (self._package(package, "msg") or {}).get(name)
        if found is not None:
            return found
        services = self._package(package, "srv") or {}
        for index, part in enumerate(_PARTS):
            if name.endswith(part) and name.removesuffix(part) in services:
                return split_service(services[name.removesuffix(part)])[index]
        raise UsageError(f"unknown message type {full_name!r}; check that its package is on ROS_PACKAGE_PATH")

    def _open_nested(self, found: Spec) -> None:
        """Parse the nested types as well, so that a type with a missing part cannot be used at all."""
        self._opening.append(found.full_name)
        try:
            if len(self._opening) > MESSAGE_DEPTH:
                problem = f"message type {found.full_name} is nested more than {MESSAGE_DEPTH} types deep"
                raise UsageError(problem, file=found.file)
            for field in found.fields:
                name = field.base
                if name in BUILTINS:
                    continue
                if name in self._opening:
                    raise UsageError(f"message type {name} contains itself", file=found.file, line=field.line)
                if not self.has(name):
                    problem = f"unknown message type {name}; add its package"
                    raise UsageError(problem, file=found.file, line=field.line)
                self.spec(name)
            self._hold_to_limits(found)
        finally:
            self._opening.pop()

    def _hold_to_limits(self, found: Spec) -> None:
        size = self._sizes[found.full_name] = self._sum(found)
        for what, number, limit in (
            ("types inside each other", size.depth, MESSAGE_DEPTH),
            ("fields, including fields of nested types", size.fields, MESSAGE_FIELDS),
            ("values in fixed arrays, including nested arrays", size.values, MESSAGE_VALUES),
        ):
            if number > limit:
                problem = f"message type {found.full_name} has more than {limit:,} {what}; split it"
                raise UsageError(problem, file=found.file, line=found.fields[0].line)

    def _sum(self, spec: Spec) -> _Size:
        """Return the size of a type; its nested types have been checked against the limits already."""
        depth, fields, values = 0, 0, 0
        for field in spec.fields:
            inner = _Size(0, 1, 1) if field.base in BUILTINS else self._size(field.base)
            depth = max(depth, inner.depth)
            fields += 1 if field.is_array else inner.fields
            each = inner.values if field.base in PRIMITIVES else inner.values + _OBJECT
            values += each * (field.length or 0) if field.is_array else inner.values
        return _Size(depth + 1, max(fields, len(spec.fields)), values)

    def _size(self, full_name: str) -> _Size:
        if full_name not in self._sizes:
            self._sizes[full_name] = self._sum(self.spec(full_name))
        return self._sizes[full_name]


def from_full_text(full_name: str, text: str) -> Library:
    """Make a library of the types in a full text (`_full_text`, a connection header's message_definition).

    Args:
        full_name: name of the first type; the others have their names in the text.
        text: the full text.
    """
    definitions = {}
    for name, body, line in split_full_text(text):
        definitions[name or full_name] = Definition(body, f"<definition of {full_name}>", line)
    return Library([Texts(definitions)], module=full_name)


def restore_message(full_name: str) -> Message:
    """Make an empty message of a shipped type, to be filled by pickle or copy."""
    cls = shipped().message_class(full_name)
    return cls.__new__(cls)


@cache
def shipped() -> Library:
    """Return the library of the packages that come with cfepy; one per process, because its classes hold no state."""
    return Library([Shipped()], restore_message)


@cache
def library_of(full_name: str, definition: str) -> Library:
    """Return the library that has a type as its users have it.

    Args:
        full_name: the type, e.g. "rover_msgs/Drive".
        definition: its full text; empty for a shipped type.
    """
    known = not definition or (shipped().has(full_name) and shipped().full_text(full_name) == definition)
    return shipped() if known else from_full_text(full_name, definition)
