"""Message and service classes of ROS 2, as rosidl's generator writes them, made in memory from an `RosInterface`.

A message class has rosidl's public interface (`get_fields_and_field_types`, `__slots__`, properties that check and
convert, constants) and the members that a publisher needs: `_type`, `_md5sum`, `_full_text`, `__pack__` and
`__unpack__`. The latter three belong to the ROS 1 type with the same bytes, so both worlds share a topic.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple, NoReturn

from rclpy_shim.interfaces.codec import pack_lines, unpack_lines
from rclpy_shim.interfaces.field_rules import check_of, converter, default_maker, shown_type
from rclpy_shim.interfaces.interface_text import HEADER, SEQ, InterfaceField, RosInterface
from rospy_shim.types.msgs.namespace import CodeLines, Namespace
from rospy_shim.types.msgs.spec import Field, Spec

_FIRST = re.compile(r"(.)([A-Z][a-z]+)")
_SECOND = re.compile(r"([a-z0-9])([A-Z])")
_TAKEN = frozenset(["fields", "full_text", "has_header", "md5sum", "slot_types", "type", "check_fields"])
"""Names of fields whose slots would have the names of class variables."""


class TypeParts(NamedTuple):
    """The parts of a class that come from elsewhere.

    Attributes:
        module: value of `__module__`.
        name: name of the class.
        md5sum: fingerprint of the type on the bus.
        full_text: definition of the type on the bus, with all nested types.
        checks: True if fields are checked in messages that say nothing else.
    """

    module: str
    name: str
    md5sum: str
    full_text: str
    checks: bool


class RosMessage:
    """Base of all message classes."""

    __slots__ = ()
    _fields: ClassVar[tuple[InterfaceField, ...]]
    _fields_and_field_types: ClassVar[dict[str, str]]
    _check_fields: bool

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Return the types of the fields by name, such as "sequence<double>"."""
        return dict(cls._fields_and_field_types)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, self.__class__):
            return False
        return all(_same(getattr(self, each.name), getattr(other, each.name)) for each in self._fields)

    __hash__ = None  # type: ignore[assignment]  # as in rosidl's classes, whose fields can change

    def __repr__(self) -> str:
        shown = (f"{each.name}={_shown(getattr(self, each.name))}" for each in self._fields)
        cls = type(self)
        return f"{cls.__module__.rpartition('.')[0]}.{cls.__name__}({', '.join(shown)})"


class CountedHeader(RosMessage):
    """Base of std_msgs/Header, with the counter that ROS 1's header has on the bus."""

    __slots__ = (f"_{SEQ}",)


def _same(one: Any, other: Any) -> bool:
    found = one == other
    return bool(found.all()) if hasattr(found, "all") else bool(found)


def _shown(value: Any) -> str:
    if isinstance(value, array):
        return repr(value.tolist())
    return repr(value)


def module_name(name: str) -> str:
    """Return the name of the module in which rosidl puts a type, such as "_pose_stamped" for "PoseStamped"."""
    return "_" + _SECOND.sub(r"\1_\2", _FIRST.sub(r"\1_\2", name)).lower()


def slot_of(name: str) -> str:
    """Return the slot that holds a field."""
    return f"_{name}_" if name in _TAKEN else f"_{name}"


def bus_spec(interface: RosInterface) -> Spec:
    """Return the definition for the codec, whose attributes are the slots of the class."""
    fields = [Field(SEQ, f"_{SEQ}", "uint32", False, None)] if interface.full_name == HEADER else []
    for each in interface.fields:
        base = "string" if each.base == "wstring" else each.base
        fields.append(Field(each.name, slot_of(each.name), base, each.is_array, each.fixed_length))
    return Spec(interface.full_name, "", tuple(fields), (), "")


