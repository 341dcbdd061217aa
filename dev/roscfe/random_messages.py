"""Random messages of any type, as genpy's objects, within the capacities of the strict profile."""

from __future__ import annotations

import random
import struct
from typing import Any

from cfepy.extra.convert.capacities import Capacities
from rospy_shim.types.genpy import Duration, Time
from rospy_shim.types.msgs import Library, shipped
from rospy_shim.types.msgs.spec import BUILTINS, PRIMITIVES, Field

LIBRARY = shipped()
LETTERS = 'abcXYZ 0189_/-\u00e4\u20ac\0\n"\\'
FEW = 2  # items of an array of messages


def all_types() -> list[str]:
    """Return all messages that come with cfepy, requests and responses of services among them."""
    found = []
    for package in LIBRARY.packages():
        found += [f"{package}/{name}" for name in LIBRARY.names(package) or ()]
        found += [
            f"{package}/{name}{part}"
            for name in LIBRARY.names(package, "srv") or ()
            for part in ("Request", "Response")
        ]
    return list(dict.fromkeys(found))


def capacities() -> Capacities:
    """Return a capacity for each array of messages."""
    fields = {
        f"{name}.{each.name}": FEW
        for name in all_types()
        for each in LIBRARY.spec(name).fields
        if each.is_array and each.length is None and each.base not in BUILTINS
    }
    return Capacities(fields, text=24, array=6)


class Source:
    """Draws messages.

    Args:
        seed: of the random numbers.
        longest: capacities that no text and no array exceeds.
        library: where the types are.
    """

    def __init__(self, seed: int | str, longest: Capacities, library: Library = LIBRARY) -> None:
        self._random = random.Random(seed)
        self._longest = longest
        self._library = library

    def message(self, full_name: str) -> Any:
        """Return a message with random values in all of its fields."""
        made = self._library.message_class(full_name)()
        for each in self._library.spec(full_name).fields:
            setattr(made, each.attribute, self._value(full_name, each))
        return made

    def _value(self, owner: str, each: Field) -> Any:
        place = f"{owner}.{each.name}"
        if not each.is_array:
            return self._one(each.base, place)
        count = each.length
        if count is None:
            count = self._random.randint(0, self._longest.of_array(place, each.base))
        if each.base in ("uint8", "char"):
            return self._random.randbytes(count)
        return [self._one(each.base, place + "[]") for _ in range(count)]

    def _one(self, kind: str, place: str) -> Any:
        draw = self._random
        if kind == "string":
            text = "".join(draw.choices(LETTERS, k=draw.randint(0, self._longest.of_text(place))))
            return text.encode()[: self._longest.of_text(place)].decode(errors="ignore")
        if kind == "time":
            return Time(draw.getrandbits(32), draw.randrange(10**9))
        if kind == "duration":
            return Duration(draw.getrandbits(32) - (1 << 31), draw.randrange(10**9))
        if kind == "bool":
            return draw.random() < 0.5
        if kind in ("float32", "float64"):
            return self._float(kind)
        if kind in PRIMITIVES:
            code = "<" + PRIMITIVES[kind]
            return struct.unpack(code, draw.randbytes(struct.calcsize(code)))[0]
        return self.message(kind)

    def _float(self, kind: str) -> float:
        if self._random.random() < 0.1:
            return self._random.choice([0.0, -0.0, float("inf"), float("-inf"), float("nan"), 5e-324])
        value = self._random.uniform(-1e6, 1e6)
        return value if kind == "float64" else float(struct.unpack("<f", struct.pack("<f", value))[0])
