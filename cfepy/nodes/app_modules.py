"""Replacements for Python's modules that open files, for applications in Python; they are the same as those of nodes.

An application in Python is part of the simulated computer and runs with the host's modules, threads, clocks and
packages. Only its files belong to the run: its `open`, and the modules that open files, which are made or executed once
for all applications of a processor, since they share a process. They are made when an application first opens a file or
loads such a module. Until then they cost nothing.
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
from cfepy.nodes.busy_waits import HOOK
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
"""Top-level names of modules that work on the run's files for an application."""


class AppModules:
    """Modules of the applications of one processor.

    Args:
        make: makes the universe that has the modules that open files; all others are the host's.
        accesses: where the accesses of their code are reported; None for no reports.
        turns: called at each turn of a loop that can wait without a call (`cfepy.nodes.busy_waits`); None does nothing.

    Attributes:
        builtins: `__builtins__` of their code.
    """

    def __init__(
        self,
        make: Callable[[], Universe],
        accesses: Accesses | None = None,
        turns: Callable[[tuple[str, int, bool]], object] | None = None,
    ) -> None:
        self._make = make
        self._accesses = accesses
        self._made: Universe | None = None
        self.builtins: dict[str, Any] = {**vars(builtins), "open": self._opener(), "__import__": self._import}
        self.builtins[HOOK] = turns if turns is not None else lambda place: None

    @property
    def _universe(self) -> Universe:
        if self._made is None:
            self._made = self._make()
        return self._made

    def execute(self, module: ModuleType) -> None:
        """Run the code of an application's new module.

        Args:
            module: a module made by `importlib.util.module_from_spec`, with source.

        Raises:
            UsageError: if it would work on the host's files.
            BaseException: raised by its code.
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
        """Close the files that applications left open, at the end of the processor."""
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
            with suppress(ImportError):  # Python's own import is about to raise it
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
    """Return the host's `os` for applications, working on the files of the run."""
    from cfepy.nodes.made_modules import rebind
    from cfepy.nodes.stdlib.os_module import paths
    from cfepy.nodes.stdlib.users import identity

    points = universe.file_points

    def write(fd: int, data: Any) -> int:
        if points is not None:
            points.pause()
        written = os.write(fd, data)
        if universe.overlay is not None:
            universe.overlay.wrote(fd)
        return written

    forked = {"register_at_fork": lambda **hooks: None}  # explorations fork, applications do not
    own = {**paths(universe), **identity(universe), "write": write, **forked}
    module = rebind(os, **own)
    modules = universe.importer.modules
    modules["os"] = module  # its own path functions import it
    path = universe.importer.load(os.path.__name__)
    vars(module)["path"] = modules["os.path"] = path
    return module


def numpy_module(universe: Universe) -> ModuleType:
    """Return the host's NumPy, with functions for paths that work on the run's files."""
    import numpy

    from cfepy.nodes.files.shared import array_files
    from cfepy.nodes.made_modules import proxy

    return proxy(numpy, __getattr__=lambda name: getattr(numpy, name), **array_files(universe, numpy))


def logging_module(universe: Universe) -> ModuleType:
    """Return the host's `logging` with handlers that write the run's files; the loggers are the host's."""
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
    """Return the host's `importlib`; its `import_module` gives an application its own modules."""
    from cfepy.nodes.made_modules import proxy

    def import_module(name: str, package: str | None = None) -> ModuleType:
        is_own = name.partition(".")[0] in REPLACED
        return universe.importer.load(name) if is_own else importlib.import_module(name, package)

    return proxy(importlib, __getattr__=lambda name: getattr(importlib, name), import_module=import_module)


def sys_module(universe: Universe) -> ModuleType:
    """Return the host's `sys` itself."""
    return sys


def make_app_universe(**options: Any) -> Universe:
    """Return a universe for `AppModules`.

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