def build_message_class(
    interface: RosInterface, lookup: Callable[[str], Spec], class_of: Callable[[str], type], parts: TypeParts
) -> Any:
    """Make the class of a message type.

    Args:
        interface: the type.
        lookup: specs of nested types for the codec.
        class_of: classes of nested types.
        parts: names and fingerprints.
    """
    names = Namespace()
    base = CountedHeader if interface.full_name == HEADER else RosMessage
    slots = [*(slot_of(each.name) for each in interface.fields), "_check_fields"]
    spec = bus_spec(interface)
    checks = {each.name: check_of(each, class_of) for each in interface.fields}
    names.globals |= {
        "_checked": parts.checks,
        "_check_names": _check_names,
        "_read_again": _unreadable(interface.full_name),
        "_write_again": _unwritable(interface, checks),
    }
    body: dict[str, Any] = {
        "__doc__": f"Message class '{parts.name}'.",
        "__module__": parts.module,
        "__slots__": slots,
        "_fields": interface.fields,
        "_fields_and_field_types": {each.name: shown_type(each) for each in interface.fields},
        "_type": interface.full_name,
        "_md5sum": parts.md5sum,
        "_full_text": parts.full_text,
        "_slot_types": [each.type for each in spec.fields],
        "_has_header": False,
        "__init__": _constructor(interface, names, class_of),
        "__pack__": names.compile(pack_lines(spec, lookup, names), "__pack__", interface.full_name),
    }
    for constant in interface.constants:
        body[constant.name] = constant.value
    for field in interface.fields:
        if field.default is not None:
            body[f"{field.name.upper()}__DEFAULT"] = field.default
        body[field.name] = _property(field, checks[field.name])
    cls: Any = type(parts.name, (base,), body)
    cls.__slots__ = [*(f"_{each.name}" for each in interface.fields), "_check_fields"]  # the names that rosidl has
    cls.__slotnames__ = [*base.__slots__, *slots]  # for copy and pickle
    source = unpack_lines(spec, lookup, class_of, names)
    cls.__unpack__ = classmethod(names.compile(source, "__unpack__", interface.full_name))
    return cls


def _check_names(message: RosMessage, given: dict[str, Any]) -> None:
    wrong = sorted(name for name in given if f"_{name}" not in type(message).__slots__)
    if wrong:
        raise AssertionError(f"Invalid arguments passed to constructor: {', '.join(wrong)}")


def _constructor(interface: RosInterface, names: Namespace, class_of: Callable[[str], type]) -> Callable[..., None]:
    out = CodeLines(depth=1)
    out.add('self._check_fields = kwargs["check_fields"] if "check_fields" in kwargs else _checked')
    out.add("if self._check_fields:")
    out.add("    _check_names(self, kwargs)")
    if interface.full_name == HEADER:
        out.add(f"self._{SEQ} = 0")
    for number, field in enumerate(interface.fields):
        names.globals[f"_default{number}"] = default_maker(field, class_of)
        out.add(f'if "{field.name}" in kwargs:')
        out.add(f'    self.{field.name} = kwargs["{field.name}"]')
        out.add("else:")
        out.add(f"    self.{slot_of(field.name)} = _default{number}()")
    lines = ["def __init__(self, **kwargs):", *out.lines]
    return names.compile(lines, "__init__", interface.full_name)


def _property(field: InterfaceField, check: Callable[[Any], None]) -> property:
    slot, convert = slot_of(field.name), converter(field)

    def read(self: Any) -> Any:
        return getattr(self, slot)

    def write(self: Any, value: Any) -> None:
        if self._check_fields:
            check(value)
        setattr(self, slot, value if convert is None else convert(value))

    return property(read, write, doc=f"Message field '{field.name}'.")


def _unreadable(full_name: str) -> Callable[..., NoReturn]:
    def refuse(message: Any, data: bytes) -> NoReturn:
        raise ValueError(f"{len(data)} bytes are not a message of type {full_name}")

    return refuse


def _unwritable(interface: RosInterface, checks: dict[str, Callable[[Any], None]]) -> Callable[[Any], NoReturn]:
    def refuse(message: Any) -> NoReturn:
        for field in interface.fields:
            checks[field.name](getattr(message, field.name))
        raise TypeError(f"a field of a message in {interface.full_name} holds a value that its type cannot carry")

    return refuse


def build_service_class(full_name: str, module: str, md5sum: str, request: type, response: type) -> Any:
    """Make the class of a service type.

    Args:
        full_name: "package/Name".
        module: value of `__module__`.
        md5sum: fingerprint of the service on the bus.
        request: class of the request.
        response: class of the response.
    """

    def __init__(self: object) -> None:
        raise NotImplementedError("Service classes can not be instantiated")

    body = {
        "__doc__": f"Service class '{full_name.rpartition('/')[2]}'.",
        "__module__": module,
        "__init__": __init__,
        "Request": request,
        "Response": response,
        "_type": full_name,
        "_md5sum": md5sum,
        "_request_class": request,
        "_response_class": response,
    }
    return type(full_name.rpartition("/")[2], (), body)


def build_action_class(name: str, module: str, parts: dict[str, type], implementation: dict[str, type]) -> Any:
    """Make the class of an action.

    Args:
        name: its bare name.
        module: value of `__module__`.
        parts: classes of goal, result and feedback.
        implementation: classes of the services and messages that carry them.
    """

    def __init__(self: object) -> None:
        raise NotImplementedError("Action classes can not be instantiated")

    impl = type("Impl", (), {**implementation, "__module__": module, "__qualname__": f"{name}.Impl"})
    about = {"__doc__": f"Action class '{name}'.", "__module__": module, "__init__": __init__}
    return type(name, (), {**about, **parts, "Impl": impl})
