"""What applications have in place of Python's modules that open files: the same stand-ins as nodes have.

An application in Python is the simulated computer's own code and runs among the host's modules, with the host's
threads, clocks and packages. Its files alone are the run's: its `open`, and the modules that open files, which are made
or executed afresh for all applications of a processor together, as they share a process. All of it is made when an
application first opens a file or imports such a module; the others pay nothing.
"""

from __future__ import annotations

import builtins
import importlib
import importlib.util
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from importlib.machinery import PathFinder, SourceFileLoader
from types import ModuleType
from typing import IO, TYPE_CHECKING, Any

from cfepy.interpreter.host_system import check_own_builtins
from cfepy.nodes.node_sources import code_of_source

if TYPE_CHECKING:
    from cfepy.nodes.accesses import Accesses
    from cfepy.nodes.universe import Universe

# fmt: off
REPLACED = frozenset({
    "aifc", "bz2", "cProfile", "chunk", "codecs", "configparser", "dbm", "filecmp", "fileinput", "genericpath",
    "gettext", "glob", "grp", "gzip", "imghdr", "importlib", "io", "logging", "lzma", "mailbox", "mailcap", "mimetypes",
    "netrc", "numpy", "os", "pathlib", "posixpath", "profile", "pstats", "pwd", "quopri", "runpy", "shelve", "shutil",
    "sndhdr", "sqlite3", "sunau", "tarfile", "tempfile", "tokenize", "uu", "wave", "xml", "zipapp", "zipfile",
})
# fmt: on
"""Modules, by their first name, that an application has over the run's files."""


