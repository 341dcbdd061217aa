"""Origin of each module of a node: made for the node, executed for it, or shared with the host.

Modules that use a clock, threads, entropy, the environment or module-wide state are the node's own. The rest of the
standard library (re, math, collections, ...) is common to all nodes: its functions and classes are the host's, in a
module of the node's own, so a node can replace one for itself. An installed package is executed for each node if it is
pure Python, because it may use `time` or `threading`; one with extension modules (NumPy, PyYAML) can exist only once
per process and is shared.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from importlib.machinery import EXTENSION_SUFFIXES, ModuleSpec
from types import ModuleType
from typing import TYPE_CHECKING

from cfepy.nodes import refused_modules as refused

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

# fmt: off
FRESH = frozenset({
    "_pydatetime", "_pyio", "_threading_local", "aifc", "argparse", "asynchat", "asyncio", "asyncore", "bdb", "bz2",
    "cProfile", "chunk", "cmd", "code", "codeop", "concurrent", "configparser", "contextlib", "curses", "dbm", "email",
    "filecmp", "fileinput", "ftplib", "genericpath", "getopt", "getpass", "gettext", "glob", "gzip", "http", "imaplib",
    "imghdr", "json", "logging", "lzma", "mailbox", "mailcap", "mimetypes", "netrc", "nntplib", "optparse", "pathlib",
    "pdb", "pickle", "platform", "poplib", "posixpath", "pprint", "profile", "pstats", "queue", "quopri", "random",
    "runpy", "sched", "secrets", "selectors", "shelve", "shutil", "smtpd", "smtplib", "sndhdr", "socketserver",
    "statistics", "sunau", "tarfile", "telnetlib", "tempfile", "threading", "timeit", "tokenize", "traceback",
    "tracemalloc", "tty", "unittest", "urllib", "uu", "uuid", "warnings", "wave", "weakref", "wsgiref", "xml",
    "xmlrpc", "zipapp", "zipfile",
})
# fmt: on
"""Top-level names of standard library modules that each node executes for itself."""

LATE = frozenset({"traceback", "warnings"})
"""Modules of `FRESH` that are often imported but rarely used: their code runs on first use."""

HOST_SUBMODULES = frozenset({"urllib.parse", "urllib.error"})

HOST_BELOW = frozenset({"importlib", "numpy"})
"""Packages that are made for the node, with the host's submodules."""

WITHOUT_ACCELERATOR = frozenset(
    {"_pickle", "_queue", "_uuid", "_warnings", "_posixsubprocess", "_asyncio", "_dbm", "_gdbm"}
)
"""C parts of the modules above that would keep state per process, block a real thread or open files."""

HOST_PACKAGES = frozenset({"cfepy", "greenlet", "hypothesis", "_pytest", "pkg_resources", "pytest", "setuptools"})

# fmt: off
_MULTIPROCESSING = (
    "connection", "context", "managers", "process", "queues", "reduction", "shared_memory",
    "sharedctypes", "synchronize",
)
# fmt: on

_THREADS_AS_PROCESSES = ("multiprocessing.dummy", "multiprocessing.dummy.connection")

_pure: dict[str, bool] = {}


@dataclass(frozen=True, slots=True)
class Provision:
    """A program's replacements for the host's modules.

    Attributes:
        factories: of modules that are made for it, by full name.
        fixes: changes to standard library modules after they were executed for it, by full name.
        fresh: top-level names of standard library modules that are executed for it.
        is_process: whether it has a process of its own. If so, pure Python packages are executed for it too and names
            that it sets in shared modules stay local. Otherwise both are the host's.
    """

    factories: Mapping[str, Callable[[Universe], ModuleType]]
    fixes: Mapping[str, Callable[[Universe, ModuleType], None]]
    fresh: Collection[str] = FRESH
    is_process: bool = True

    def executes(self, name: str) -> bool:
        """Return whether a standard library module, given by its full name, is executed for the program."""
        return name.partition(".")[0] in self.fresh and name not in HOST_SUBMODULES

    def executes_package(self, spec: ModuleSpec) -> bool:
        """Return whether an installed package, found by `spec`, is executed for the program."""
        return self.is_process and is_pure_python(spec)

    def copies(self, name: str) -> bool:
        """Return whether the program gets its own module with the names of a host module."""
        top = name.partition(".")[0]
        return self.is_process and (top == "numpy" or is_stdlib(top))


def refused_modules() -> Mapping[str, Callable[[Universe], ModuleType]]:
    """Return the factories of the modules that refuse their use, by name."""
    named = {
        "multiprocessing": refused.multiprocessing_module,
        "subprocess": refused.subprocess_module,
        "ssl": refused.refused_import("ssl", refused.ENCRYPTION),
        "_ssl": refused.refused_import("_ssl", refused.ENCRYPTION),
        "OpenSSL": refused.refused_import("OpenSSL", refused.ENCRYPTION),  # libraries such as requests fall back to it
    }
    named.update({f"multiprocessing.{part}": refused.multiprocessing_submodule for part in _MULTIPROCESSING})
    named["multiprocessing.pool"] = refused.pool_module
    named.update({name: refused.dummy_module(name) for name in _THREADS_AS_PROCESSES})
    named.update({name: refused.refused_import(name, "it is not needed") for name in WITHOUT_ACCELERATOR})
    # Nodes load it for speed. `pickle`, which tries it while it is being loaded, does not find its contents.
    named["_pickle"] = lambda universe: universe.importer.load("pickle")
    return named


def is_stdlib(top: str) -> bool:
    """Return whether the first part of a module name belongs to the standard library."""
    return top in sys.stdlib_module_names


def is_pure_python(spec: ModuleSpec) -> bool:
    """Return whether an installed module or package, found by `spec`, has no extension module anywhere below it."""
    origin = spec.origin or ""
    known = _pure.get(origin)
    if known is None:
        folders = spec.submodule_search_locations
        known = origin.endswith(".py") if folders is None else not any(map(_has_extension, folders))
        _pure[origin] = known
    return known


def _has_extension(folder: str) -> bool:
    suffixes = tuple(EXTENSION_SUFFIXES)
    return any(name.endswith(suffixes) for _, _, names in os.walk(folder) for name in names)
