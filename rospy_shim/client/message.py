"""rospy's additions to messages: arguments of `publish`, `AnyMsg`, numpy arrays (rospy.msg, rospy.numpy_msg)."""

from __future__ import annotations

import codecs
import io
import struct
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, BinaryIO, ClassVar

from rospy_shim.types.exceptions import ROSException
from rospy_shim.types.genpy import DeserializationError, Message

if TYPE_CHECKING:
    from rospy_shim.types.msgs import MessageClass


class AnyMsg(Message):
    """Subscribes to any type: `_buff` holds the serialised message, `_connection_header` its type."""

    __module__ = "rospy.msg"
    _md5sum = "*"
    _type = "*"
    _has_header: ClassVar[bool] = False
    _full_text = ""
    __slots__ = ["_buff"]

    def __init__(self, *args: Any) -> None:
        """Make one without data.

        Raises:
            ROSException: any argument is given.
        """
        if args:
            raise ROSException("AnyMsg does not accept arguments")
        self._buff: bytes | None = None

    def __pack__(self) -> bytes:
        if self._buff is None:
            raise ROSException("AnyMsg is not initialized")
        return self._buff

    @classmethod
    def __unpack__(cls, data: bytes, at: int = 0) -> AnyMsg:
        message = cls()
        message._buff = data[at:]
        return message

    def serialize(self, buff: BinaryIO) -> None:
        """Write the bytes.

        Raises:
            ROSException: there are none.
        """
        octets = self.__pack__()
        buff.write(octets)

    def deserialize(self, str: bytes) -> AnyMsg:
        """Take the bytes."""
        self._buff = str
        return self


def packer(data_class: MessageClass) -> Callable[[Any], bytes]:
    """Return the function that serialises a class's messages: its own fast one, or `serialize` of genpy's code."""
    own: Callable[[Any], bytes] | None = getattr(data_class, "__pack__", None)
    return own if own is not None else serialized


def unpacker(data_class: MessageClass) -> Callable[[bytes, int], Any]:
    """Return the function that makes a message of a class from bytes at an offset; the counterpart of `packer`."""
    own: Callable[[bytes, int], Any] | None = getattr(data_class, "__unpack__", None)
    if own is not None:
        return own
    _register_text_errors()
    return lambda data, at: data_class().deserialize(data[at:])


class _TextErrors:
    """The error handler "rosmsg" for code that genpy generated: bytes that are not UTF-8 become U+FFFD."""

    msg_type = ""  # set by that code

    def __call__(self, error: UnicodeError) -> tuple[str, int]:
        if not isinstance(error, UnicodeDecodeError):
            raise error
        return "\ufffd", error.end


def _register_text_errors() -> None:
    """Register the codec error handler that genpy registers when it is imported."""
    try:
        codecs.lookup_error("rosmsg")
    except LookupError:
        codecs.register_error("rosmsg", _TextErrors())


def serialized(message: Any) -> bytes:
    """Return the bytes that `serialize` of a message writes."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def args_kwds_to_message(data_class: MessageClass, args: tuple[Any, ...], kwds: dict[str, Any]) -> Any:
    """Make the message from the arguments of `publish`.

    Args:
        data_class: type of the topic.
        args: one message, or the values of its fields.
        kwds: fields by name.

    Raises:
        TypeError: both kinds of arguments, a message of another type, or a wrong number of values.
        AttributeError: a message for AnyMsg, which is not a type to publish with.
    """
    if args and kwds:
        raise TypeError("publish() can be called with arguments or keywords, but not both.")
    if kwds:
        return data_class(**kwds)
    if len(args) != 1:
        return data_class(*args)
    value = args[0]
    if isinstance(value, data_class) or getattr(value, "_md5sum", None) == data_class._md5sum:
        return value
    if isinstance(value, AnyMsg):
        return value
    if isinstance(value, Message) and value._type != (expected := _first_type(data_class)):
        raise TypeError(f"expected [{expected}] but got [{value._type}]")
    return data_class(value)


def _first_type(data_class: MessageClass) -> str:
    """Return the type of the first field; rospy compares a message of another type than the topic's with it."""
    types = data_class._slot_types
    return types[0] if types else ""


def serialize_message(b: BinaryIO, seq: int, msg: Any) -> None:
    """Write a message as ROS does on a connection: its length, then its bytes.

    Args:
        b: the output.
        seq: sequence number for the header, if the message has one.
        msg: the message.
    """
    if getattr(type(msg), "_has_header", False):
        msg.header.seq = seq
        if msg.header.frame_id is None:
            msg.header.frame_id = "0"
    payload = packer(type(msg))(msg)
    b.write(struct.pack("<I", len(payload)) + payload)


def deserialize_messages(
    b: BinaryIO,
    msg_queue: list[Any],
    data_class: MessageClass,
    queue_size: int | None = None,
    max_msgs: int | None = None,
    start: int = 0,
) -> None:
    """Read the messages that `serialize_message` wrote; the bytes of an incomplete one stay.

    Args:
        b: buffer with bytes up to its position.
        msg_queue: receives the messages.
        data_class: their class.
        queue_size: messages that the queue keeps, the last ones; None for all.
        max_msgs: messages to read at most; None for all.
        start: offset of the first message in `b`.

    Raises:
        DeserializationError: the bytes are not messages of the class.
    """
    try:
        found = _cut(b, start, max_msgs)
        kept = found if queue_size is None else found[-queue_size:]
        msg_queue.extend(data_class().deserialize(each) for each in kept)
        if queue_size is not None:
            del msg_queue[:-queue_size]
    except Exception as error:
        raise DeserializationError(f"cannot deserialize: {error}") from error


def _cut(b: BinaryIO, start: int, most: int | None) -> list[bytes]:
    """Take complete messages out of a buffer."""
    end, at = b.tell(), start
    b.seek(start)
    data = b.read(end - start)
    found: list[bytes] = []
    while len(data) - (at - start) >= 4 and (not most or len(found) < most):
        begin = at - start + 4
        (size,) = struct.unpack_from("<I", data, begin - 4)
        if begin + size > len(data):
            break
        found.append(data[begin : begin + size])
        at += 4 + size
    b.seek(start)
    b.write(data[at - start :])
    b.truncate()
    return found


def numpy_msg(msg_type: Any) -> Any:
    """Make a class of the same message type whose number arrays are numpy arrays.

    Args:
        msg_type: a message class.
    """
    import numpy

    def unpack(cls: Any, data: bytes, at: int = 0) -> Any:
        return cls().deserialize_numpy(data[at:], numpy)

    def deserialize(self: Any, data: bytes) -> Any:
        return self.deserialize_numpy(data, numpy)

    def serialize(self: Any, buff: BinaryIO) -> None:
        self.serialize_numpy(buff, numpy)

    names = {
        "__slots__": msg_type.__slots__,
        "__pack__": lambda self: self.__pack_numpy__(numpy),
        "__unpack__": classmethod(unpack),
        "deserialize": deserialize,
        "serialize": serialize,
    }
    return type(msg_type)(f"Numpy_{msg_type._type.replace('/', '__')}", (msg_type,), names)
