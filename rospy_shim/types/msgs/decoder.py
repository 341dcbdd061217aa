"""Writes the source of `__unpack__` and `deserialize`: bytes to a message in one straight line of code.

The mirror of `encoder`. `__unpack__` makes new objects without running any `__init__`; `deserialize` fills an existing
message and keeps its nested ones, as genpy does. Offsets that are known when the code is written are constants in it.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from struct import calcsize

from rospy_shim.types.msgs.bounds import MOST_EMPTY, unguarded_size
from rospy_shim.types.msgs.namespace import CodeLines, Namespace
from rospy_shim.types.msgs.spec import PRIMITIVES, Field, Spec

_TIMES = {"time": ("_Time", "I"), "duration": ("_Duration", "i")}
_OCTETS = ("uint8", "char")
_HEADS = (
    "def __unpack__(cls, data, at=0):",
    "def deserialize(self, str):",
    "def deserialize_numpy(self, str, numpy):",
)
_AGAIN = ("_read_again(cls(), data[start:])", "_read_again(self, str)", "_read_again(self, str, numpy)")


class Form(Enum):
    """The function to write."""

    UNPACK = 0
    DESERIALIZE = 1
    DESERIALIZE_NUMPY = 2


def unpack_source(
    spec: Spec,
    lookup: Callable[[str], Spec],
    class_of: Callable[[str], type],
    names: Namespace,
    form: Form,
    decoder_class: type[Decoder] | None = None,
) -> list[str]:
    """Return the source of a function that decodes messages of one type.

    Args:
        spec: the type.
        lookup: specs of nested types.
        class_of: classes of nested types.
        names: receives the names in the source. The caller must add `_read_again`, which handles data that the fast
            code cannot read as genpy does.
        form: the function to write.
        decoder_class: writes the parts; None takes `Decoder`, which unpacks messages of ROS 1.
    """
    out = CodeLines(depth=2)
    decoder = (decoder_class or Decoder)(out, lookup, class_of, names, form)
    decoder.fields(spec, "self")
    decoder.flush()
    again = _AGAIN[form.value]
    first = ["    self = _new(cls)", "    start = at"]
    if form is not Form.UNPACK:
        first = ["    if type(str) is not bytes:", f"        return {again}", "    data = str", "    at = 0"]
    if decoder.has_empty_items:
        first.append(f"    empty = {MOST_EMPTY}")
    tail = ["        return self", "    except Exception:", "        pass", f"    return {again}"]
    return [_HEADS[form.value], *first, "    try:", *out.lines, *tail]


class Decoder:
    """Collects targets of one struct and, between the structs, moves the local variable `at` through the bytes.

    Args:
        out: receives the source lines.
        lookup: specs of nested types.
        class_of: classes of nested types.
        names: receives the names in the source.
        form: the function to write.
    """

    def __init__(
        self,
        out: CodeLines,
        lookup: Callable[[str], Spec],
        class_of: Callable[[str], type],
        names: Namespace,
        form: Form,
    ) -> None:
        self.out, self.lookup, self.class_of, self.names, self.form = out, lookup, class_of, names, form
        self.code = ""
        self.targets: list[str] = []
        self.later: list[str] = []
        self.ahead = 0
        self.has_empty_items = False
        # Local variables that hold objects which existed before.
        self.kept = set() if form is Form.UNPACK else {"self"}

    def fixed(self, code: str, *targets: str) -> None:
        """Add fields of fixed size to the struct."""
        self.code += code
        self.targets += targets

    def flush(self) -> None:
        """Unpack the struct collected so far."""
        if self.code:
            self.out.add(f"{', '.join(self.targets)}, = {self.names.unpack(self.code)}(data, {self.here()})")
            self.ahead += calcsize("<" + self.code)
        for line in self.later:
            self.out.add(line)
        self.code, self.targets, self.later = "", [], []

    def here(self) -> str:
        """Return the expression for the offset of the next byte."""
        return f"at + {self.ahead}" if self.ahead else "at"

    def arrive(self) -> None:
        """Make `at` the offset of the next byte."""
        self.flush()
        if self.ahead:
            self.out.add(f"at += {self.ahead}")
            self.ahead = 0

    def count(self) -> str:
        """Read a count. Returns the local variable that holds it."""
        count = self.out.local("n")
        self.fixed("I", count)
        self.arrive()
        return count

    def fields(self, spec: Spec, owner: str) -> None:
        """Decode all fields of the message that the local variable `owner` holds."""
        for field in spec.fields:
            target = f"{owner}.{field.attribute}"
            if field.is_array:
                self.array(field, target)
            else:
                self.single(field.base, target)

    def single(self, base: str, target: str) -> None:
        """Decode one value."""
        if base == "bool":
            self.fixed("?", target)
        elif base in PRIMITIVES:
            self.fixed(PRIMITIVES[base], target)
        elif base == "string":
            self.octets(self.count(), target, '.decode("utf-8", "replace")')
        elif base in _TIMES:
            self.time(base, target)
        else:
            self.fields(self.lookup(base), self.instance(self.names.cls(base, self.class_of(base)), target))

    def time(self, base: str, target: str) -> None:
        """Decode a time or a duration."""
        kind, code = _TIMES[base]
        time = self.instance(kind, target)
        self.fixed(2 * code, f"{time}.secs", f"{time}.nsecs")
        if not target.startswith("self."):
            return  # genpy normalises the times that are fields of the message itself, and no others
        # Whole seconds are carried out of nsecs, which other programs may send unnormalised.
        beyond = f"{time}.nsecs > 999999999" if code == "I" else f"not 0 <= {time}.nsecs <= 999999999"
        self.later += [f"if {beyond}:", f"    {time}.canon()"]

    def instance(self, kind: str, target: str) -> str:
        """Return the variable of the object that is to be filled: new, or in place."""
        name = self.out.local()
        if target.partition(".")[0] in self.kept:
            self.kept.add(name)
            self.out.add(f"{name} = {target}")
            self.out.add(f"if {name} is None:")
            self.out.add(f"    {target} = {name} = {kind}()")
        else:
            self.out.add(f"{target} = {name} = _new({kind})")
        return name

    def octets(self, count: str, target: str, convert: str = "") -> None:
        """Take bytes, and convert them by the expression that follows."""
        end = self.out.local("end")
        self.out.add(f"{end} = at + {count}")
        self.out.add(f"{target} = data[at:{end}]{convert}")
        self.out.add(f"at = {end}")

    def array(self, field: Field, target: str) -> None:
        """Decode an array."""
        if field.base == "string":
            self.strings(field.length, target)
        elif field.base in _OCTETS:
            self.arrive()
            self.octets(self.count() if field.length is None else str(field.length), target)
        elif field.base in PRIMITIVES:
            self.numbers(field, target)
        else:
            self.items(field, target)

    def strings(self, length: int | None, target: str) -> None:
        """Decode an array of strings."""
        self.arrive()
        site, values, raw = self.names.strings_site(length), self.out.local(), self.out.local("raw")
        self.out.add(f"{values}, {raw} = {site}")
        self.out.add(f"if data.startswith({raw}, at):")
        self.out.add(f"    {target} = {values}.copy()")
        self.out.add(f"    at += len({raw})")
        self.out.add("else:")
        self.out.add(f"    {target}, at = _read_strings({site}, data, at, {length})")

    def numbers(self, field: Field, target: str) -> None:
        """Decode an array of numbers."""
        code = PRIMITIVES[field.base] if field.base != "bool" else "?"
        size = calcsize("<" + code)
        count = self.count() if field.length is None else str(field.length)
        self.flush()
        if self.form is Form.DESERIALIZE_NUMPY and code != "?":
            self.numpy_array(code, count, size, target)
            return
        unpack = f"{self.names.unpackers(code)}[{count}]"
        if field.length is not None:
            unpack = self.names.unpack(f"{field.length}{code}")
        values = f"{unpack}(data, {self.here()})"
        self.out.add(f"{target} = list({values})" if code == "?" else f"{target} = {values}")
        if field.length is None:
            self.out.add(f"at += {size} * {count}" if size > 1 else f"at += {count}")
        else:
            self.ahead += size * field.length

    def numpy_array(self, code: str, count: str, size: int, target: str) -> None:
        """Decode an array of numbers as numpy's."""
        self.arrive()
        end = self.out.local("end")
        self.out.add(f"{end} = at + {size} * {count}")
        self.out.add(f'{target} = numpy.frombuffer(data[at:{end}], dtype="<{code}", count={count})')
        self.out.add(f"at = {end}")

    def items(self, field: Field, target: str) -> None:
        """Decode an array of times, durations or messages."""
        count = self.count() if field.length is None else str(field.length)
        self.arrive()
        if field.base in _TIMES:
            kind, code = _TIMES[field.base]
            self.out.add(f'{target} = _read_times({kind}, "{code}", data, at, {count})')
            self.out.add(f"at += 8 * {count}")
            return
        if field.length is None:
            self.bound(count, unguarded_size(self.lookup(field.base), self.lookup))
        values, item = self.out.local("list"), self.out.local()
        self.out.add(f"{target} = {values} = []")
        self.out.add(f"for _ in range({count}):")
        self.out.depth += 1
        self.out.add(f"{item} = _new({self.names.cls(field.base, self.class_of(field.base))})")
        self.out.add(f"{values}.append({item})")
        self.fields(self.lookup(field.base), item)
        self.arrive()
        self.out.depth -= 1

    def bound(self, count: str, size: int | None) -> None:
        """Pass a count that cannot be true to the slow code, which refuses it (`bounds`)."""
        if size is None:
            return
        if size:
            self.out.add(f"if {size} * {count} > len(data) - at:")
        else:
            self.has_empty_items = True
            self.out.add(f"empty -= {count}")
            self.out.add("if empty < 0:")
        self.out.add(f"    return {_AGAIN[self.form.value]}")