class AppModules:
    """The modules of the applications of one processor.

    Args:
        make: makes the universe whose modules that open files they have, and whose other modules are the host's.
        accesses: what their code tells of what it touches; None for nothing.

    Attributes:
        builtins: what their code has as `__builtins__`.
    """

    def __init__(self, make: Callable[[], Universe], accesses: Accesses | None = None) -> None:
        self._make = make
        self._accesses = accesses
        self._made: Universe | None = None
        self.builtins: dict[str, Any] = {**vars(builtins), "open": self._opener(), "__import__": self._import}

    @property
    def _universe(self) -> Universe:
        if self._made is None:
            self._made = self._make()
        return self._made

    def execute(self, module: ModuleType) -> None:
        """Run the code of an application's new module.

        Args:
            module: as `importlib.util.module_from_spec` makes it; it has source.

        Raises:
            UsageError: it would have the files of the computer.
            BaseException: what its code raises.
        """
        check_own_builtins()
        loader = module.__loader__
        assert isinstance(loader, SourceFileLoader)
        vars(module)["__builtins__"] = self.builtins
        file = loader.get_filename(loader.name)
        kinds = None if self._accesses is None else self._accesses.kinds(file, is_main=False)
        code = code_of_source(loader.get_data(file), file, kinds)
        if self._accesses is None or kinds is None:
            exec(code, vars(module))
            return
        self.builtins.update(self._accesses.hooks())
        self._accesses.adopt(vars(module))
        with self._accesses.loading():
            exec(code, vars(module))

    def close(self) -> None:
        """The processor has come to its end: close what its applications left open."""
        if self._made is not None:
            self._made.files.close_all()
            self._made = None

    def _opener(self) -> Callable[..., IO[Any]]:
        def open_file(
            file: Any,
            mode: str = "r",
            buffering: int = -1,
            encoding: str | None = None,
            errors: str | None = None,
            newline: str | None = None,
            closefd: bool = True,
            opener: Callable[[Any, int], int] | None = None,
        ) -> IO[Any]:
            of_run = vars(self._universe.builtins)["open"]
            opened: IO[Any] = of_run(file, mode, buffering, encoding, errors, newline, closefd, opener)
            return opened

        open_file.__name__ = open_file.__qualname__ = "open"
        return open_file

    # -- importing -----------------------------------------------------------------------------------------------------

    def _import(
        self,
        name: str,
        globals: Mapping[str, Any] | None = None,
        locals: Mapping[str, Any] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        """`__import__` of an application."""
        if level:
            with suppress(ImportError):  # which Python's own import is about to raise
                self._load_parts(name, globals or {}, fromlist or (), level)
        elif name.partition(".")[0] in REPLACED:
            return self._universe.importer.import_name(name, globals, locals, fromlist)
        return builtins.__import__(name, globals, locals, fromlist or (), level)

    def _load_parts(self, name: str, names: Mapping[str, Any], fromlist: Sequence[str], level: int) -> None:
        """Execute the parts of an application's own package that a relative import names."""
        full = importlib.util.resolve_name("." * level + name, names.get("__package__") or "")
        parts = full.split(".")
        for count in range(2, len(parts) + 1):
            self._load_part(".".join(parts[:count]))
        for part in fromlist:
            if not hasattr(sys.modules.get(full), part):
                self._load_part(f"{full}.{part}")

    def _load_part(self, name: str) -> None:
        parent, _, child = name.rpartition(".")
        folders = getattr(sys.modules.get(parent), "__path__", None)
        spec = None if name in sys.modules or folders is None else PathFinder.find_spec(name, folders)
        if spec is None or not isinstance(spec.loader, SourceFileLoader):
            return
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        try:
            self.execute(module)
        except BaseException:
            del sys.modules[name]
            raise
        setattr(sys.modules[parent], child, module)


# -- modules that are made ---------------------------------------------------------------------------------------------


def os_module(universe: Universe) -> ModuleType:
    """`os` of applications: the host's, over the files of the run."""
    from cfepy.nodes.made_modules import rebind
    from cfepy.nodes.stdlib.os_module import paths
    from cfepy.nodes.stdlib.users import identity

    def write(fd: int, data: Any) -> int:
        written = os.write(fd, data)
        if universe.overlay is not None:
            universe.overlay.wrote(fd)
        return written

    forked = {"register_at_fork": lambda **hooks: None}  # explorations fork, not apps
    own = {**paths(universe), **identity(universe), "write": write, **forked}
    module = rebind(os, **own)
    modules = universe.importer.modules
    modules["os"] = module  # its own path functions import it
    path = universe.importer.load(os.path.__name__)
    vars(module)["path"] = modules["os.path"] = path
    return module


def numpy_module(universe: Universe) -> ModuleType:
    """The host's NumPy, whose functions that take paths see the run's files."""
    import numpy

    from cfepy.nodes.files.shared import array_files
    from cfepy.nodes.made_modules import proxy

    return proxy(numpy, __getattr__=lambda name: getattr(numpy, name), **array_files(universe, numpy))


def logging_module(universe: Universe) -> ModuleType:
    """The host's `logging`, whose handlers write the run's files; the loggers are the host's."""
    import logging

    from cfepy.nodes.made_modules import rebind

    open_file, path = vars(universe.builtins)["open"], universe.importer.load("os.path")

    class FileHandler(logging.FileHandler):
        __doc__ = logging.FileHandler.__doc__

        def __init__(self, filename: Any, *args: Any, **options: Any) -> None:
            super().__init__(path.abspath(filename), *args, **options)

        def _open(self) -> Any:
            return open_file(self.baseFilename, self.mode, encoding=self.encoding, errors=self.errors)

    return rebind(logging, ("basicConfig",), FileHandler=FileHandler)


def importlib_module(universe: Universe) -> ModuleType:
    """The host's `importlib`, whose `import_module` gives an application its own modules."""
    from cfepy.nodes.made_modules import proxy

    def import_module(name: str, package: str | None = None) -> ModuleType:
        is_own = name.partition(".")[0] in REPLACED
        return universe.importer.load(name) if is_own else importlib.import_module(name, package)

    return proxy(importlib, __getattr__=lambda name: getattr(importlib, name), import_module=import_module)


def sys_module(universe: Universe) -> ModuleType:
    """The host's `sys` itself."""
    return sys


def make_app_universe(**options: Any) -> Universe:
    """A universe for `AppModules`.

    Args:
        options: of `Universe`.
    """
    from cfepy.nodes.module_origins import Provision
    from cfepy.nodes.stdlib.replacements import FIXES, MADE
    from cfepy.nodes.universe import Universe

    own = {
        "importlib": importlib_module,
        "logging": logging_module,
        "numpy": numpy_module,
        "os": os_module,
        "sys": sys_module,
    }
    like_nodes = {name: MADE[name] for name in ("codecs", "grp", "io", "pwd", "sqlite3", "sqlite3.dbapi2")}
    fixes = {name: FIXES[name] for name in ("random", "xml.etree.ElementTree")}
    provision = Provision({**like_nodes, **own}, fixes, REPLACED | {"random"}, is_process=False)
    return Universe(**options, provision=provision)
