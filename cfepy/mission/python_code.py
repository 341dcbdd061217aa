"""Python code of applications, libraries and ROS nodes: how it is found and executed.

The code for /cf/hk.so is searched in this order: the mission's folder (hk.py, or a package hk), the apps included in
cfepy, an installed Python module of that name, and a file that the mission itself wrote, possibly on /ram. Files that
the mission overwrote or removed in its folder count as such. An app is executed anew at every start, so a restart finds
fresh variables, as with a C module.
"""

from __future__ import annotations

import importlib.util
import inspect
import os
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable
from importlib.machinery import SourceFileLoader
from itertools import count
from pathlib import Path, PurePosixPath
from types import ModuleType
from typing import Any

from cfepy.es import NODE_SYMBOL, SymbolError
from cfepy.mission.compiled_code import find_compiled
from cfepy.mission.loader import NO_SYMBOL, Code, Finder, MainCode, RemovedCodeError
from cfepy.nodes import AppModules
from cfepy.osal import FileSystem
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import PYTHON_BYTES
from cfepy.reading.resources import shipped
from cfepy.rtos import TaskExit
from cfepy.status import OS_ERROR, OsalError
from cfepy.writing.console import Console

CODE_SUFFIXES = ("", ".so", ".py", ".obj", ".o")
NODE_SUFFIX = ".so"  # the suffix that ES adds to a name without one
PREFIX = "cfepy_app_"


# -- nodes -------------------------------------------------------------------------------------------------------------


class NodeScripts(Finder):
    """Finds scripts of ROS nodes: applications with the entry point `__main__`.

    Args:
        files: the virtual file system.
        folder: the mission's folder.
        script_of: returns the script of a node outside the folder, by virtual path.
        node_main: returns the main function of a node, by its script and its application's name.
    """

    def __init__(
        self,
        files: FileSystem,
        folder: Path,
        script_of: Callable[[str], Path | None],
        node_main: Callable[[Path, str], Callable[[], object]],
    ) -> None:
        self._files = files
        self._folder = folder
        self._script_of = script_of
        self._node_main = node_main

    def find(self, file: str, symbol: str | None) -> Code | None:
        if symbol != NODE_SYMBOL:
            return None
        script = self._script_of(file) or find_node(file, self._folder)
        return None if script is None else MainCode(file, lambda app_name: self._node_main(script, app_name))

    def exists(self, file: str) -> bool:
        """Return whether there is a script; one that the mission changed or removed does not count."""
        if self._script_of(file) is not None:
            return True
        script = find_node(file, self._folder)
        return script is not None and not _is_changed(script, self._folder, self._files)

    def forget(self) -> None:
        """Do nothing: there is no code to release."""


def find_node(file: str, folder: Path) -> Path | None:
    """Return the script of a ROS node at a virtual path below /cf: a file x, as ROS scripts are often named, or x.py.

    OSAL never opens it, so OSAL's limits for file names do not apply; it must still be below /cf.
    """
    if ".." in file:
        return None
    plain = folder / file.removeprefix("/cf/").removesuffix(NODE_SUFFIX)
    if os.path.isfile(plain):
        return plain
    found = find_code(file, folder)
    return found if isinstance(found, Path) else None


# -- Python ------------------------------------------------------------------------------------------------------------


