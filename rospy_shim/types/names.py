"""Graph resource names: namespaces, private names and remappings of one node, and the checks of names in arguments.

A node's name is known once `init_node` has run; until then it is "/unnamed" and private names cannot be resolved. A
validator takes a value and the caller's name, and returns the checked value (rospy.names, rospy.impl.validators,
wiki.ros.org/Names).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rospy_shim.types.exceptions import ROSException

GLOBALNS = "/"
SEP = "/"
PRIV_NAME = "~"
REMAP = ":="
ANYTYPE = TOPIC_ANYTYPE = SERVICE_ANYTYPE = "*"
UNNAMED = "/unnamed"
_LEGAL = re.compile(r"^[~/A-Za-z][\w/]*$")
_REMAPPING = re.compile(r"[~/_A-Za-z][\w/]*:=")  # beginning of an argument that belongs to ROS
Resolve = Callable[[str, str], str]


def canonicalize_name(name: str) -> str:
    """Return the name without doubled or trailing slashes."""
    if not name or name == SEP:
        return name
    is_global = name[0] == SEP
    parts = [part for part in name.split(SEP) if part]
    return SEP.join(["", *parts] if is_global else parts)


def namespace_of(name: str) -> str:
    """Return the namespace of a resolved name, ending in a slash.

    Raises:
        ValueError: an empty or a relative name.
    """
    if not name:
        raise ValueError("name must not be empty; give a resolved name such as /arm/joint_states")
    head = name.rstrip(SEP).rpartition(SEP)[0]
    return head + SEP


def join(namespace: str, name: str) -> str:
    """Return a name below a namespace; global and private names stay unchanged."""
    if name.startswith((SEP, PRIV_NAME)):
        return name
    return namespace + name if namespace.endswith(SEP) else namespace + SEP + name


def is_legal_name(name: str) -> bool:
    """Return True if a name follows ROS's rules for graph resource names."""
    return name is not None and (name == "" or (bool(_LEGAL.match(name)) and "//" not in name))


def scoped_name(caller_id: str, name: str) -> str:
    """Return a global name without as many characters as the namespace of `caller_id` has.

    Raises:
        ROSException: `caller_id` is not global.
    """
    if not caller_id or not caller_id.startswith(SEP):
        raise ROSException(f"caller_id must be global, not {caller_id!r}")
    return name[len(namespace_of(caller_id)) :]


def load_mappings(argv: Sequence[str]) -> dict[str, str]:
    """Return the `from:=to` arguments of a command line; private parameters (`_name:=value`) are left out."""
    mappings: dict[str, str] = {}
    for argument in filter(_REMAPPING.match, argv):
        source, _, target = argument.partition(REMAP)
        private = source.startswith("_") and not source.startswith("__")
        if target.strip() and REMAP not in target and not private:
            mappings[source] = target.strip()
    return mappings


def command_line_params(argv: Sequence[str]) -> dict[str, str]:
    """Return the `_name:=value` arguments of a command line, values as text.

    Raises:
        ValueError: an argument with two ":=".
    """
    found = {}
    for argument in argv:
        name, *values = [part.strip() for part in argument.split(REMAP)]
        if values and name.startswith("_") and not name.startswith("__"):
            if len(values) > 1:
                raise ValueError(f"{argument} has more than one {REMAP}")
            found[name[1:]] = values[0]
    return {name: value for name, value in found.items() if name and value}


def program_arguments(argv: Sequence[str]) -> list[str]:
    """Return the program's own arguments (rospy.myargv)."""
    return [argument for argument in argv if not _REMAPPING.match(argument)]


