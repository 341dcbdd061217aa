"""`Message`, the base of every generated message class, as in genpy.message.

The generated code is in `rospy_shim.types.msgs`. This module has the common part of all classes: filling in arguments,
comparison, text, copying and the check that follows a failed serialization.
"""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from typing import TYPE_CHECKING, Any, BinaryIO, ClassVar

from rospy_shim.types.genpy.checks import check_type
from rospy_shim.types.genpy.errors import SerializationError
from rospy_shim.types.genpy.strify import strify_message


class Message:
    """Base of all message classes (genpy.Message)."""

    __module__ = "genpy.message"
    __slots__ = ["_connection_header"]

    _type: ClassVar[str]
    _md5sum: ClassVar[str]
    _slot_types: ClassVar[list[str]]
    _full_text: ClassVar[str]
    _has_header: ClassVar[bool]  # of classes that are made here; classes of genpy's sources have it too
    _connection_header: dict[str, str]

    # A class made by the generator names itself here, so that it can be pickled where no "std_msgs" is importable.
    __restore_as__: ClassVar[tuple[type[Message], Callable[[str], Message]] | None] = None
    # Counts the messages in the arrays of one; None for a type without such arrays.
    __count_items__: ClassVar[Callable[[Message], int] | None] = None

    def __init__(self, *args: Any, **kwds: Any) -> None:
        """Set all fields from positional arguments, or some of them by name; the rest become None.

        Raises:
            TypeError: both kinds are given, or not exactly one positional argument per field.
            AttributeError: a name that is not a field.
        """
        slots: Any = self.__slots__
        if args:
            if kwds:
                raise TypeError("Message constructor may only use args OR keywords, not both")
            if len(args) != len(slots):
                raise TypeError(f"Invalid number of arguments, args should be {slots!s} args are{args!s}")
            for name, value in zip(slots, args, strict=True):
                setattr(self, name, value)
            return
        for name in kwds:
            if name not in slots:
                raise AttributeError(f"{name} is not an attribute of {type(self).__name__}")
        for name in slots:
            setattr(self, name, kwds.get(name))

    def _get_types(self) -> list[str]:
        """Return the ROS types of the fields, in the order of `__slots__`."""
        raise NotImplementedError(f"{type(self).__name__} has no field types; use a generated message class")

    def _check_types(self, exc: BaseException | None = None) -> None:
        """Find the field that cannot be serialized.

        Raises:
            SerializationError: a field does not fit; or all fit, and `exc` has the reason.
        """
        for name, kind in zip(self.__slots__, self._get_types(), strict=False):
            check_type(name, kind, getattr(self, name))
        if exc is not None:
            raise SerializationError(str(exc))

    def serialize(self, buff: BinaryIO) -> None:
        """Write the message to a file-like object; overridden by generated classes."""

    def deserialize(self, str_: bytes) -> Any:
        """Read the message from bytes; overridden by generated classes."""

    # Sources that genpy generated have only these two; cfepy's classes have faster ones of their own.

    def __pack__(self) -> bytes:
        buff = BytesIO()
        self.serialize(buff)
        return buff.getvalue()

    @classmethod
    def __unpack__(cls, data: bytes, at: int = 0) -> Any:
        return cls().deserialize(data[at:])

    def __getstate__(self) -> Any:
        return [getattr(self, name) for name in self.__slots__]

    def __setstate__(self, state: Any) -> None:
        for name, value in zip(self.__slots__, state, strict=True):
            setattr(self, name, value)

    def __reduce_ex__(self, protocol: Any) -> Any:
        known = self.__restore_as__
        if known is not None and known[0] is type(self):
            return known[1], (self._type,), self.__getstate__()
        return super().__reduce_ex__(protocol)

    if TYPE_CHECKING:  # the fields of a type are known when its class is made

        def __getattr__(self, name: str) -> Any: ...

        def __setattr__(self, name: str, value: Any) -> None: ...

    def __repr__(self) -> str:
        return strify_message(self)

    def __str__(self) -> str:
        return strify_message(self)

    __hash__: ClassVar[None]  # type: ignore[assignment]  # messages are mutable, as in genpy

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, type(self)):
            return False
        for name in self.__slots__:
            try:
                mine, theirs = getattr(self, name), getattr(other, name)
            except AttributeError:
                return False
            if type(mine) in (list, tuple) and type(theirs) in (list, tuple):
                # Decoding makes tuples where a constructor makes lists.
                mine, theirs = tuple(mine), tuple(theirs)
            if not mine == theirs:
                return False
        return True