class PythonLoader:
    """Executes the Python code of one processor.

    Args:
        console: for errors while a module is executed.
        handle: returns the argument for the main function of an app.
        modules: the replacements for the host's modules.
    """

    def __init__(self, console: Console, handle: Callable[[], Any], modules: AppModules) -> None:
        self.handle = handle
        self.names = ModuleNames()
        self._modules = modules
        self._console = console

    def module(self, file: str, found: Found, owner: str) -> ModuleType:
        """Execute code as a new module; see `ModuleLoader.load_module` for the errors."""
        try:
            return execute(found, self.names.new(owner), self._modules)
        except (TaskExit, KeyboardInterrupt):
            raise
        except BaseException as error:  # also sys.exit(), which ends the module and not the process
            from cfepy.mission.tracebacks import app_traceback, described

            self._console.write(app_traceback(error))
            raise OsalError(OS_ERROR, f"{file}: {described(error)}") from error

    def forget(self) -> None:
        """Release the code and its open files."""
        self.names.forget()
        self._modules.close()

    def function(self, module: ModuleType, file: str, symbol: str) -> Callable[[Any], object]:
        """Return an entry point; see `ModuleLoader.load` for the errors."""
        function = getattr(module, symbol, None)
        if not callable(function):
            self._console.write(f"OS_SymbolLookup: {file} has no function {symbol}")
            raise SymbolError(OS_ERROR, symbol)
        fault = _fault_of(function)
        if fault is not None:
            self._console.write(f"OS_SymbolLookup: {symbol} of {file} {fault}")
            raise SymbolError(OS_ERROR, symbol)
        found: Callable[[Any], object] = function
        return found


class PythonCode:
    """Python code; see `Code`.

    Args:
        python: executes it.
        file: the requested virtual path.
        found: the code at that path.
    """

    def __init__(self, python: PythonLoader, file: str, found: Found) -> None:
        self._python = python
        self._file = file
        self._found = found

    def main(self, symbol: str, app_name: str) -> Callable[[], object]:
        """Return the main function, which is called with the handle of the services."""
        main, handle = self._python.function(self.module(app_name), self._file, symbol), self._python.handle
        return lambda: main(handle())

    def library(self, symbol: str) -> tuple[ModuleType, Callable[[int], object]]:
        """Return a library and its init function, which gets the handle of the services and not the LibId."""
        module, handle = self.module(f"library {self._file}"), self._python.handle
        if symbol == NO_SYMBOL:
            return module, lambda lib_id: 0
        init = self._python.function(module, self._file, symbol)
        return module, lambda lib_id: init(handle())

    def module(self, owner: str) -> ModuleType:
        return self._python.module(self._file, self._found, owner)


class PythonFinder(ABC):
    """Finds Python code of applications and libraries, not of nodes.

    Args:
        python: executes the code.
    """

    def __init__(self, python: PythonLoader) -> None:
        self._python = python

    def find(self, file: str, symbol: str | None) -> Code | None:
        found = None if symbol == NODE_SYMBOL else self.look(file)
        return None if found is None else PythonCode(self._python, file, found)

    def exists(self, file: str) -> bool:
        return self.look(file) is not None

    def unload(self, app_name: str) -> None:
        """Do nothing: the module is removed when the application starts again."""
        return

    def forget(self) -> None:
        self._python.forget()

    @abstractmethod
    def look(self, file: str) -> Found | None:
        """Return the code at a virtual path; see `find` for the errors."""


class MissionFolder(PythonFinder):
    """The folder of the mission, with the files that the mission itself overwrote.

    Args:
        python: executes the code.
        files: the virtual file system.
        folder: the mission's folder.
    """

    def __init__(self, python: PythonLoader, files: FileSystem, folder: Path) -> None:
        super().__init__(python)
        self._files = files
        self._folder = folder

    def look(self, file: str) -> Found | None:
        self._files.translate(file)
        found = _in_folder(file, self._folder)
        if found is None or not _is_changed(found, self._folder, self._files):
            return found
        written = find_virtual_code(file, self._files)
        if written is None:
            raise RemovedCodeError(file)
        return written


class ShippedApps(PythonFinder):
    """The apps included in cfepy."""

    def look(self, file: str) -> Found | None:
        return _in_folder(file, shipped("apps"))


class InstalledModules(PythonFinder):
    """Python modules installed on the host."""

    def look(self, file: str) -> Found | None:
        return _installed(file)


class WrittenFiles(PythonFinder):
    """Files that the mission itself wrote, or got from the ground.

    Args:
        python: executes the code.
        files: the virtual file system.
    """

    def __init__(self, python: PythonLoader, files: FileSystem) -> None:
        super().__init__(python)
        self._files = files

    def look(self, file: str) -> Found | None:
        return find_virtual_code(file, self._files)


