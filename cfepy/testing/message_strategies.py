"""Hypothesis strategies for ROS messages of any type, also those of a user's own packages.

A value of a type is made of plain data first, so that it shrinks field by field; then a message is made of it. Big
types get short arrays, or a planning scene would never end.
"""

from __future__ import annotations

import os
from typing import Any

from hypothesis import strategies as st

from cfepy.status import UsageError
from cfepy.testing.message_library import SECONDS, array_of, build, library_near, library_of_class

OCTETS = ("uint8", "char")  # arrays of these are bytes
SIGNED_BITS = {"int8": 8, "int16": 16, "int32": 32, "int64": 64, "byte": 8}
LONGEST_TEXT = 12
LIGHT, HEAVY = 16, 64  # weights of a type from which on arrays of it are shorter


class MessageValues:
    """Plain values of the types of a library: dictionaries, lists, numbers, texts, bytes for `uint8[]`.

    Args:
        library: a `rospy_shim.msgs.Library`.
    """

    def __init__(self, library: Any) -> None:
        self._library = library
        self._weights: dict[str, int] = {}
        self._strategies: dict[str, st.SearchStrategy[Any]] = {}

    def of(self, field_type: str) -> st.SearchStrategy[Any]:
        """Values of a type, such as "float64", "uint8[]", "time" or "geometry_msgs/Point[3]".

        Raises:
            UsageError: there is no such type.
        """
        found = self._strategies.get(field_type)
        if found is None:
            found = self._strategies[field_type] = self._make(field_type)
        return found

    def fields(self, full_name: str) -> dict[str, st.SearchStrategy[Any]]:
        """A strategy for each field of a message type; errors as `of`."""
        kind = self._library.message_class(full_name)
        return {name: self.of(slot) for name, slot in zip(kind.__slots__, kind._slot_types, strict=True)}

    def _make(self, field_type: str) -> st.SearchStrategy[Any]:
        if field_type.endswith("]"):
            base, size = array_of(field_type)
            limits: dict[str, Any] = (
                {"min_size": size, "max_size": size} if size is not None else {"max_size": self._most(base)}
            )
            return st.binary(**limits) if base in OCTETS else st.lists(self.of(base), **limits)
        if field_type in SECONDS:
            low, high = SECONDS[field_type]
            return st.fixed_dictionaries({"secs": st.integers(low, high), "nsecs": st.integers(0, 999_999_999)})
        return st.fixed_dictionaries(self.fields(field_type)) if "/" in field_type else _number_or_text(field_type)

    def _most(self, base: str) -> int:
        """Items of an array without a length."""
        weight = self._weight(base)
        return 4 if weight <= LIGHT else 2 if weight <= HEAVY else 1

    def _weight(self, field_type: str) -> int:
        """Roughly how many numbers and texts a value of a type has."""
        if field_type.endswith("]"):
            base, size = array_of(field_type)
            return 1 if base in OCTETS else (size or self._most(base)) * self._weight(base)
        if "/" not in field_type:
            return 1
        if field_type not in self._weights:
            slots = self._library.message_class(field_type)._slot_types
            self._weights[field_type] = sum(map(self._weight, slots))
        return self._weights[field_type]


def _number_or_text(field_type: str) -> st.SearchStrategy[Any]:
    if field_type == "bool":
        return st.booleans()
    if field_type == "string":
        return st.text(st.characters(exclude_categories=["Cs"]), max_size=LONGEST_TEXT)
    if field_type.startswith("float"):
        return st.floats(width=32 if field_type == "float32" else 64)
    if field_type in SIGNED_BITS:
        bits = SIGNED_BITS[field_type]
        return st.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return st.integers(0, 2 ** (8 if field_type == "char" else int(field_type[4:])) - 1)


def messages(
    kind: str | type, *, near: str | os.PathLike[str] | None = None, **fields: st.SearchStrategy[Any]
) -> st.SearchStrategy[Any]:
    """Messages of a ROS type, of all its values.

    Args:
        kind: a type such as "std_msgs/String", or a message class, ROS's own or cfepy's.
        near: a file or folder of the package that the type is from, such as `__file__`; ROS's common packages are
            always known, and those near the working directory and on ROS_PACKAGE_PATH.
        fields: strategies in place of those of single fields, such as `data=st.floats(0, 1)`.

    Raises:
        UsageError: there is no such type or field.

    >>> messages("std_msgs/Bool", data=st.just(True)).example().data  # doctest: +SKIP
    True
    """
    name = kind if isinstance(kind, str) else str(getattr(kind, "_type", kind))
    library = library_near(near) if isinstance(kind, str) else library_of_class(kind)
    known = MessageValues(library).fields(name)
    for field in fields:
        if field not in known:
            raise UsageError(f"{name} has no such field; it has {', '.join(known)}", field=field)
    built = st.fixed_dictionaries({**known, **fields}).map(lambda values: build(library, name, values))
    return built if isinstance(kind, str) else built.map(lambda message: _as_class(kind, message))


def _as_class(kind: type, message: Any) -> Any:
    """The message as one of a class that somebody else has made."""
    return message if type(message) is kind else kind().deserialize(message._pack())
