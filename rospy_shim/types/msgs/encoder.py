"""Writes the source of `__pack__`: a message to bytes in one straight line of code.

Neighbouring fixed-size fields, across nested messages, go through one precompiled struct, together with one string or
array of variable length, for which there is a struct per length. At most one array of numbers enters a struct, so that
a fixed array of the wrong length is always noticed. The wire format is ROS 1's serialization: little-endian, packed, a
uint32 count before each item of variable length.
"""

from __future__ import annotations

from collections.abc import Callable

from rospy_shim.types.msgs.namespace import CodeLines, Namespace
from rospy_shim.types.msgs.spec import PRIMITIVES, Field, Spec

_TIME_CODES = {"time": "II", "duration": "ii"}
_OCTETS = ("uint8", "char")


def pack_source(
    spec: Spec,
    lookup: Callable[[str], Spec],
    names: Namespace,
    *,
    with_numpy: bool = False,
    encoder_class: type[Encoder] | None = None,
) -> list[str]:
    """Return the source of the function that encodes messages of one type.

    Args:
        spec: the type.
        lookup: specs of nested types.
        names: receives the names in the source. The caller must add `_write_again`, which handles a message that the
            fast code cannot write as genpy does.
        with_numpy: write `__pack_numpy__(self, numpy)`, where number arrays are numpy's.
        encoder_class: writes the parts; None takes `Encoder`, which packs messages of ROS 1.
    """
    out = CodeLines(depth=2)
    encoder = (encoder_class or Encoder)(out, lookup, names, with_numpy)
    encoder.fields(spec, "self")
    head = "def __pack_numpy__(self, numpy):" if with_numpy else "def __pack__(self):"
    out.add(f"return {encoder.result()}")
    again = "_write_again(self, numpy)" if with_numpy else "_write_again(self)"
    return [head, "    try:", *out.lines, "    except Exception:", "        pass", f"    return {again}"]