def python_finders(python: PythonLoader, files: FileSystem, folder: Path) -> list[Finder]:
    """Return the finders of Python code, in the order of the search; see `MissionFolder` for the arguments."""
    return [
        MissionFolder(python, files, folder),
        ShippedApps(python),
        InstalledModules(python),
        WrittenFiles(python, files),
    ]


def find_code(file: str, folder: Path) -> Path | str | None:
    """Return the Python code on the host at a virtual path below /cf, for tools that examine a mission from outside.

    Args:
        file: the virtual path.
        folder: the mission's folder.

    Returns:
        A source file, or the name of an installed module; None if there is compiled code.
    """
    return None if find_compiled(file, folder) is not None else find_declarations(file, folder)


def find_declarations(file: str, folder: Path) -> Path | str | None:
    """Return the Python code with the declared names and packets for a virtual path, for tools; see `find_code`.

    For compiled code it is the Python application of the same name, such as one included in cfepy.
    """
    return _in_folder(file, folder) or _in_folder(file, shipped("apps")) or _installed(file)


def _inside(file: str) -> PurePosixPath:
    """Return a virtual path relative to /cf."""
    return PurePosixPath(file).relative_to("/cf") if file.startswith("/cf/") else PurePosixPath(file.lstrip("/"))


def _in_folder(file: str, folder: Path) -> Path | None:
    """Return hk.py or the package hk for /cf/hk.so."""
    inside = _inside(file)
    if inside.suffix not in CODE_SUFFIXES:
        return None
    stem = inside.with_suffix("")
    candidates = (folder / stem.with_suffix(".py"), folder / stem / "__init__.py")
    return next((candidate for candidate in candidates if os.path.isfile(candidate)), None)


def _installed(file: str) -> str | None:
    """Return the name of the installed module for a virtual path."""
    inside = _inside(file)
    path = inside.with_suffix("") if inside.suffix in CODE_SUFFIXES else inside
    name = str(path).replace("/", ".")
    if not all(part.isidentifier() for part in name.split(".")):
        return None
    try:
        spec = importlib.util.find_spec(name)
    except (ImportError, ValueError):
        return None
    return name if spec is not None and spec.has_location else None


def _is_changed(found: Path, folder: Path, files: FileSystem) -> bool:
    """Return whether the mission changed or removed a file of its folder; packages are assumed unchanged."""
    if found.name == "__init__.py" or not found.is_relative_to(folder):
        return False
    try:
        node = files.find(f"/cf/{found.relative_to(folder).as_posix()}")
    except OsalError:
        return False  # a ROS node; OSAL refuses such a long name, so the mission cannot have changed it
    return node is None or bytes(node.data) != read_limited(found, PYTHON_BYTES)


class SourceAlone(SourceFileLoader):
    """The import loader of a mission's Python source file, which neither reads nor writes bytecode.

    Bytecode is matched by the size and the second of the last change of the file, so it may belong to an earlier edit.
    """

    def path_stats(self, path: object) -> dict[str, float]:
        """Always fail, so that bytecode is neither read nor written."""
        raise OSError


class VirtualCode(SourceAlone):
    """An import loader of a Python source file that exists only on the virtual file system; tracebacks show its lines.

    Args:
        path: its virtual path.
        source: its bytes.
    """

    def __init__(self, path: str, source: bytes) -> None:
        super().__init__("", path)
        self.source = source

    def get_filename(self, name: str | None = None) -> str:
        """Return the virtual path, for any module name."""
        return str(self.path)

    def get_data(self, path: object) -> bytes:
        """Return the source."""
        return self.source


