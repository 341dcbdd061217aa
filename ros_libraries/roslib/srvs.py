"""roslib.srvs: parses service definitions (`SrvSpec`), from a text or a file. It uses genmsg."""

from __future__ import annotations

import os

import rosmsg
from genmsg import InvalidMsgSpec
from genmsg.srvs import SrvSpec

from roslib.msgs import SEP
from roslib.msgs import load_from_string as _load_message
from roslib.names import resource_name
from roslib.packages import resource_file

EXT = ".srv"
COMMENTCHAR = "#"
IODELIM = "---"


SrvSpecException = InvalidMsgSpec
VERBOSE = False


def set_verbose(v: bool) -> None:
    """Set whether to print the files that are read. Only `is_verbose` uses the value."""
    global VERBOSE
    VERBOSE = v


def is_verbose() -> bool:
    """Return the last value given to `set_verbose`."""
    return VERBOSE


def list_srv_types(package: str, include_depends: bool) -> list[str]:
    """Return the names of the services of a package; with `include_depends`, also those of its dependencies."""
    import rospkg

    found = [name.partition(SEP)[2] for name in rosmsg.list_srvs(package)]
    depends = rospkg.RosPack().get_depends(package, implicit=False) if include_depends else []
    return found + [name for each in depends for name in rosmsg.list_srvs(each)]


def srv_file(package: str, type_: str) -> str:
    """Return the path of a definition, even if it does not exist.

    Raises:
        InvalidROSPkgException: there is no such package.
    """
    return resource_file(package, "srv", type_ + EXT)


def load_from_file(file_name: str, package_context: str = "") -> tuple[str, SrvSpec]:
    """Return the name and definition in a file; see roslib.msgs.load_from_file."""
    short = os.path.basename(file_name).removesuffix(EXT)
    package_context = package_context.rstrip("/")
    name = resource_name(package_context, short)
    with open(file_name, encoding="utf-8") as file:
        return name, load_from_string(file.read(), package_context, name, short)


def load_from_string(text: str, package_context: str = "", full_name: str = "", short_name: str = "") -> SrvSpec:
    """Return the definition in a text.

    Raises:
        SrvSpecException: the line `---` is missing.
        MsgSpecException: a mistake in one of its halves.
    """
    lines = text.splitlines(keepends=True)
    fence = next((number for number, line in enumerate(lines) if line.startswith(IODELIM)), None)
    if fence is None:
        raise SrvSpecException(f"missing line {IODELIM} between request and response")
    halves = zip(("Request", "Response"), ("".join(lines[:fence]), "".join(lines[fence + 1 :])), strict=True)
    request, response = (
        _load_message(half, package_context, full_name + part, short_name + part) for part, half in halves
    )
    return SrvSpec(request, response, text, full_name, short_name, package_context)
