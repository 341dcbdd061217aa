"""`Interfaces`: the message types of one ROS 2 program, by name, and the modules that it imports them from.

Definitions come from the program's packages on disk and from the packages that cfepy includes. A type that ROS 1 has
with the same fields gets ROS 1's definition on the bus, so its md5sum is ROS 1's and nodes of both worlds join one
topic. Types with other fields have another md5sum, and the graph refuses to join them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from types import ModuleType
from typing import Any

from cfepy.status import UsageError
from rclpy_shim.interfaces import action_parts
from rclpy_shim.interfaces.interface_text import RosInterface, parse_interface
from rclpy_shim.interfaces.message_classes import (
    TypeParts,
    build_action_class,
    build_message_class,
    build_service_class,
    bus_spec,
    module_name,
)
from rospy_shim.types.msgs import Library, Shipped, Source, shipped
from rospy_shim.types.msgs.definition_sources import Definition, Definitions, Kind, split_service
from rospy_shim.types.msgs.spec import Spec, hash_text, md5_text, parse

PARTS = ("Request", "Response")
_ROS_1_PARTS = ("Goal", "Result", "Feedback", "ActionGoal", "ActionResult", "ActionFeedback", "Action")
CHECK_FIELDS = "ROS_PYTHON_CHECK_FIELDS"
_KINDS: tuple[Kind, ...] = ("msg", "srv", "action")
_DEFINITIONS = Path(__file__).parent / "definitions"


@cache
def included() -> Shipped:
    """Return the source of the ROS 2 packages that cfepy includes."""
    return Shipped(_DEFINITIONS)


class InterfaceTexts:
    """Interfaces by full name, parsed at first use; requests and responses of services are "package/NameRequest".

    Args:
        sources: sources of definitions, in order.
    """

    def __init__(self, sources: Sequence[Source]) -> None:
        self._sources = sources
        self._packages: dict[tuple[str, Kind], Definitions] = {}
        self._parsed: dict[str, RosInterface] = {}

    def names(self, package: str, kind: Kind) -> list[str]:
        """Return the names of the messages or services of a package, sorted; empty if there are none."""
        return sorted(self._package(package, kind))

    def packages(self) -> Iterable[str]:
        """Return the names of all packages."""
        return {name for source in self._sources for name in source.packages()}

    def interface(self, full_name: str) -> RosInterface:
        """Return the definition of a message, or of a part of a service.

        Raises:
            UsageError: there is no such type, or its text has an error.
        """
        found = self._parsed.get(full_name)
        if found is None:
            text = self._definition(full_name)
            found = parse_interface(text.text, full_name, text.file, text.first_line)
            self._parsed[full_name] = found
        return found

    def _package(self, name: str, kind: Kind) -> Definitions:
        key = (name, kind)
        if key not in self._packages:
            found = (source.package(name, kind) for source in self._sources)
            chosen = next((each for each in found if each), {})
            if kind == "msg":  # sources add the messages that ROS 1 derives from actions
                made = {f"{each}{part}" for each in self._package(name, "action") for part in _ROS_1_PARTS}
                chosen = {each: text for each, text in chosen.items() if each not in made}
            self._packages[key] = chosen
        return self._packages[key]

    def _definition(self, full_name: str) -> Definition:
        package, _, name = full_name.partition("/")
        found = self._package(package, "msg").get(name)
        if found is not None:
            return found
        action, part = action_parts.action_of(name)
        if part and (text := self._package(package, "action").get(action)) is not None:
            return action_parts.definition_of(text, action, part)
        services = self._package(package, "srv")
        for index, part in enumerate(PARTS):
            if name.endswith(part) and name.removesuffix(part) in services:
                return split_service(services[name.removesuffix(part)])[index]
        raise UsageError(f"unknown message type {full_name!r} of ROS 2; check that its package is near")


class BusTexts:
    """The same types in ROS 1's words, as a source for a `Library`, which computes md5sums and full texts.

    Args:
        texts: the types.
    """

    def __init__(self, texts: InterfaceTexts) -> None:
        self._texts = texts

    def packages(self) -> Iterable[str]:
        """Return the names of the packages."""
        return self._texts.packages()

    def package(self, name: str, kind: Kind) -> Definitions | None:
        """Return messages or services of a package; None if it has none."""
        names = self._texts.names(name, kind)
        if kind == "msg":
            actions = self._texts.names(name, "action")
            names = [*names, *(f"{each}_{part}" for each in actions for part in action_parts.PARTS)]
        return {each: self._definition(f"{name}/{each}", kind) for each in names} or None

    def _definition(self, full_name: str, kind: Kind) -> Definition:
        if kind == "srv":
            request, response = (self._bus_text(full_name + part) for part in PARTS)
            return Definition(f"{request}---\n{response}", full_name)
        return Definition(self._bus_text(full_name), full_name)

    def _bus_text(self, full_name: str) -> str:
        text = self._texts.interface(full_name).bus_text()
        return text if (known := _ros1_text(full_name, text)) is None else known


def _ros1_text(full_name: str, text: str) -> str | None:
    """Return ROS 1's definition of a type if it has the same fields as `text`; otherwise None."""
    package, _, name = full_name.partition("/")
    library = shipped()
    if not library.has(full_name):
        service = next((name.removesuffix(part) for part in PARTS if name.endswith(part)), "")
        if not service or not library.has(f"{package}/{service}", "srv"):
            return None
    known = library.spec(full_name)
    return known.text if _fields(known) == _fields(parse(text, full_name, full_name)) else None


