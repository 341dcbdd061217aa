"""Writes the functions that pack and unpack ROS 2's message classes: the bytes of ROS 1, the Python types of rosidl.

A sequence of numbers is an `array.array`, a fixed array of them a numpy array. A single `byte` is a bytes object of
length 1. Strings, bools and messages in arrays are in lists, as in ROS 1.
"""

from __future__ import annotations

import sys
from array import array
from collections.abc import Callable
from struct import calcsize
from typing import Any

from rospy_shim.types.msgs.decoder import Decoder, Form, unpack_source
from rospy_shim.types.msgs.encoder import Encoder, pack_source
from rospy_shim.types.msgs.namespace import Namespace
from rospy_shim.types.msgs.spec import PRIMITIVES, Field, Spec

_OCTETS = ("uint8", "char")


def is_numeric(base: str) -> bool:
    """Return True if arrays of a type are `array.array` or numpy arrays."""
    return base in PRIMITIVES and base not in ("bool", "byte")


def pack_lines(spec: Spec, lookup: Callable[[str], Spec], names: Namespace) -> list[str]:
    """Return the source of `__pack__`; the caller adds `_write_again`, which raises the error.

    Args:
        spec: the type.
        lookup: specs of nested types.
        names: receives the names in the source.
    """
    names.globals |= {"_raw_sequence": raw_sequence, "_raw_array": raw_array, "_raw_octets": raw_octets}
    return pack_source(spec, lookup, names, encoder_class=TypedEncoder)


def unpack_lines(
    spec: Spec, lookup: Callable[[str], Spec], class_of: Callable[[str], type], names: Namespace
) -> list[str]:
    """Return the source of `__unpack__`; the caller adds `_read_again`, which raises the error, and `_checked`.

    Args:
        spec: the type.
        lookup: specs of nested types.
        class_of: classes of nested types.
        names: receives the names in the source.
    """
    names.globals |= {"_sequence": sequence, "_fixed_array": fixed_array, "_single_octets": single_octets}
    return unpack_source(spec, lookup, class_of, names, Form.UNPACK, TypedDecoder)


def raw_sequence(values: Any, code: str) -> bytes:
    """Return the bytes of a sequence of numbers.

    Args:
        values: the numbers.
        code: their code in `array` and `struct`.

    Raises:
        TypeError, OverflowError: a value is not a number of the type.
    """
    if type(values) is not array or values.typecode != code:
        values = array(code, values)
    if sys.byteorder == "big":
        values = array(code, values)
        values.byteswap()
    octets: bytes = values.tobytes()
    return octets


def raw_array(values: Any, code: str, length: int) -> bytes:
    """Return the bytes of an array of numbers.

    Args:
        values: the numbers.
        code: their code in `struct` and numpy.
        length: their number.

    Raises:
        ValueError: there is another number of them.
        TypeError: a value is not a number.
    """
    import numpy

    found = numpy.asarray(values, dtype=f"<{code}")
    if found.size != length:
        raise ValueError(f"an array must have {length} values, not {found.size}")
    return found.tobytes()


def raw_octets(values: Any, length: int | None) -> bytes:
    """Return the bytes of a list of single octets.

    Args:
        values: bytes objects of length 1.
        length: number of them in an array; None for a sequence.

    Raises:
        ValueError: there is another number of them, or one has another length.
    """
    octets = b"".join(values)
    if len(octets) != len(values) or length not in (None, len(values)):
        raise ValueError("an array of octets must consist of bytes objects of length 1")
    return octets


def sequence(code: str, octets: bytes, size: int) -> array[Any]:
    """Return a sequence of numbers from bytes.

    Args:
        code: code of the numbers in `array`.
        octets: the bytes.
        size: the number of bytes that there must be.

    Raises:
        ValueError: the message is shorter.
    """
    if len(octets) != size:
        raise ValueError("the message ends inside of a sequence")
    values: array[Any] = array(code, octets)
    if sys.byteorder == "big":
        values.byteswap()
    return values


def fixed_array(code: str, data: bytes, length: int, at: int) -> Any:
    """Return an array of numbers from bytes, as a numpy array of its own.

    Args:
        code: code of the numbers in numpy.
        data: the message.
        length: number of values.
        at: offset of the first one.

    Raises:
        ValueError: the message is shorter.
    """
    import numpy

    return numpy.frombuffer(data, f"<{code}", length, at).astype(code)


def single_octets(octets: bytes, size: int) -> list[bytes]:
    """Return the octets of an array one by one.

    Args:
        octets: the bytes.
        size: the number that there must be.

    Raises:
        ValueError: the message is shorter.
    """
    if len(octets) != size:
        raise ValueError("the message ends inside of an array")
    return [octets[at : at + 1] for at in range(size)]


class TypedEncoder(Encoder):
    """Packs a message whose arrays of numbers are `array.array` and numpy arrays."""

    def single(self, base: str, value: str) -> None:
        """Encode one value."""
        if base == "byte":
            self.fixed("c", value)
        else:
            super().single(base, value)

    def octets(self, length: int | None, value: str) -> None:
        """Encode an array of uint8 or char."""
        if length is None:
            raw = self.local(f"_raw_sequence({value}, 'B')")
            self.variable("s", self.local(f"len({raw})", "n"), raw)
        else:
            self.part(self.local(f"_raw_array({value}, 'B', {length})"))

    def numbers(self, field: Field, value: str) -> None:
        """Encode an array of numbers, bools or octets."""
        code = PRIMITIVES[field.base]
        if field.base == "bool":
            super().numbers(field, value)
            return
        if field.base == "byte":
            raw = self.local(f"_raw_octets({value}, {field.length})")
        elif field.length is None:
            raw = self.local(f"_raw_sequence({value}, '{code}')")
        else:
            raw = self.local(f"_raw_array({value}, '{code}', {field.length})")
        if field.length is None:
            size = calcsize("<" + code)
            self.fixed("I", f"len({raw})" if size == 1 else f"len({raw}) // {size}")
        self.part(raw)


class TypedDecoder(Decoder):
    """Unpacks a message whose arrays of numbers are `array.array` and numpy arrays."""

    def fields(self, spec: Spec, owner: str) -> None:
        """Decode all fields of the message that the local variable `owner` holds."""
        self.out.add(f"{owner}._check_fields = _checked")
        super().fields(spec, owner)

    def single(self, base: str, target: str) -> None:
        """Decode one value."""
        if base == "byte":
            self.fixed("c", target)
        else:
            super().single(base, target)

    def array(self, field: Field, target: str) -> None:
        """Decode an array."""
        if field.base in _OCTETS:
            self.numbers(field, target)
        else:
            super().array(field, target)

    def numbers(self, field: Field, target: str) -> None:
        """Decode an array of numbers, bools or octets."""
        if field.base == "bool":
            super().numbers(field, target)
            return
        code = PRIMITIVES[field.base]
        count = self.count() if field.length is None else str(field.length)
        self.arrive()
        end = self.out.local("end")
        self.out.add(f"{end} = at + {calcsize('<' + code)} * {count}")
        if field.base == "byte":
            self.out.add(f"{target} = _single_octets(data[at:{end}], {count})")
        elif field.length is None:
            self.out.add(f"{target} = _sequence('{code}', data[at:{end}], {end} - at)")
        else:
            self.out.add(f"{target} = _fixed_array('{code}', data, {count}, at)")
        self.out.add(f"at = {end}")
