"""The modules that ROS code imports: `std_msgs.msg`, `std_srvs.srv`, `geometry_msgs.msg._Pose`, `genpy.rostime`, ...

They are synthetic: `make_module` builds one by name, without touching sys.modules, so that each node can have its own.
Message classes inside are generated when their name is first looked up.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from functools import partial
from types import ModuleType
from typing import Any, cast

from rospy_shim.types import genpy
from rospy_shim.types.genpy import arguments, checks, errors, message, rostime, strify
from rospy_shim.types.msgs.definition_sources import Kind
from rospy_shim.types.msgs.library import Library, from_full_text, shipped

_IMPORTED = ("codecs", "genpy", "struct", "sys")
_TIMES: Mapping[str, Any] = {"time": rostime.Time, "duration": rostime.Duration}
_NO_PARTS: Mapping[str, Callable[[], Any]] = {}


class MessageModule(ModuleType):
    """A module whose classes are made at first use."""

    __all__: list[str]

    def __init__(
        self, name: str, makers: Mapping[str, Callable[[], Any]], parts: Mapping[str, Callable[[], Any]] = _NO_PARTS
    ) -> None:
        """Make a module.

        Args:
            name: its dotted name.
            makers: functions that make its classes.
            parts: functions that make its submodules.
        """
        super().__init__(name)
        self.__all__ = list(makers)
        self._cfepy_names = tuple(makers)
        self._cfepy_makers = {**makers, **parts}

    def hand_on(self, load: Callable[[str], ModuleType]) -> None:
        """Let a star import bring the same names as in ROS, including the modules that generated sources import.

        Args:
            load: returns the node's module of a name.
        """
        makers = self._cfepy_makers
        makers.update({name: partial(load, name) for name in _IMPORTED})
        makers["python3"] = lambda: True
        del self.__all__  # it can be computed once the classes exist, which a star import makes
        makers["__all__"] = lambda: self._star_names(load)

    def _star_names(self, load: Callable[[str], ModuleType]) -> list[str]:
        types = [each for name in self._cfepy_names for each in getattr(getattr(self, name), "_slot_types", ())]
        packages = dict.fromkeys(each.partition("/")[0] for each in types if "/" in each)
        self._cfepy_makers.update({package: partial(_with_messages, load, package) for package in packages})
        return [*self._cfepy_names, *_IMPORTED, "python3", *packages]

    def __getattr__(self, name: str) -> Any:
        make = self.__dict__["_cfepy_makers"].get(name)
        if make is None:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        made = make()
        setattr(self, name, made)
        return made

    def __dir__(self) -> list[str]:
        whole = self.__all__ if "__all__" in self._cfepy_makers else self._cfepy_names
        return sorted({*self.__dict__, *whole})


def make_module(name: str, library: Library | None = None) -> ModuleType | None:
    """Make a fresh module of a ROS package or of genpy, or return one of the shared modules that hold the codec.

    The latter (`rospy_shim.types.msgs`, `rospy_shim.types.genpy` and below) must be the same inside a node and outside,
    because a pickled message names a function there. So they are loaded by the name that the node asks for.

    Args:
        name: dotted name as in an import statement.
        library: library of message types; the shipped ones by default.

    Returns:
        The module, or None if the name is none of these.

    Raises:
        UsageError: a message definition in it has an error (when its class is first used).
    """
    library = library or shipped()
    package, *rest = name.split(".")
    if package == "rospy_shim":
        is_shared = rest == ["types"] or (rest[:1] == ["types"] and rest[1] in ("msgs", "genpy"))
        return importlib.import_module(name) if is_shared else None
    if package == "genpy":
        return _genpy_module(name, library)
    if not rest:
        known = library.names(package) is not None or library.names(package, "srv") is not None
        return _as_package(ModuleType(name)) if known else None
    if rest[0] not in ("msg", "srv") or len(rest) > 2:
        return None
    kind = cast(Kind, rest[0])
    names = library.names(package, kind)
    if names is None:
        return None
    if len(rest) == 1:
        return _as_package(_classes_module(name, library, package, names, kind))
    names = [each for each in names if rest[1] == f"_{each}"]
    return _classes_module(name, library, package, names, kind) if names else None


def _with_messages(load: Callable[[str], ModuleType], package: str) -> ModuleType:
    load(f"{package}.msg")
    return load(package)


def _as_package(module: ModuleType) -> ModuleType:
    module.__path__ = []
    return module


def _classes_module(name: str, library: Library, package: str, names: list[str], kind: Kind) -> ModuleType:
    whole = name == f"{package}.{kind}"
    # Generated sources name a class by its module: std_msgs.msg._Header.Header.
    parts = {f"_{each}": partial(make_module, f"{name}._{each}", library) for each in names} if whole else {}
    if kind == "msg":
        messages = {each: partial(library.message_class, f"{package}/{each}") for each in names}
        return MessageModule(name, messages, parts)
    makers: dict[str, Callable[[], Any]] = {}
    for each in names:
        service = partial(library.service_class, f"{package}/{each}")
        makers[each] = service
        makers[each + "Request"] = partial(_part_of, service, "_request_class")
        makers[each + "Response"] = partial(_part_of, service, "_response_class")
    return MessageModule(name, makers, parts)


def _part_of(service: Callable[[], Any], attribute: str) -> Any:
    return getattr(service(), attribute)


def _genpy_module(name: str, library: Library) -> ModuleType | None:
    contents = _genpy_contents(name, library)
    if contents is None:
        return None
    module = ModuleType(name)
    module.__dict__.update(contents)
    if name != "genpy":
        return module
    for part in ("message", "rostime"):
        setattr(module, part, _genpy_module(f"genpy.{part}", library))
    return _as_package(module)


def _genpy_contents(name: str, library: Library) -> dict[str, Any] | None:
    times = {"TVal": rostime.TVal, "Time": rostime.Time, "Duration": rostime.Duration}
    if name == "genpy.rostime":
        return times
    if name == "genpy":
        return {each: getattr(genpy, each) for each in genpy.__all__} | {"__all__": list(genpy.__all__)}
    if name == "genpy.classes":  # used by genpy.dynamic
        return {"classes_of_text": generate_dynamic}
    if name != "genpy.message":
        return None
    filler = arguments.ArgumentFiller(_finder(library, "msg"))
    return times | {
        "Message": message.Message,
        "MessageException": errors.MessageException,
        "SerializationError": errors.SerializationError,
        "DeserializationError": errors.DeserializationError,
        "check_type": checks.check_type,
        "strify_message": strify.strify_message,
        "fill_message_args": filler.fill_message_args,
        "get_printable_message_args": arguments.get_printable_message_args,
        "get_message_class": _finder(library, "msg"),
        "get_service_class": _finder(library, "srv"),
        "RosMsgUnicodeErrors": errors.RosMsgUnicodeErrors,
        "isstring": isstring,
        "struct_I": genpy.struct_I,
    }


def isstring(s: object) -> bool:
    """Return True if a value is a str."""
    return isinstance(s, str)


def _finder(library: Library, kind: Kind) -> Callable[..., Any]:
    def class_of(type_name: str) -> Any:
        """Return the class of a message or service type, or None if there is no such type.

        Raises:
            ValueError: a name without a package.
        """
        if type_name in _TIMES:
            return _TIMES[type_name]
        if type_name == "Header":
            type_name = "std_msgs/Header"
        if "/" not in type_name or type_name.count("/") != 1:
            problem = "invalid name [{}]" if "/" in type_name else "message type is missing package name: {}"
            raise ValueError(problem.format(type_name))
        if not library.has(type_name, kind):
            return None
        return library.message_class(type_name) if kind == "msg" else library.service_class(type_name)

    def get_message_class(message_type: str, reload_on_error: bool = False) -> Any:
        return class_of(message_type)

    def get_service_class(service_type: str, reload_on_error: bool = False) -> Any:
        return class_of(service_type)

    found = get_message_class if kind == "msg" else get_service_class
    found.__qualname__, found.__module__ = found.__name__, "genpy.message"
    return found


def generate_dynamic(core_type: str, msg_cat: str) -> dict[str, Any]:
    """Make the classes of a type and of all types in it, from a full text (genpy.dynamic).

    Args:
        core_type: name of the first type in the text.
        msg_cat: the full text, as in `_full_text`, a connection header or a bag.

    Returns:
        The classes by full name.

    Raises:
        UsageError: the text has an error or lacks a type.
    """
    library = from_full_text(core_type, msg_cat)
    names = [f"{package}/{name}" for package in library.packages() for name in library.names(package) or ()]
    return {name: library.message_class(name) for name in names}
