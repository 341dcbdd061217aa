"""User of a program: one ordinary user on every computer, who owns all files that the program sees.

A run thus does not depend on the user who starts it: other users can replay a journal that root recorded. `pwd` and
`grp` know this user and root.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.files import GROUP, USER
from cfepy.nodes.made_modules import proxy

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

KEEP = -1  # an id that is not changed
ROOT = "root"


def identity(universe: Universe) -> dict[str, Any]:
    """Return the functions of `os` that get or set ids, as far as the host has them."""

    def user_of(*ids: int) -> None:
        _check(ids, USER)

    def group_of(*ids: int) -> None:
        _check(ids, GROUP)

    def set_groups(groups: Any) -> None:
        _check(tuple(groups), GROUP)

    def grouplist(user: str, group: int) -> list[int]:
        return [group]

    def init_groups(user: str, group: int) -> None:
        _check((group,), GROUP)

    names: dict[str, Any] = {
        "getegid": lambda: GROUP,
        "geteuid": lambda: USER,
        "getgid": lambda: GROUP,
        "getgrouplist": grouplist,
        "getgroups": lambda: [GROUP],
        "getlogin": lambda: user_name(universe),
        "getpgid": lambda pid: universe.pid,
        "getpgrp": lambda: universe.pid,
        "getresgid": lambda: (GROUP, GROUP, GROUP),
        "getresuid": lambda: (USER, USER, USER),
        "getsid": lambda pid: universe.pid,
        "getuid": lambda: USER,
        "initgroups": init_groups,
        "setgroups": set_groups,
        **dict.fromkeys(("setegid", "setgid", "setregid", "setresgid"), group_of),
        **dict.fromkeys(("seteuid", "setreuid", "setresuid", "setuid"), user_of),
    }
    return {name: function for name, function in names.items() if hasattr(os, name)}


def _check(ids: tuple[int, ...], own: int) -> None:
    """Check ids that a program sets: an ordinary user may set only its own.

    Raises:
        PermissionError: if an id is not the user's own.
    """
    if not set(ids) <= {own, KEEP}:
        raise PermissionError(errno.EPERM, os.strerror(errno.EPERM))


def user_name(universe: Universe) -> str:
    """Return the name of the program's user."""
    return universe.environ.get("USER") or universe.environ.get("LOGNAME") or "node"


def pwd_module(universe: Universe) -> ModuleType:
    """`pwd`: the program's user, and root."""
    import pwd

    name, home = user_name(universe), universe.environ.get("HOME") or "/"
    entries = [pwd.struct_passwd((name, "x", USER, GROUP, name, home, "/bin/sh"))]
    if name != ROOT:
        entries.append(pwd.struct_passwd((ROOT, "x", 0, 0, ROOT, f"/{ROOT}", "/bin/sh")))
    return proxy(
        pwd,
        getpwall=lambda: list(entries),
        getpwnam=_finder("getpwnam", "name", {each.pw_name: each for each in entries}),
        getpwuid=_finder("getpwuid", "uid", {each.pw_uid: each for each in entries}),
    )


def grp_module(universe: Universe) -> ModuleType:
    """`grp`: the groups of the program's user and of root."""
    import grp

    name = user_name(universe)
    entries = [grp.struct_group((name, "x", GROUP, [name]))]
    if name != ROOT:
        entries.append(grp.struct_group((ROOT, "x", 0, [])))
    return proxy(
        grp,
        getgrall=lambda: list(entries),
        getgrgid=_finder("getgrgid", "gid", {each.gr_gid: each for each in entries}),
        getgrnam=_finder("getgrnam", "name", {each.gr_name: each for each in entries}),
    )


def _finder(function: str, kind: str, entries: dict[Any, Any]) -> Callable[[Any], Any]:
    def find(key: Any) -> Any:
        if key not in entries:
            raise KeyError(f"{function}(): {kind} not found: {key!r}")
        return entries[key]

    return find
