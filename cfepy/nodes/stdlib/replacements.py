"""Modules that are made for each node, by name, and the changes to those that are executed for it.

Some modules are rarely used by nodes, or are missing on some systems. The code that makes them is loaded when a node
first loads such a module.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from types import ModuleType
from typing import TYPE_CHECKING

from cfepy.nodes.module_origins import Provision, refused_modules
from cfepy.nodes.node_tracebacks import hide_in
from cfepy.nodes.stdlib import (
    futures,
    lookup,
    os_module,
    random_module,
    signal_module,
    sys_module,
    thread_module,
    time_module,
)

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def _curses(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.curses_module import curses_module

    return curses_module(universe)


def _fcntl(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.terminal import fcntl_module

    return fcntl_module(universe)


def _gc(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.process_modules import gc_module

    return gc_module(universe)


def _locale(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.process_modules import locale_module

    return locale_module(universe)


def _grp(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.users import grp_module

    return grp_module(universe)


def _pwd(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.users import pwd_module

    return pwd_module(universe)


def _psutil(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.process_modules import psutil_module

    return psutil_module(universe)


def _resource(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.process_modules import resource_module

    return resource_module(universe)


def _select(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.select_module import select_module

    return select_module(universe)


def _socket(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.socket_module import socket_module

    return socket_module(universe)


def _sqlite3(universe: Universe) -> ModuleType:
    from cfepy.nodes.files.shared import sqlite3_module

    return sqlite3_module(universe)


def _sqlite3_part(universe: Universe) -> ModuleType:
    from cfepy.nodes.files.shared import sqlite3_part

    return sqlite3_part(universe)


def _codecs(universe: Universe) -> ModuleType:
    from cfepy.nodes.files.shared import codecs_module

    return codecs_module(universe)


def _fix_element_tree(universe: Universe, module: ModuleType) -> None:
    """Use the host's functions for comments in the node's module, and set them in the C part again.

    The C part recognizes comments by the functions of the module that was loaded last.
    """
    import _elementtree  # type: ignore[import-not-found]
    from xml.etree import ElementTree

    names = {name: getattr(ElementTree, name) for name in ("Comment", "PI", "ProcessingInstruction")}
    vars(module).update(names)
    _elementtree._set_factories(ElementTree.Comment, ElementTree.ProcessingInstruction)


def _termios(universe: Universe) -> ModuleType:
    from cfepy.nodes.stdlib.terminal import termios_module

    return termios_module(universe)


MADE: Mapping[str, Callable[[Universe], ModuleType]] = {
    "_curses": _curses,
    "_signal": signal_module.signal_module,
    "_socket": _socket,
    "_thread": thread_module.thread_module,
    "atexit": signal_module.atexit_module,
    "cfepy": time_module.cfepy_module,
    "codecs": _codecs,
    "dataclasses": lookup.dataclasses_module,
    "datetime": time_module.datetime_module,
    "fcntl": _fcntl,
    "functools": lookup.functools_module,
    "gc": _gc,
    "grp": _grp,
    "importlib": sys_module.importlib_module,
    "importlib.util": sys_module.importlib_util_module,
    "inspect": lookup.inspect_module,
    "io": sys_module.io_module,
    "locale": _locale,
    "numpy": random_module.numpy_module,
    "numpy.random": random_module.numpy_random_module,
    "os": os_module.os_module,
    "resource": _resource,
    "select": _select,
    "psutil": _psutil,
    "pwd": _pwd,
    "signal": signal_module.signal_module,
    "socket": _socket,
    "sqlite3": _sqlite3,
    "sqlite3.dbapi2": _sqlite3_part,
    "sys": sys_module.sys_module,
    "termios": _termios,
    "time": time_module.time_module,
    "typing": lookup.typing_module,
}
"""The factories of the modules that are made, by full name."""

FIXES: Mapping[str, Callable[[Universe, ModuleType], None]] = {
    "asyncio": futures.fix_asyncio,
    "concurrent.futures._base": futures.fix_futures,
    "random": random_module.fix_random,
    "threading": thread_module.fix_threading,
    "xml.etree.ElementTree": _fix_element_tree,
    "traceback": lambda universe, module: hide_in(module),
}
"""Changes to standard library modules after their code has run for a node."""


@cache
def for_nodes() -> Provision:
    """Return a node's replacements for the host's modules."""
    return Provision({**refused_modules(), **MADE}, FIXES)
