"""rosgraph.names: graph resource names and the remappings of a command line (wiki.ros.org/Names)."""

from __future__ import annotations

import os
import random
import re
import socket
import sys
from collections.abc import Mapping, Sequence
from typing import Any

from rosgraph.rosenv import ROS_NAMESPACE

MSG_EXT = ".msg"
SRV_EXT = ".srv"
SEP = "/"
GLOBALNS = "/"
PRIV_NAME = "~"
REMAP = ":="
ANYTYPE = "*"

NAME_LEGAL_CHARS_P = re.compile(r"^[\~\/A-Za-z][\w\/]*$")
BASE_NAME_LEGAL_CHARS_P = re.compile(r"^[A-Za-z][\w]*$")
REMAP_PATTERN = re.compile(r"^([\~\/A-Za-z]|_|__)[\w\/]*" + REMAP + ".*")


def isstring(s: object) -> bool:
    """Return whether something is a text."""
    return isinstance(s, str)


# -- kinds of names --------------------------------------------------------------------------------------------------


def is_global(name: str) -> bool:
    """Return whether a name begins at the root."""
    return bool(name) and name[0] == SEP


def is_private(name: str) -> bool:
    """Return whether a name is private to a node, `~name`."""
    return bool(name) and name[0] == PRIV_NAME


def is_legal_name(name: str | None) -> bool:
    """Return whether a name follows ROS's rules. The empty name does."""
    return name == "" or (name is not None and _matches(NAME_LEGAL_CHARS_P, name) and "//" not in name)


def is_legal_base_name(name: str | None) -> bool:
    """Return whether a name follows the rules of names without a namespace."""
    return name is not None and _matches(BASE_NAME_LEGAL_CHARS_P, name)


def is_legal_remap(arg: str | None) -> bool:
    """Return whether an argument of a command line is a remapping or a parameter of ROS's."""
    return arg is not None and _matches(REMAP_PATTERN, arg)


def _matches(pattern: re.Pattern[str], text: str) -> bool:
    found = pattern.match(text)
    return found is not None and found.group() == text


# -- parts and forms -------------------------------------------------------------------------------------------------


def canonicalize_name(name: str) -> str:
    """Return a name without doubled or trailing slashes."""
    if not name or name == SEP:
        return name
    start = SEP if is_global(name) else ""
    return start + SEP.join(part for part in name.split(SEP) if part)


def namespace(name: str) -> str:
    """Return the namespace of a name, ending in a slash.

    Raises:
        ValueError: None.
        TypeError: no text.
    """
    if name is None:
        raise ValueError("name")
    if not isinstance(name, str):
        raise TypeError("name")
    return name.removesuffix(SEP).rpartition(SEP)[0] + SEP if SEP in name.removesuffix(SEP) else SEP


def ns_join(ns: str, name: str) -> str:
    """Return a name in a namespace. Global and private names stay unchanged."""
    if is_private(name) or is_global(name) or not ns:
        return name
    return ns + name if ns == PRIV_NAME or ns[-1] == SEP else ns + SEP + name


def make_global_ns(name: str) -> str:
    """Return a name with a slash before and behind it.

    Raises:
        ValueError: a private name.
    """
    if is_private(name):
        raise ValueError(f"cannot turn [{name}] into a global name")
    name = name if is_global(name) else SEP + name
    return name if name[-1] == SEP else name + SEP


# -- a program's names -----------------------------------------------------------------------------------------------


def get_ros_namespace(env: Mapping[str, str] | None = None, argv: Sequence[str] | None = None) -> str:
    """Return the namespace of a program: `__ns:=` on the command line, or ROS_NAMESPACE.

    Args:
        env: os.environ by default.
        argv: sys.argv by default.
    """
    for argument in sys.argv if argv is None else argv:
        if argument.startswith("__ns:="):
            return make_global_ns(argument.removeprefix("__ns:="))
    return make_global_ns((os.environ if env is None else env).get(ROS_NAMESPACE, GLOBALNS))


def make_caller_id(name: str) -> str:
    """Return the name that a program uses towards the master, ending in a slash."""
    return make_global_ns(ns_join(get_ros_namespace(), name))


def script_resolve_name(script_name: str, name: str) -> str:
    """Return the global name of a script's name. Remappings are not applied.

    Args:
        script_name: without a namespace.
        name: name to resolve; empty for the namespace.
    """
    if not name:
        return get_ros_namespace()
    if is_global(name):
        return name
    if is_private(name):
        return ns_join(make_caller_id(script_name), name[1:])
    return get_ros_namespace() + name


def resolve_name(name: str, namespace_: str, remappings: Mapping[str, str] | None = None) -> str:
    """Return the global name of a node's name.

    Args:
        name: name to resolve; empty for the node's namespace.
        namespace_: the node's name.
        remappings: by resolved name.
    """
    if not name:
        return namespace(namespace_)
    name = canonicalize_name(name)
    if is_global(name):
        resolved = name
    elif is_private(name):
        resolved = canonicalize_name(namespace_ + SEP + name[1:])
    else:
        resolved = namespace(namespace_) + name
    return (remappings or {}).get(resolved, resolved)


def load_mappings(argv: Sequence[str]) -> dict[str, str]:
    """Return the `from:=to` arguments of a command line, without parameters (`_name:=value`)."""
    found: dict[str, str] = {}
    for argument in filter(is_legal_remap, argv):
        parts = [part.strip() for part in argument.split(REMAP)]
        if len(parts) != 2:
            sys.stderr.write(f"ERROR: Invalid remapping argument '{argument}'\n")
        elif all(parts) and (not parts[0].startswith("_") or parts[0].startswith("__") or parts[0] == "_"):
            found[parts[0]] = parts[1]
    return found


def anonymous_name(id: Any) -> str:
    """Return a legal, unique name that begins with `id`."""
    name = f"{id}_{socket.gethostname()}_{os.getpid()}_{random.randint(0, sys.maxsize)}"
    return re.sub(r"[.:-]", "_", name)