class Names:
    """The names of one node.

    Args:
        argv: its command line, for remappings, `__name:=` and `__ns:=`.
        environ: its environment, for ROS_NAMESPACE.
    """

    def __init__(self, argv: Sequence[str], environ: Mapping[str, str]) -> None:
        self._environ = environ
        self._mappings: dict[str, str] = {}
        self._resolved: dict[str, str] = {}
        self.name = UNNAMED
        self.reload_mappings(argv)

    def reload_mappings(self, argv: Sequence[str]) -> None:
        """Read the remappings of a command line anew. A node that has its name keeps it and its resolved names."""
        self._mappings = load_mappings(argv)
        if self.name != UNNAMED:
            return
        self._resolved = {}
        given = self._mappings.get("__ns") or self._environ.get("ROS_NAMESPACE") or GLOBALNS
        self.namespace = canonicalize_name(SEP + given) if given != GLOBALNS else GLOBALNS

    @property
    def insisted_name(self) -> str | None:
        """The name in `__name:=`, or None."""
        return self._mappings.get("__name")

    def give(self, base_name: str) -> None:
        """Set the node's name: add the namespace and resolve the remappings against it."""
        if base_name.startswith(PRIV_NAME):  # rospy resolves it for the name that the node has so far
            self.set_caller_id(canonicalize_name(self._full(base_name, None)))
        else:
            self.name = canonicalize_name(join(self.namespace, base_name))
        self.initialize_mappings(self.name)

    def initialize_mappings(self, node_name: str) -> None:
        """Resolve the remappings for a node."""
        self._resolved = {}
        special = {key: value for key, value in self._mappings.items() if key.startswith("__")}
        self._resolved = special | {
            self.resolve_name(key, node_name): self.resolve_name(value, node_name)
            for key, value in self._mappings.items()
            if key not in special
        }

    def get_name(self) -> str:
        """Return the node's resolved name; "/unnamed" before `init_node`."""
        return self.name

    get_caller_id = get_name

    def set_caller_id(self, caller_id: str) -> None:
        """Set another resolved name of the node, and its namespace."""
        self.name = caller_id
        self.namespace = namespace_of(caller_id)

    def get_namespace(self) -> str:
        """Return the node's namespace, ending in a slash."""
        return self.namespace if self.namespace.endswith(SEP) else self.namespace + SEP

    def get_mappings(self) -> dict[str, str]:
        """Return the remappings as given."""
        return self._mappings

    def get_resolved_mappings(self) -> dict[str, str]:
        """Return the remappings, both sides resolved."""
        return self._resolved

    def resolve_name(self, name: str, caller_id: str | None = None) -> str:
        """Return the global name of a name for this node, remappings applied.

        Args:
            name: global, relative or private (`~name`).
            caller_id: a node name to resolve it for instead.
        """
        resolved = self._full(name, caller_id)
        return self._resolved.get(resolved, resolved) if name else resolved

    def _full(self, name: str, caller_id: str | None) -> str:
        """Return the global name, without remappings."""
        if not caller_id:
            caller_id = self.name if self.name != UNNAMED else join(self.get_namespace(), UNNAMED[1:])
        if not isinstance(caller_id, str) and not (name and str(name)[0] in SEP + PRIV_NAME):
            raise TypeError("name")
        if not name:
            return namespace_of(caller_id)
        name = canonicalize_name(str(name))
        if name.startswith(SEP):
            return name
        if name.startswith(PRIV_NAME):
            return join(canonicalize_name(caller_id), canonicalize_name(name[1:]))
        return namespace_of(caller_id) + name

    def resolve_name_without_node_name(self, name: str) -> str:
        """Resolve a name as `resolve_name` does, while the node has no name.

        Raises:
            ValueError: a private name.
        """
        if name.startswith(PRIV_NAME):
            raise ValueError("~name topics cannot be created before init_node() has been called")
        plain = {key: value for key, value in self._mappings.items() if not key.startswith(("__", PRIV_NAME))}
        resolved = self.resolve_name(name)
        for source, target in plain.items():
            if self.resolve_name(source) == resolved:
                return self.resolve_name(target)
        return resolved

    def remap_name(self, name: str, caller_id: str | None = None, resolved: bool = True) -> str:
        """Apply a remapping of the command line, as written there, to a name; any other name stays unchanged.

        Args:
            name: the name.
            caller_id: node whose namespace counts for the remapping's target; None is the node itself.
            resolved: accepted, as in rospy.
        """
        return self._full(self._mappings[name], caller_id) if name in self._mappings else name


class ParameterInvalid(Exception):  # rospy's name
    """An argument that an API does not accept.

    Args:
        message: the error.
    """

    __module__ = "rospy.impl.validators"

    def __init__(self, message: str) -> None:
        super().__init__(message)


def non_empty(param_name: str) -> Callable[[Any, str], Any]:
    """Make a validator that refuses false values."""

    def validator(value: Any, caller_id: str) -> Any:
        if not value:
            raise ParameterInvalid(f"ERROR: parameter [{param_name}] must be specified and non-empty")
        return value

    return validator


def isstring(s: Any) -> bool:
    """Return True if a value is text."""
    return isinstance(s, str)


def refusal(kind: str, name: str) -> str | None:
    """Return why the master refuses the resolved name of a topic or service; None if it accepts it.

    Args:
        kind: "topic" or "service".
        name: resolved name.
    """
    if name == SEP:
        return f"ERROR: parameter [{kind}] cannot be the global namespace"
    return f"ERROR: parameter [{kind}] contains illegal chars" if ":" in name or " " in name else None


def valid_name_validator_unresolved(param_name: str, param_value: Any, caller_id: str) -> str:
    """Check a name, and return it unchanged.

    Raises:
        ParameterInvalid: it is not text, is empty, or looks like a URI.
    """
    _check_text(param_name, param_value)
    if ":" in param_value or " " in param_value:
        raise ParameterInvalid(f"ERROR: parameter [{param_name}] contains illegal chars")
    return str(param_value)


def global_name(param_name: str) -> Callable[[Any, str], str]:
    """Make a validator that requires a global name."""

    def validator(value: Any, caller_id: str) -> str:
        _check_text(param_name, value)
        if not value.startswith(SEP):
            raise ParameterInvalid(f"ERROR: parameter [{param_name}] must be a globally referenced name")
        return str(value)

    return validator


def _check_text(param_name: str, value: Any) -> None:
    if not value or not isstring(value):
        raise ParameterInvalid(f"ERROR: parameter [{param_name}] must be a non-empty string")


class NameValidators:
    """The validators that resolve names for a node.

    Args:
        resolve: resolves a name for a caller.
    """

    def __init__(self, resolve: Resolve) -> None:
        self._resolve = resolve

    def valid_name_validator_resolved(self, param_name: str, param_value: Any, caller_id: str) -> str:
        """Check a name, and resolve it for the caller.

        Raises:
            ParameterInvalid: see `valid_name_validator_unresolved`.
        """
        return self._resolve(valid_name_validator_unresolved(param_name, param_value, caller_id), caller_id)

    def valid_name(self, param_name: str, resolve: bool = True) -> Callable[[Any, str], str]:
        """Make a validator for names; if `resolve` is true, it resolves them."""
        check = self.valid_name_validator_resolved if resolve else valid_name_validator_unresolved
        return lambda value, caller_id: check(param_name, value, caller_id)

    def is_topic(self, param_name: str) -> Callable[[Any, str], str]:
        """Make a validator for names of topics, which it resolves."""

        def validator(value: Any, caller_id: str) -> str:
            found = self.valid_name_validator_resolved(param_name, value, caller_id)
            if value == SEP:
                raise ParameterInvalid(f"ERROR: parameter [{param_name}] cannot be the global namespace")
            return found

        return validator
