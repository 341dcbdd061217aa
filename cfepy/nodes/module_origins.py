"""The origin of each module of a node: made for the node, executed afresh for it, or shared with the host.

Modules that see a clock, threads, entropy, the environment or a module-wide state are the node's own; the rest of the
standard library (re, math, collections, ...) is the same for all nodes: its functions and classes are the host's,
in a module of the node's own, so that a node may replace one for itself. An installed
package is executed afresh if it is pure Python, because it may well import `time` or `threading`; one with extension
modules (NumPy, PyYAML) can only exist once per process and is shared.
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
"""Modules of the standard library, by their first name, that each node executes for itself."""

LATE = frozenset({"traceback", "warnings"})
"""Those of them that much of the rest imports and hardly ever uses: their code runs when it is needed."""

HOST_SUBMODULES = frozenset({"urllib.parse", "urllib.error"})

HOST_BELOW = frozenset({"importlib", "numpy"})
"""Packages that are made for the node, while their submodules are the host's."""

WITHOUT_ACCELERATOR = frozenset(
    {"_pickle", "_queue", "_uuid", "_warnings", "_posixsubprocess", "_asyncio", "_dbm", "_gdbm"}
)
"""C halves of the above that would keep state per process, block a real thread or open files themselves."""

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
    """What a program has in place of the host's modules.

    Attributes:
        factories: of modules that are made for it, by full name.
        fixes: what is done to modules of the standard library that were executed afresh, by full name.
        fresh: modules of the standard library that are, by their first name.
        is_process: it has a process of its own: packages in pure Python are executed afresh for it too, and names that
            it gives to shared modules stay with it. Otherwise both are the host's.
    """

    factories: Mapping[str, Callable[[Universe], ModuleType]]
    fixes: Mapping[str, Callable[[Universe, ModuleType], None]]
    fresh: Collection[str] = FRESH
    is_process: bool = True

    def executes(self, name: str) -> bool:
        """Whether it executes a module of the standard library, given by its full name, afresh."""
        return name.partition(".")[0] in self.fresh and name not in HOST_SUBMODULES

    def executes_package(self, spec: ModuleSpec) -> bool:
        """Whether it executes an installed package, found by `spec`, afresh."""
        return self.is_process and is_pure_python(spec)

    def copies(self, name: str) -> bool:
        """Whether a module of the host's gets a module of the program's to hold its names."""
        top = name.partition(".")[0]
        return self.is_process and (top == "numpy" or is_stdlib(top))


def refused_modules() -> Mapping[str, Callable[[Universe], ModuleType]]:
    """The factories of the modules that refuse their use, by name."""
    named = {
        "multiprocessing": refused.multiprocessing_module,
        "subprocess": refused.subprocess_module,
        "ssl": refused.refused_import("ssl", refused.ENCRYPTION),
        "_ssl": refused.refused_import("_ssl", refused.ENCRYPTION),
    }
    named.update({f"multiprocessing.{part}": refused.multiprocessing_submodule for part in _MULTIPROCESSING})
    named["multiprocessing.pool"] = refused.pool_module
    named.update({name: refused.dummy_module(name) for name in _THREADS_AS_PROCESSES})
    named.update({name: refused.refused_import(name, "it is not needed") for name in WITHOUT_ACCELERATOR})
    # Nodes import it for speed. To pickle itself, which asks while it is being loaded, it lacks all that matters.
    named["_pickle"] = lambda universe: universe.importer.load("pickle")
    return named


def is_stdlib(top: str) -> bool:
    """Whether the first part of a module name belongs to the standard library."""
    return top in sys.stdlib_module_names


def is_pure_python(spec: ModuleSpec) -> bool:
    """Whether an installed module or package, found by `spec`, has no extension module anywhere below it."""
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
