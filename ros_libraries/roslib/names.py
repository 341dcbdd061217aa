"""roslib.names: names of packages' resources (`std_msgs/String`). Graph names are in rosgraph.names."""

from __future__ import annotations

import re

from rosgraph.names import (
    ANYTYPE,
    GLOBALNS,
    PRIV_NAME,
    REMAP,
    SEP,
    anonymous_name,
    canonicalize_name,
    get_ros_namespace,
    is_global,
    is_legal_base_name,
    is_legal_name,
    is_private,
    isstring,
    load_mappings,
    make_caller_id,
    make_global_ns,
    namespace,
    ns_join,
    resolve_name,
)

__all__ = [
    "ANYTYPE",
    "GLOBALNS",
    "PRIV_NAME",
    "PRN_SEPARATOR",
    "REMAP",
    "SEP",
    "TYPE_SEPARATOR",
    "anonymous_name",
    "canonicalize_name",
    "get_ros_namespace",
    "is_global",
    "is_legal_base_name",
    "is_legal_name",
    "is_legal_resource_base_name",
    "is_legal_resource_name",
    "is_private",
    "isstring",
    "load_mappings",
    "make_caller_id",
    "make_global_ns",
    "namespace",
    "ns_join",
    "package_resource_name",
    "resolve_name",
    "resource_name",
    "resource_name_base",
    "resource_name_package",
]

TYPE_SEPARATOR = "/"
PRN_SEPARATOR = "/"

RESOURCE_NAME_LEGAL_CHARS_P = re.compile(r"^[A-Za-z][\w_\/]*$")
BASE_RESOURCE_NAME_LEGAL_CHARS_P = re.compile(r"^[A-Za-z][\w_]*$")


def resource_name(res_pkg_name: str, name: str, my_pkg: str | None = None) -> str:
    """Return the full name of a package's resource, or only its own name if seen from that package.

    Args:
        res_pkg_name: the package.
        name: the resource.
        my_pkg: the package from which it is seen.
    """
    return name if not res_pkg_name or res_pkg_name == my_pkg else f"{res_pkg_name}{PRN_SEPARATOR}{name}"


def resource_name_base(name: str) -> str:
    """Return a resource's name without its package."""
    return name.rpartition(PRN_SEPARATOR)[2]


def resource_name_package(name: str) -> str | None:
    """Return the package of a resource's name, or None."""
    package, separator, _ = name.partition(PRN_SEPARATOR)
    return package if separator else None


def package_resource_name(name: str) -> tuple[str, str]:
    """Return the package and own name of a resource; the package may be empty.

    Raises:
        ValueError: a name with more than two parts.
    """
    parts = name.split(PRN_SEPARATOR)
    if len(parts) > 2:
        raise ValueError(f"invalid name [{name}]")
    return (parts[0], parts[1]) if len(parts) == 2 else ("", name)


def is_legal_resource_name(name: str | None) -> bool:
    """Return whether a name follows the rules for resources, with or without a package."""
    return name is not None and bool(RESOURCE_NAME_LEGAL_CHARS_P.fullmatch(name)) and "//" not in name


def is_legal_resource_base_name(name: str | None) -> bool:
    """Return whether a name follows the rules for resources without a package."""
    return name is not None and bool(BASE_RESOURCE_NAME_LEGAL_CHARS_P.fullmatch(name))
