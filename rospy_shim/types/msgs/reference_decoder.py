"""The plain decoder: one slice after another, in the order and with the pieces of the code that genpy generates.

The mirror of `reference`: it reads data that the fast code of `decoder` could not read, so that the message holds as
much as with genpy, and the same exception is raised. It also handles all data that is not `bytes`. Never on the hot
path.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any

from rospy_shim.types.genpy.errors import DeserializationError
from rospy_shim.types.genpy.rostime import Duration, Time
from rospy_shim.types.msgs.bounds import MOST_EMPTY, too_many_empty, too_short, unguarded_size
from rospy_shim.types.msgs.reference import OCTETS, FlatField, Lookup, codes, flat, leaves_of, reach, runs
from rospy_shim.types.msgs.spec import PRIMITIVES, Spec

ClassOf = Callable[[str], type]
_TIMES: dict[str, type] = {"time": Time, "duration": Duration}


def read(spec: Spec, lookup: Lookup, class_of: ClassOf, message: Any, data: Any, numpy: Any = None) -> Any:
    """Fill a message in groups of fields (`deserialize`, `deserialize_numpy` of a class that genpy generated).

    Args:
        spec: its type.
        lookup: specs of nested types.
        class_of: classes of nested types.
        message: the message; after an error it holds the values read before.
        data: bytes, or an object whose slices are bytes.
        numpy: the module for number arrays of numpy's, None for tuples.

    Returns:
        The message.

    Raises:
        DeserializationError: the data end too early, or have a count that they cannot fill (`bounds`).
        TypeError, AttributeError, ValueError: they are not bytes, or another error that genpy passes on.
    """
    reader = _Reader(lookup, class_of, data, numpy)
    try:
        for field in spec.fields:
            single = not field.is_array and field.base not in PRIMITIVES and field.base != "string"
            if single and getattr(message, field.attribute) is None:
                setattr(message, field.attribute, reader.make(field.base))
        reader.level(list(flat(spec, lookup)), message)
        for field in spec.fields:
            if field.base in _TIMES and not field.is_array:
                getattr(message, field.attribute).canon()
        return message
    except struct.error as error:
        failure = DeserializationError(error)
    raise failure


class _Reader:
    """Reads one message."""

    def __init__(self, lookup: Lookup, class_of: ClassOf, data: Any, numpy: Any) -> None:
        self._lookup, self._class_of, self._data, self._numpy = lookup, class_of, data, numpy
        self._end = 0
        self._empty = MOST_EMPTY

    def make(self, base: str) -> Any:
        """Make a new object of a type."""
        return (_TIMES.get(base) or self._class_of(base))()

    def level(self, leaves: Sequence[FlatField], owner: Any) -> None:
        """Read the fields of one object."""
        for run in runs(leaves):
            leaf = run[0]
            if leaf.is_simple:
                self._simple(run, owner)
            elif leaf.is_array or leaf.base == "string":
                holder, name = reach(owner, leaf.path[:-1]), leaf.path[-1]
                if leaf.is_array and leaf.base not in PRIMITIVES:
                    self._items(leaf, holder, name)
                else:
                    setattr(holder, name, self._value(leaf))
            else:
                self.level(leaves_of(leaf.base, self._lookup), reach(owner, leaf.path))

    def _take(self, size: int) -> Any:
        start, self._end = self._end, self._end + size
        return self._data[start : self._end]

    def _count(self) -> int:
        count: int = struct.unpack("<I", self._take(4))[0]
        return count

    def _simple(self, run: Sequence[FlatField], owner: Any) -> None:
        code = codes(run)
        values = struct.unpack(code, self._take(struct.calcsize(code)))
        for leaf, value in zip(run, values, strict=True):
            setattr(reach(owner, leaf.path[:-1]), leaf.path[-1], bool(value) if leaf.base == "bool" else value)

    def _value(self, leaf: FlatField) -> Any:
        """Read a string, octets or numbers."""
        length = self._count() if leaf.length is None else leaf.length
        if not leaf.is_array:
            return self._take(length).decode("utf-8", "replace")
        if leaf.base in OCTETS:
            return self._take(length)
        code = f"<{length}{PRIMITIVES[leaf.base]}"
        octets = self._take(struct.calcsize(code))
        if self._numpy is None:
            values: Any = struct.unpack(code, octets)
        else:
            values = self._numpy.frombuffer(octets, dtype="?" if leaf.base == "bool" else f"<{code[-1]}", count=length)
        return list(map(bool, values)) if leaf.base == "bool" else values

    def _items(self, leaf: FlatField, holder: Any, name: str) -> None:
        """Read an array of strings, times or messages."""
        if leaf.length is None:
            length = self._count()
            self._bound(leaf.base, length)
        else:
            length = leaf.length
        values: list[Any] = []
        setattr(holder, name, values)
        text = FlatField((), "string")
        leaves = [] if leaf.base == "string" else leaves_of(leaf.base, self._lookup)
        for _ in range(length):
            if leaf.base == "string":
                values.append(self._value(text))
                continue
            item = self.make(leaf.base)
            self.level(leaves, item)
            values.append(item)

    def _bound(self, base: str, count: int) -> None:
        """Refuse a count of items that do not fail where the data end."""
        size = unguarded_size(self._lookup(base), self._lookup) if "/" in base else None
        if size == 0:
            self._empty -= count
            if self._empty < 0:
                raise too_many_empty()
        elif size and size * count > len(self._data) - self._end:
            raise too_short(size * count)