def _fields(spec: Spec) -> list[tuple[str, str]]:
    return [(each.name, each.type) for each in spec.fields]


class Interfaces:
    """Message and service classes of one program; each is made once, at first use.

    Args:
        sources: sources of definitions, in order; those that cfepy includes come last.
        environ: environment of the program, for ROS_PYTHON_CHECK_FIELDS.
    """

    def __init__(self, sources: Sequence[Source] = (), environ: Mapping[str, str] | None = None) -> None:
        self._texts = InterfaceTexts([*sources, included()])
        self._bus = Library([BusTexts(self._texts)])
        self._checks = (environ or {}).get(CHECK_FIELDS) == "1"
        self._classes: dict[str, Any] = {}
        self._services: dict[str, Any] = {}
        self._actions: dict[str, Any] = {}

    def message_class(self, full_name: str) -> Any:
        """Return the class of a message such as "std_msgs/String", or of "std_srvs/SetBoolRequest".

        Raises:
            UsageError: there is no such type, or its text has an error.
        """
        found = self._classes.get(full_name)
        if found is None:
            interface = self._texts.interface(full_name)
            self._bus.spec(full_name)  # a type that contains itself, or is too large, is an error here
            found = build_message_class(interface, self._spec, self.message_class, self._parts(full_name))
            self._classes[full_name] = found
        return found

    def service_class(self, full_name: str) -> Any:
        """Return the class of a service such as "std_srvs/SetBool".

        Raises:
            UsageError: there is no such type, or its text has an error.
        """
        found = self._services.get(full_name)
        if found is None:
            package, _, name = full_name.partition("/")
            action, _, part = name.partition("_")
            joint, module = "", f"{package}.srv.{module_name(name)}"
            if part in action_parts.SERVICES and action in self._texts.names(package, "action"):
                joint, module = "_", f"{package}.action.{module_name(action)}"
            elif name not in self._texts.names(package, "srv"):
                raise UsageError(f"unknown service type {full_name!r} of ROS 2; check that its package is near")
            names = [f"{full_name}{joint}{each}" for each in PARTS]
            request, response = (self.message_class(each) for each in names)
            texts = [md5_text(self._bus.spec(each), self._bus.md5sum) for each in names]
            found = build_service_class(full_name, module, hash_text("".join(texts)), request, response)
            self._services[full_name] = found
        return found

    def action_class(self, full_name: str) -> Any:
        """Return the class of an action such as "example_interfaces/Fibonacci".

        Raises:
            UsageError: there is no such type, or its text has an error.
        """
        found = self._actions.get(full_name)
        if found is None:
            package, _, name = full_name.partition("/")
            if name not in self._texts.names(package, "action"):
                raise UsageError(f"unknown action type {full_name!r} of ROS 2; check that its package is near")
            found = self._actions[full_name] = build_action_class(
                name,
                f"{package}.action.{module_name(name)}",
                {part: self.message_class(f"{full_name}_{part}") for part in action_parts.OWN_PARTS},
                {
                    "SendGoalService": self.service_class(f"{full_name}_SendGoal"),
                    "GetResultService": self.service_class(f"{full_name}_GetResult"),
                    "FeedbackMessage": self.message_class(f"{full_name}_FeedbackMessage"),
                    "CancelGoalService": self.service_class("action_msgs/CancelGoal"),
                    "GoalStatusMessage": self.message_class("action_msgs/GoalStatusArray"),
                },
            )
        return found

    def packages(self) -> list[str]:
        """Return the names of all packages, sorted."""
        return sorted(self._texts.packages())

    def names(self, package: str, kind: Kind) -> list[str]:
        """Return the names of the messages or services of a package, sorted; empty if there are none."""
        return self._texts.names(package, kind)

    def _spec(self, full_name: str) -> Spec:
        return bus_spec(self._texts.interface(full_name))

    def _parts(self, full_name: str) -> TypeParts:
        package, _, name = full_name.partition("/")
        md5sum, full_text = self._bus.md5sum(full_name), self._bus.full_text(full_name)
        if name in self._texts.names(package, "msg"):
            return TypeParts(f"{package}.msg.{module_name(name)}", name, md5sum, full_text, self._checks)
        action, of_action = action_parts.action_of(name)
        if of_action:
            return TypeParts(f"{package}.action.{module_name(action)}", name, md5sum, full_text, self._checks)
        part = next(each for each in PARTS if name.endswith(each))
        service = name.removesuffix(part)
        module = f"{package}.srv.{module_name(service)}"
        return TypeParts(module, f"{service}_{part}", md5sum, full_text, self._checks)

    # -- modules -----------------------------------------------------------------------------------------------------

    def module(self, name: str) -> ModuleType | None:
        """Return the module of a name such as "std_msgs.msg" or "std_msgs.msg._string"; None if it has no messages.

        Its classes are made when the program first uses their names.
        """
        package, *rest = name.split(".")
        kinds = [kind for kind in _KINDS if self.names(package, kind)]
        if not kinds or len(rest) > 2:
            return None
        if not rest:
            return _module(name, {})
        kind = next((each for each in kinds if each == rest[0]), None)
        if kind is None:
            return None
        makers = self._makers(package, kind)
        if len(rest) == 2:
            makers = {each: make for each, make in makers.items() if module_name(each.partition("_")[0]) == rest[1]}
        return _module(name, makers) if makers else None

    def _makers(self, package: str, kind: Kind) -> dict[str, Callable[[], Any]]:
        found: dict[str, Callable[[], Any]] = {}
        for name in self.names(package, kind):
            full_name = f"{package}/{name}"
            if kind == "msg":
                found[name] = partial(self.message_class, full_name)
                continue
            if kind == "action":
                found[name] = partial(self.action_class, full_name)
                for part in action_parts.PARTS:
                    found[f"{name}_{part}"] = partial(self.message_class, f"{full_name}_{part}")
                continue
            found[name] = partial(self.service_class, full_name)
            for part in PARTS:
                found[f"{name}_{part}"] = partial(self.message_class, full_name + part)
        return found


def _module(name: str, makers: Mapping[str, Callable[[], Any]]) -> ModuleType:
    module = ModuleType(name)
    module.__path__ = []

    def find(attribute: str) -> Any:
        make = makers.get(attribute)
        if make is None:
            raise AttributeError(f"module {name!r} has no attribute {attribute!r}")
        made = make()
        setattr(module, attribute, made)
        return made

    vars(module)["__getattr__"] = find
    vars(module)["__all__"] = list(makers)
    return module
