"""The plain encoder: one call after another, in the order and with the pieces of the code that genpy generates.

The fast code of `encoder` must agree with it, byte for byte. If that code fails, this one runs again and does the same
as genpy: it leaves the bytes in the buffer that genpy has written by then, and raises the same exception. Never on the
hot path.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Callable, Iterator, Sequence
from typing import Any, BinaryIO, NamedTuple

from rospy_shim.types.msgs.spec import PRIMITIVES, Field, Spec

Lookup = Callable[[str], Spec]
LONGEST_RUN = 255  # fields in one call of genpy's code
OCTETS = ("uint8", "char")
_PARTS = {"time": "uint32", "duration": "int32"}


class FlatField(NamedTuple):
    """A field, and the attributes that lead to it."""

    path: tuple[str, ...]
    base: str
    is_array: bool = False
    length: int | None = None

    @property
    def is_simple(self) -> bool:
        """True if one letter of `struct` stands for it."""
        return self.base in PRIMITIVES and not self.is_array


def leaves_of(base: str, lookup: Lookup) -> list[FlatField]:
    """Return the fields of a message type, a time or a duration."""
    part = _PARTS.get(base)
    if part is not None:
        return [FlatField(("secs",), part), FlatField(("nsecs",), part)]
    return [_leaf(field, ()) for field in lookup(base).fields]


def flat(spec: Spec, lookup: Lookup, prefix: tuple[str, ...] = ()) -> Iterator[FlatField]:
    """Yield the fields of a message including those of single messages in it, which genpy writes in the same way."""
    for field in spec.fields:
        leaf = _leaf(field, prefix)
        if leaf.is_array or leaf.base in PRIMITIVES or leaf.base == "string":
            yield leaf
        elif leaf.base in _PARTS:
            yield from (FlatField(leaf.path + part.path, part.base) for part in leaves_of(leaf.base, lookup))
        else:
            yield from flat(lookup(leaf.base), lookup, leaf.path)


def _leaf(field: Field, prefix: tuple[str, ...]) -> FlatField:
    return FlatField((*prefix, field.attribute), field.base, field.is_array, field.length)


def runs(leaves: Sequence[FlatField]) -> Iterator[list[FlatField]]:
    """Yield the fields in groups: simple neighbours together, each other one alone."""
    run: list[FlatField] = []
    for leaf in leaves:
        if run and (not leaf.is_simple or len(run) == LONGEST_RUN):
            yield run
            run = []
        if leaf.is_simple:
            run.append(leaf)
        else:
            yield [leaf]
    if run:
        yield run


def codes(run: Sequence[FlatField]) -> str:
    """Return the format of simple neighbours."""
    return "<" + "".join(PRIMITIVES[leaf.base] for leaf in run)


def reach(owner: Any, path: Sequence[str]) -> Any:
    """Return the object at a path of attributes."""
    for name in path:
        owner = getattr(owner, name)
    return owner


def encode(spec: Spec, lookup: Lookup, message: Any) -> bytes:
    """Encode a message; see `write`."""
    buff = io.BytesIO()
    write(spec, lookup, message, buff)
    return buff.getvalue()


def write(spec: Spec, lookup: Lookup, message: Any, buff: BinaryIO, numpy: Any = None) -> None:
    """Encode a message in groups of fields (`serialize`, `serialize_numpy` of a class that genpy generated).

    Args:
        spec: its type.
        lookup: specs of nested types.
        message: any object with the fields as attributes, and `_check_types`.
        buff: the output; after an error it holds the preceding groups.
        numpy: the module for number arrays of numpy's, None for others.

    Raises:
        SerializationError: a field does not fit.
        AttributeError, ValueError, OverflowError: errors that genpy passes on.
    """
    writer = _Writer(lookup, message, buff, numpy is not None)
    failure: Exception
    try:
        writer.level(list(flat(spec, lookup)), message)
        return
    except struct.error as error:
        failure = struct.error(f"{type(error)}: '{error}' when writing '{writer.last}'")
    except TypeError as error:
        failure = ValueError(f"{type(error)}: '{error}' when writing '{writer.last}'")
    message._check_types(failure)


class _Writer:
    """Writes one message; `last` is the variable `_x` of genpy's code, which its error texts show."""

    def __init__(self, lookup: Lookup, message: Any, buff: BinaryIO, with_numpy: bool) -> None:
        self._lookup, self._message, self._buff, self._with_numpy = lookup, message, buff, with_numpy
        self.last = message

    def level(self, leaves: Sequence[FlatField], owner: Any) -> None:
        """Write the fields of one object."""
        for run in runs(leaves):
            leaf = run[0]
            if leaf.is_simple:
                self._simple(run, owner)
            elif leaf.is_array:
                self._array(leaf, reach(owner, leaf.path))
            elif leaf.base == "string":
                self.last = reach(owner, leaf.path)
                self._string(self.last, shown=True)
            else:
                self.level(leaves_of(leaf.base, self._lookup), reach(owner, leaf.path))

    def _simple(self, run: Sequence[FlatField], owner: Any) -> None:
        if len(run) == 1:
            values = [reach(owner, run[0].path)]
            self.last = values[0]
        else:
            self.last = owner
            values = [reach(owner, leaf.path) for leaf in run]
        self._buff.write(struct.pack(codes(run), *values))

    def _string(self, value: Any, shown: bool) -> None:
        len(value)  # a number is a TypeError before it lacks encode()
        octets = value.encode("utf-8")
        if shown:
            self.last = octets
        self._buff.write(struct.pack(f"<I{len(octets)}s", len(octets), octets))

    def _array(self, leaf: FlatField, value: Any) -> None:
        if leaf.base in OCTETS:
            self._octets(leaf.length, value)
        elif leaf.base in PRIMITIVES:
            self._numbers(PRIMITIVES[leaf.base], leaf.length, value)
        else:
            self._items(leaf, value)

    def _octets(self, length: int | None, value: Any) -> None:
        self.last = value
        count = [] if length is not None else [len(value)]
        size = count[0] if count else length
        if type(value) in (list, tuple):
            self._buff.write(struct.pack(f"<{'I' * len(count)}{size}B", *count, *value))
        else:
            self._buff.write(struct.pack(f"<{'I' * len(count)}{size}s", *count, value))

    def _numbers(self, code: str, length: int | None, value: Any) -> None:
        if length is None:
            length = len(value)
            self._buff.write(struct.pack("<I", length))
        if self._with_numpy:
            self._buff.write(raw_array(value))
        else:
            self._buff.write(struct.pack(f"<{length}{code}", *value))

    def _items(self, leaf: FlatField, values: Any) -> None:
        if leaf.length is None:
            self._buff.write(struct.pack("<I", len(values)))
        elif len(values) != leaf.length:
            name = ".".join(("self", *leaf.path))
            text = f"Expecting {leaf.length} items but found {len(values)} when writing '{name}'"
            self._message._check_types(ValueError(text))
        leaves = [] if leaf.base == "string" else leaves_of(leaf.base, self._lookup)
        for value in values:
            if leaf.base == "string":
                self._string(value, shown=False)
            else:
                self.level(leaves, value)


def raw_array(value: Any) -> bytes:
    """Return the bytes of a numpy array or number unchanged: genpy checks neither its dtype nor its length.

    Raises:
        AttributeError: it is neither.
    """
    # genpy calls `tostring`, which NumPy 2 no longer has and which did the same.
    octets: bytes = value.tobytes() if hasattr(value, "dtype") else value.tostring()
    return octets