def find_virtual_code(file: str, files: FileSystem) -> VirtualCode | None:
    """Return the source at a virtual path: x.py for /ram/x.so, otherwise the file itself with any suffix; or None.

    Raises:
        OsalError: if the path is invalid.
    """
    path = PurePosixPath(file)
    for suffix in dict.fromkeys((".py", path.suffix)):
        candidate = str(path.with_suffix(suffix)) if suffix in CODE_SUFFIXES else file
        node = files.find(candidate)
        if node is not None:
            return VirtualCode(candidate, bytes(node.data))
    return None


Found = Path | str | VirtualCode
"""Python code: a source file, the name of an installed module, or a file that the mission itself wrote."""


def execute(found: Found, name: str, modules: AppModules | None = None) -> ModuleType:
    """Execute Python code as a module.

    Args:
        found: the code.
        name: name of the module.
        modules: the replacements for the host's modules; None, and apps included in cfepy, use the host's.

    Raises:
        ImportError: if there is no code to execute.
        BaseException: any error of the code.
    """
    spec = _spec(found, name)
    if spec is None or spec.loader is None:
        raise ImportError(f"{found} cannot be executed")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    if modules is None or _is_shipped(found):
        spec.loader.exec_module(module)
    else:
        modules.execute(module)
    return module


def _is_shipped(found: Found) -> bool:
    return isinstance(found, Path) and found.is_relative_to(shipped("apps"))


def _spec(found: Found, name: str) -> importlib.machinery.ModuleSpec | None:
    if isinstance(found, VirtualCode):
        return importlib.util.spec_from_loader(name, found, origin=found.path)
    if isinstance(found, str):
        installed = importlib.util.find_spec(found)
        if installed is None or installed.origin is None:
            return None
        found = Path(installed.origin)
    inner = [str(found.parent)] if found.name == "__init__.py" else None
    loader = None if _is_shipped(found) else SourceAlone(name, str(found))
    return importlib.util.spec_from_file_location(name, found, loader=loader, submodule_search_locations=inner)


def _fault_of(function: Callable[..., Any]) -> str | None:
    """Return why a function cannot be an entry point, with the remedy, or None."""
    plain = "calling it runs nothing; make it a plain function"
    if inspect.iscoroutinefunction(function) or inspect.isasyncgenfunction(function):
        return f"is async: {plain}"
    if inspect.isgeneratorfunction(function):
        return f"is a generator (it has a yield): {plain}"
    try:
        inspect.signature(function).bind(None)
    except TypeError:
        return f"must take one argument, the handle of the services; write `def {function.__name__}(cfe):`"
    except ValueError:
        return None  # a function in C without a signature
    return None


# -- names of modules --------------------------------------------------------------------------------------------------


class ModuleNames:
    """Names in `sys.modules` for the code of one mission: unique in the process, yet the same in every run.

    They are visible inside a mission (in a traceback, in `__name__`), so they must not contain the address of an
    object. Each mission takes the lowest number that no other living mission has.
    """

    def __init__(self) -> None:
        self._root = ""
        self._number = 0
        self._of: dict[str, str] = {}

    def new(self, owner: str) -> str:
        """Return a name for the module of an application; its earlier module is removed, so that restarts do not
        accumulate.
        """
        if not self._root:
            self._root = _take_root()
        if owner in self._of:
            _take_out({self._of.pop(owner)})
        self._number += 1
        self._of[owner] = name = f"{self._root}_{self._number}"
        return name

    def forget(self) -> None:
        """Remove all modules of the mission from the process."""
        if self._of:
            _take_out(set(self._of.values()))
        self._of.clear()
        sys.modules.pop(self._root, None)
        self._root = ""


def _take_out(names: set[str]) -> None:
    """Remove modules and their submodules from the process in one pass, because it has thousands of modules."""
    ours = [each for each in list(sys.modules) if each.startswith(PREFIX)]
    for each in ours:
        if each.partition(".")[0] in names:
            del sys.modules[each]


def _take_root() -> str:
    mine = ModuleType(PREFIX)  # reserves the name
    return next(root for root in map(f"{PREFIX}{{}}".format, count()) if sys.modules.setdefault(root, mine) is mine)
