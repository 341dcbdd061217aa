"""rosmsg: definitions of messages and services, as text (wiki.ros.org/rosmsg).

Types are found as in an import: those that cfepy brings along, and those of packages that the node can see.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Iterator, Sequence
from typing import Any

import roslib.message
import rospkg

from rosmsg import _definitions  # type: ignore[attr-defined]  # made for the node, which knows its message types
from rosmsg._texts import expanded
from rosmsg._yaml_text import create_names_filter, get_array_type_instance, get_yaml_for_msg

__all__ = [
    "MODE_MSG",
    "MODE_SRV",
    "ROSMsgException",
    "create_names_filter",
    "get_array_type_instance",
    "get_msg_text",
    "get_srv_text",
    "get_yaml_for_msg",
    "iterate_packages",
    "list_msgs",
    "list_srvs",
    "list_types",
    "packages",
    "rosmsg_debug",
    "rosmsg_md5",
    "rosmsg_search",
    "rosmsgmain",
]

MODE_MSG = ".msg"
MODE_SRV = ".srv"


class ROSMsgException(Exception):
    """A type that cannot be shown."""


def _kind(mode: str) -> str:
    if mode not in (MODE_MSG, MODE_SRV):
        raise ValueError(f"Unknown mode: {mode}")
    return mode[1:]


# -- which types -----------------------------------------------------------------------------------------------------


def packages() -> list[str]:
    """Return the names of all packages that have messages or services."""
    return list(_definitions.packages())


def list_types(package: str, mode: str = MODE_MSG, rospack: Any = None) -> list[str]:
    """Return the full names of the messages or services of a package, sorted.

    Args:
        package: its name.
        mode: MODE_MSG or MODE_SRV.
        rospack: accepted.

    Raises:
        rospkg.ResourceNotFound: there is no such package.
        ValueError: no such mode.
    """
    names = _definitions.names(package, _kind(mode))
    if not names and package not in packages() and importlib.util.find_spec(package) is None:
        (rospack or rospkg.RosPack()).get_path(package)
    return [f"{package}/{name}" for name in names]


def list_msgs(package: str, rospack: Any = None) -> list[str]:
    """Return the full names of the messages of a package; see `list_types`."""
    return list_types(package, MODE_MSG, rospack)


def list_srvs(package: str, rospack: Any = None) -> list[str]:
    """Return the full names of the services of a package; see `list_types`."""
    return list_types(package, MODE_SRV, rospack)


def iterate_packages(rospack: Any, mode: str) -> Iterator[tuple[str, str]]:
    """Yield packages with messages or services, each with their folder, or `""` for a package that cfepy brings along.

    Args:
        rospack: knows the folders of packages.
        mode: MODE_MSG or MODE_SRV.

    Raises:
        ValueError: no such mode.
    """
    kind = _kind(mode)
    known = rospack.list()
    for package in packages():
        if _definitions.names(package, kind):
            yield package, os.path.join(rospack.get_path(package), kind) if package in known else ""


def rosmsg_search(rospack: Any, mode: str, base_type: str) -> Iterator[str]:
    """Yield the full names of all messages or services that are called `base_type`."""
    for package, _ in iterate_packages(rospack, mode):
        if base_type in _definitions.names(package, _kind(mode)):
            yield f"{package}/{base_type}"


# -- definitions -----------------------------------------------------------------------------------------------------


def get_msg_text(type_: str, raw: bool = False, rospack: Any = None) -> str:
    """Return the definition of a message, with its fields' definitions indented below them.

    Args:
        type_: full name.
        raw: as written, without the definitions of its fields.
        rospack: accepted.

    Raises:
        ROSMsgException: there is no such message.
    """
    try:
        if raw:
            return str(_definitions.text(type_, "msg"))
        found = roslib.message.get_message_class(type_)
    except Exception as error:
        raise ROSMsgException(f"Unable to load msg [{type_}]: {error}") from None
    if found is None:
        raise ROSMsgException(f"Unable to load msg [{type_}]: Cannot locate message [{type_}]")
    return expanded(found)


def get_srv_text(type_: str, raw: bool = False, rospack: Any = None) -> str:
    """Return the definition of a service; see `get_msg_text`.

    Raises:
        ROSMsgException: there is no such service.
    """
    try:
        if raw:
            return str(_definitions.text(type_, "srv"))
        found = roslib.message.get_service_class(type_)
    except Exception as error:
        raise ROSMsgException(f"Unknown srv type [{type_}]: {error}") from None
    if found is None:
        raise ROSMsgException(f"Unknown srv type [{type_}]: Cannot locate message or service [{type_}]")
    return f"{expanded(found._request_class)}---\n{expanded(found._response_class)}"


def rosmsg_md5(mode: str, type_: str) -> str:
    """Return the md5sum of a message or service.

    Raises:
        IOError: there is no such type.
    """
    look_up = roslib.message.get_service_class if mode == MODE_SRV else roslib.message.get_message_class
    found = look_up(type_)
    if found is None:
        raise OSError(f"cannot load [{type_}]")
    return str(found._md5sum)


def rosmsg_debug(rospack: Any, mode: str, type_: str, raw: bool = False) -> None:
    """Print the definition of a message or service.

    Raises:
        ROSMsgException: there is no such type.
    """
    text = get_srv_text if _kind(mode) == "srv" else get_msg_text
    print(text(type_, raw=raw, rospack=rospack))


def rosmsgmain(mode: str = MODE_MSG) -> None:
    """Run the command `rosmsg`, or `rossrv` with MODE_SRV, on sys.argv."""
    from rosmsg._command import run

    run(mode)


def __getattr__(name: str) -> Any:
    """Return a command by the name that tests and tools use: `rosmsg_cmd_list(mode, full, argv)`."""
    from rosmsg._command import COMMANDS, usage

    if name == "fullusage":
        return usage
    command = COMMANDS.get(name.removeprefix("rosmsg_cmd_")) if name.startswith("rosmsg_cmd_") else None
    if command is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

    def run_it(mode: str, full: str, argv: Sequence[str] | None = None) -> int:
        return command(mode, list(sys.argv[1:] if argv is None else argv)[1:])

    return run_it
