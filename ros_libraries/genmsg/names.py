"""Names of resources: "package/Name"."""

from __future__ import annotations

import re

PRN_SEPARATOR = "/"
RESOURCE_NAME_LEGAL_CHARS_P = re.compile(r"[A-Za-z][\w/]*")
BASE_RESOURCE_NAME_LEGAL_CHARS_P = re.compile(r"[A-Za-z]\w*")


def normalize_package_context(package_context: str) -> str:
    """Return a package's name without spaces around it and separators behind it."""
    return package_context.strip().rstrip(PRN_SEPARATOR)


def resource_name(res_pkg_name: str, name: str, my_pkg: str | None = None) -> str:
    """Return the full name, or the bare one if the package is `my_pkg`."""
    return name if res_pkg_name == my_pkg else f"{res_pkg_name}{PRN_SEPARATOR}{name}"


def resource_name_base(name: str) -> str:
    """Return the name without its package."""
    return name.rpartition(PRN_SEPARATOR)[2]


def resource_name_package(name: str) -> str | None:
    """Return the package of a name, or None."""
    package, separator, _ = name.partition(PRN_SEPARATOR)
    return package if separator else None


def package_resource_name(name: str) -> tuple[str, str]:
    """(package, bare name); the package may be "".

    Raises:
        ValueError: there is more than one separator.
    """
    package, _, base = name.rpartition(PRN_SEPARATOR)
    if PRN_SEPARATOR in package:
        raise ValueError(f"invalid name [{name}]")
    return package, base


def is_legal_resource_name(name: str | None) -> bool:
    """Return whether a name, with or without package, has legal characters only."""
    return name is not None and "//" not in name and RESOURCE_NAME_LEGAL_CHARS_P.fullmatch(name) is not None


def is_legal_resource_base_name(name: str | None) -> bool:
    """Return whether a name without package has legal characters only."""
    return name is not None and BASE_RESOURCE_NAME_LEGAL_CHARS_P.fullmatch(name) is not None