class Encoder:
    """Collects the parts that, joined, are the encoded message.

    Args:
        out: receives the source lines.
        lookup: specs of nested types.
        names: receives the names in the source.
        with_numpy: number arrays are numpy's.
    """

    def __init__(self, out: CodeLines, lookup: Callable[[str], Spec], names: Namespace, with_numpy: bool) -> None:
        self.out, self.lookup, self.names, self.with_numpy = out, lookup, names, with_numpy
        self.parts: list[str] = []
        self.start()

    def start(self) -> None:
        """Begin a new struct."""
        self.before, self.after = "", ""
        self.count: str | None = None
        self.args: list[str] = []
        self.has_star = False

    def flush(self) -> None:
        """Turn the struct collected so far into a part."""
        if self.args:
            if self.count is None:
                pack = self.names.pack(self.before)
            else:
                pack = f"{self.names.packers(self.before, self.after)}[{self.count}]"
            self.parts.append(f"{pack}({', '.join(self.args)})")
        self.start()

    def fixed(self, code: str, *args: str) -> None:
        """Add fields of fixed size to the struct."""
        if self.count is None:
            self.before += code
        else:
            self.after += code
        self.args += args

    def variable(self, code: str, count: str, value: str) -> None:
        """Add a counted item of `count` elements."""
        if self.count is not None or (self.has_star and value.startswith("*")):
            self.flush()
        self.fixed("I", count)
        self.count, self.after = count, code
        self.args.append(value)
        self.has_star = self.has_star or value.startswith("*")

    def part(self, part: str) -> None:
        """Add bytes, or "*pieces"."""
        self.flush()
        self.parts.append(part)

    def result(self) -> str:
        """Return the expression for the whole."""
        self.flush()
        if not self.parts:
            return 'b""'
        if len(self.parts) == 1 and not self.parts[0].startswith("*"):
            return self.parts[0]
        return f"_join(({', '.join(self.parts)},))"

    def fields(self, spec: Spec, owner: str) -> None:
        """Encode all fields of the message that the local variable `owner` holds."""
        for field in spec.fields:
            value = f"{owner}.{field.attribute}"
            if field.is_array:
                self.array(field, value)
            else:
                self.single(field.base, value)

    def single(self, base: str, value: str) -> None:
        """Encode one value."""
        if base in PRIMITIVES:
            self.fixed(PRIMITIVES[base], value)
        elif base == "string":
            text = self.local(f"{value}.encode()")
            self.variable("s", self.local(f"len({text})", "n"), text)
        elif base in _TIME_CODES:
            time = self.local(value)
            self.fixed(_TIME_CODES[base], f"{time}.secs", f"{time}.nsecs")
        else:
            self.fields(self.lookup(base), self.local(value))

    def array(self, field: Field, value: str) -> None:
        """Encode an array."""
        if field.base == "string":
            self.strings(field.length, value)
        elif field.base in _OCTETS:
            self.octets(field.length, value)
        elif field.base in PRIMITIVES:
            self.numbers(field, value)
        else:
            self.messages(field, self.local(value))

    def strings(self, length: int | None, value: str) -> None:
        """Encode an array of strings."""
        site = self.names.strings_site(length)
        values, last, raw = self.local(value), self.out.local("last"), self.out.local("raw")
        self.out.add(f"{last}, {raw} = {site}")
        self.out.add(f"if type({values}) is not list or {values} != {last}:")
        self.out.add(f"    {raw} = _write_strings({site}, {values}, {length})")
        self.part(raw)

    def octets(self, length: int | None, value: str) -> None:
        """Encode an array of octets."""
        octets = self.local(value)
        # A list must have the right length; bytes are cut or padded, as struct does it in genpy.
        convert = f"bytes({octets})" if length is None else f"{self.names.pack(f'{length}B')}(*{octets})"
        self.out.add(f"if type({octets}) is list or type({octets}) is tuple:")
        self.out.add(f"    {octets} = {convert}")
        if length is None:
            self.variable("s", self.local(f"len({octets})", "n"), octets)
        else:
            self.fixed(f"{length}s", octets)

    def numbers(self, field: Field, value: str) -> None:
        """Encode an array of numbers."""
        code = PRIMITIVES[field.base]
        if self.with_numpy:
            numbers = self.local(value)
            if field.length is None:
                self.fixed("I", f"len({numbers})")
            self.part(f"_raw_array({numbers})")
        elif field.length is None:
            numbers = self.local(value)
            self.variable(code, self.local(f"len({numbers})", "n"), f"*{numbers}")
        else:
            if self.has_star:
                self.flush()
            self.fixed(f"{field.length}{code}", f"*{value}")
            self.has_star = True

    def messages(self, field: Field, values: str) -> None:
        """Encode an array of times, durations or messages."""
        if field.length is None:
            self.fixed("I", f"len({values})")
        else:
            self.out.add(f"if len({values}) != {field.length}:")
            self.out.add('    raise TypeError("a fixed array has the wrong length")')
        pieces, item = self.local("[]", "list"), self.out.local()
        self.out.add(f"for {item} in {values}:")
        self.out.depth += 1
        before = len(self.out.lines)
        inner = type(self)(self.out, self.lookup, self.names, self.with_numpy)
        if field.base in _TIME_CODES:
            inner.fixed(_TIME_CODES[field.base], f"{item}.secs", f"{item}.nsecs")
        else:
            inner.fields(self.lookup(field.base), item)
        inner.flush()
        if inner.parts:
            self.out.add(f"{pieces} += ({', '.join(inner.parts)},)")
        elif len(self.out.lines) == before:
            self.out.add("pass")
        self.out.depth -= 1
        self.part(f"*{pieces}")

    def local(self, value: str, prefix: str = "v") -> str:
        """Assign an expression to a new local variable."""
        name = self.out.local(prefix)
        self.out.add(f"{name} = {value}")
        return name
