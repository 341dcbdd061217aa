"""Message and service classes: the classes that genpy writes into a package's Python files, made in memory from a
`Spec`.

A message class has genpy's public interface (`_type`, `_md5sum`, `__slots__`, `serialize`, ...) and two functions of
cfepy's own that the publisher and the subscriber use: `__pack__(msg) -> bytes` and `__unpack__(data, at=0) -> msg`.
Functions that are seldom called are compiled at their first call. A service class holds a request and a response class.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from io import BytesIO
from typing import Any, Protocol, cast

from rospy_shim.types.genpy.message import Message
from rospy_shim.types.msgs import reference, reference_decoder
from rospy_shim.types.msgs.decoder import Form, unpack_source
from rospy_shim.types.msgs.encoder import pack_source
from rospy_shim.types.msgs.namespace import CodeLines, Namespace
from rospy_shim.types.msgs.spec import PRIMITIVES, Field, Spec, hash_text

MessageClass = type[Message]
"""A generated class; the fields of its messages are known at run time only."""


class ServiceClass(Protocol):
    """A generated class of a service."""

    _type: str
    _md5sum: str
    _request_class: MessageClass
    _response_class: MessageClass


def build_service(
    full_name: str, module: str, md5_texts: Sequence[str], request: MessageClass, response: MessageClass
) -> ServiceClass:
    """Make the class of a service type.

    Args:
        full_name: "package/Name".
        module: value of `__module__`, e.g. "std_srvs.srv._SetBool".
        md5_texts: texts of request and response; hashed together they are the service's md5sum.
        request: class of the request.
        response: class of the response.
    """
    body = {
        "__module__": module,
        "_type": full_name,
        "_md5sum": hash_text("".join(md5_texts)),
        "_request_class": request,
        "_response_class": response,
    }
    return cast(ServiceClass, type(full_name.rpartition("/")[2], (), body))


class TypeTable(Protocol):
    """The source of the parts of a class."""

    def spec(self, full_name: str) -> Spec:
        """Return the definition of a type."""

    def md5sum(self, full_name: str) -> str:
        """Return its md5sum."""

    def full_text(self, full_name: str) -> str:
        """Return its definition with the definitions of all types in it."""

    def message_class(self, full_name: str) -> MessageClass:
        """Return its class."""


def build_class(spec: Spec, table: TypeTable, restore: Callable[[str], Message] | None, module: str) -> MessageClass:
    """Make the class of a message type.

    Args:
        spec: the type.
        table: nested types and fingerprints.
        restore: makes an empty message from the type's name, for pickle; None leaves pickle to find the class itself.
        module: value of `__module__`, e.g. "std_msgs.msg._String".
    """
    names = Namespace()
    write = partial(reference.write, spec, table.spec)
    names.globals["_write_again"] = partial(_written, write)
    names.globals["_read_again"] = partial(reference_decoder.read, spec, table.spec, table.message_class)
    types = [field.type for field in spec.fields]
    name = spec.full_name.rpartition("/")[2]
    body: dict[str, Any] = {
        "_has_header": spec.has_header,  # before the constants, as in genpy's code: actionlib takes the first attribute
        **{constant.attribute: constant.value for constant in spec.constants},
        "__module__": module,
        "__slots__": [field.attribute for field in spec.fields],
        "_slot_types": types,
        "_type": spec.full_name,
        "_md5sum": table.md5sum(spec.full_name),
        "_full_text": table.full_text(spec.full_name),
        "_get_types": lambda self: types,
        "__init__": _constructor(spec, table, names),
        **_writers(write),
        "__pack__": _function(spec, names, pack_source(spec, table.spec, names), "__pack__"),
        "__count_items__": _counter(spec, table, names),
    }
    cls: MessageClass = type(name, (Message,), body)
    _add_readers(cls, spec, table, names)
    cls.__restore_as__ = None if restore is None else (cls, restore)
    return cls


def _written(write: Callable[..., None], message: Message, numpy: Any = None) -> bytes:
    buff = BytesIO()
    write(message, buff, numpy)
    return buff.getvalue()


def _writers(write: Callable[..., None]) -> dict[str, Callable[..., None]]:
    """Return `serialize` and `serialize_numpy`: the fast code, and if that fails `write`, which leaves as much as it
    can.
    """

    def serialize(self: Message, buff: Any) -> None:
        """Write the message to a file-like object.

        Raises:
            SerializationError: a field holds a value that its type cannot carry; the preceding fields are written, as
                in genpy.
        """
        try:
            octets = self.__pack__()
        except Exception:
            octets = None
        write(self, buff) if octets is None else buff.write(octets)

    def serialize_numpy(self: Message, buff: Any, numpy: Any) -> None:
        """Write a message whose number arrays are numpy arrays; `numpy` is the module.

        Raises:
            SerializationError: a field holds a value that its type cannot carry; the preceding fields are written, as
                in genpy.
        """
        try:
            octets = self.__pack_numpy__(numpy)
        except Exception:
            octets = None
        write(self, buff, numpy) if octets is None else buff.write(octets)

    return {"serialize": serialize, "serialize_numpy": serialize_numpy}


def _function(spec: Spec, names: Namespace, lines: list[str], name: str) -> Callable[..., Any]:
    function = names.compile(lines, name, spec.full_name)
    function.__qualname__ = f"{spec.full_name.rpartition('/')[2]}.{name}"
    return function


def _add_readers(cls: MessageClass, spec: Spec, table: TypeTable, names: Namespace) -> None:
    def reader(form: Form) -> list[str]:
        return unpack_source(spec, table.spec, table.message_class, names, form)

    unpack = classmethod(_function(spec, names, reader(Form.UNPACK), "__unpack__"))
    cls.__unpack__ = unpack  # type: ignore[method-assign, assignment]  # in place of the slow one of the base
    _compile_later(cls, spec, names, "deserialize", partial(reader, Form.DESERIALIZE))
    _compile_later(cls, spec, names, "deserialize_numpy", partial(reader, Form.DESERIALIZE_NUMPY))
    with_numpy = partial(pack_source, spec, table.spec, names, with_numpy=True)
    _compile_later(cls, spec, names, "__pack_numpy__", with_numpy)


def _counter(spec: Spec, table: TypeTable, names: Namespace) -> Callable[[Message], int] | None:
    """Make the function that counts the messages in the arrays of a message and of single messages in it."""
    lengths = " + ".join(f"len(self.{path})" for path in _arrays(spec, table))
    if not lengths:
        return None
    return _function(spec, names, ["def __count_items__(self):", f"    return {lengths}"], "__count_items__")


def _arrays(spec: Spec, table: TypeTable, owner: str = "") -> Iterator[str]:
    for field in spec.fields:
        if "/" not in field.base:
            continue
        if field.is_array:
            yield owner + field.attribute
        else:
            yield from _arrays(table.spec(field.base), table, f"{owner}{field.attribute}.")


def _compile_later(cls: MessageClass, spec: Spec, names: Namespace, name: str, source: Callable[[], list[str]]) -> None:
    def compiled() -> Callable[..., Any]:
        function = _function(spec, names, source(), name)
        setattr(cls, name, function)
        return function

    def first_call(self: Message, *args: Any) -> Any:
        return compiled()(self, *args)

    def deserialize(self: Message, str: bytes) -> Any:
        return compiled()(self, str)

    def deserialize_numpy(self: Message, str: bytes, numpy: Any) -> Any:
        return compiled()(self, str, numpy)

    setattr(cls, name, {"deserialize": deserialize, "deserialize_numpy": deserialize_numpy}.get(name, first_call))


def _constructor(spec: Spec, table: TypeTable, names: Namespace) -> Callable[..., Any]:
    names.globals["_Message_init"] = Message.__init__
    out = CodeLines(depth=1)
    out.add("if args or kwds:")
    # One positional argument per field is by far the most common call.
    if spec.fields:
        targets = "".join(f"self.{field.attribute}, " for field in spec.fields)
        out.add(f"    if len(args) == {len(spec.fields)} and not kwds:")
        out.add(f"        {targets}= args")
        out.add("    else:")
        out.add("        _Message_init(self, *args, **kwds)")
    else:
        out.add("    _Message_init(self, *args, **kwds)")
    for field in spec.fields:
        out.add(f"    if self.{field.attribute} is None:")
        out.add(f"        self.{field.attribute} = {_default(field, table, names)}")
    out.add("else:")
    for field in spec.fields:
        out.add(f"    self.{field.attribute} = {_default(field, table, names)}")
    if not spec.fields:
        out.add("    pass")
    return _function(spec, names, ["def __init__(self, *args, **kwds):", *out.lines], "__init__")


def _default(field: Field, table: TypeTable, names: Namespace) -> str:
    """Return the expression for a field's default value."""
    if field.is_array and field.base in ("uint8", "char"):
        return repr(bytes(field.length or 0))
    if field.is_array and field.length is None:
        return "[]"
    single = _default_single(field.base, table, names)
    if not field.is_array:
        return single
    if single.endswith("()"):
        return f"[{single} for _ in range({field.length})]"
    return f"[{single}] * {field.length}"


def _default_single(base: str, table: TypeTable, names: Namespace) -> str:
    if base in PRIMITIVES:
        return {"float32": "0.0", "float64": "0.0", "bool": "False"}.get(base, "0")
    if base == "string":
        return "''"
    if base in ("time", "duration"):
        return f"_{base.capitalize()}()"
    return names.cls(base, table.message_class(base)) + "()"
