"""Python code of applications, libraries and ROS nodes: where it is found, and how it is executed.

What stands behind /cf/hk.so is looked for in this order: the mission's folder (hk.py, or a package hk), the apps that
cfepy brings along, an installed Python module of that name, and a file that the mission itself wrote, which may be on
/ram. What it wrote over a file of its folder counts, and what it removed there is gone. An app is executed anew for
every start, so that a restart finds its variables as a fresh C module would.
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

from cfepy.es import SymbolError
from cfepy.mission.compiled_code import find_compiled
from cfepy.mission.loader import NO_SYMBOL, NODE_SYMBOL, Code, Finder, MainCode, RemovedCodeError
from cfepy.nodes import AppModules
from cfepy.osal import FileSystem
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import PYTHON_BYTES
from cfepy.reading.resources import shipped
from cfepy.rtos import TaskExit
from cfepy.status import OS_ERROR, OsalError
from cfepy.writing.console import Console

CODE_SUFFIXES = ("", ".so", ".py", ".obj", ".o")
NODE_SUFFIX = ".so"  # what ES puts after a name that has no suffix
PREFIX = "cfepy_app_"


# -- nodes -------------------------------------------------------------------------------------------------------------


class NodeScripts(Finder):
    """Scripts of ROS nodes: applications whose entry point is `__main__`.

    Args:
        files: where /cf leads.
        folder: the mission's folder.
        script_of: the script of a node that has it outside the folder, by virtual path.
        node_main: gives the main function of a node, by its script and its application's name.
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
        """A script that the mission changed or removed is none."""
        if self._script_of(file) is not None:
            return True
        script = find_node(file, self._folder)
        return script is not None and not _is_changed(script, self._folder, self._files)

    def forget(self) -> None:
        """There is nothing to let go of."""


def find_node(file: str, folder: Path) -> Path | None:
    """The script of a ROS node behind a virtual path below /cf: a file x, as ROS scripts are often called, or x.py.

    OSAL never opens it, so OSAL's limits for file names do not hold for it; it must be below /cf all the same.
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
        console: for what goes wrong while a module is executed.
        handle: gives what the main function of an app gets.
        modules: what the code has in place of the host's modules.
    """

    def __init__(self, console: Console, handle: Callable[[], Any], modules: AppModules) -> None:
        self.handle = handle
        self.names = ModuleNames()
        self._modules = modules
        self._console = console

    def module(self, file: str, found: Found, owner: str) -> ModuleType:
        """Execute code as a new module; errors as `ModuleLoader.load_module`."""
        try:
            return execute(found, self.names.new(owner), self._modules)
        except (TaskExit, KeyboardInterrupt):
            raise
        except BaseException as error:  # also sys.exit(): it is the module that ends, not the process
            from cfepy.mission.tracebacks import app_traceback, described

            self._console.write(app_traceback(error))
            raise OsalError(OS_ERROR, f"{file}: {described(error)}") from error

    def forget(self) -> None:
        """Let go of the code and of what it has open."""
        self.names.forget()
        self._modules.close()

    def function(self, module: ModuleType, file: str, symbol: str) -> Callable[[Any], object]:
        """An entry point; errors as `ModuleLoader.load`."""
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
    """Python code: see `Code`.

    Args:
        python: what executes it.
        file: its virtual path, as it was asked for.
        found: what stands behind that.
    """

    def __init__(self, python: PythonLoader, file: str, found: Found) -> None:
        self._python = python
        self._file = file
        self._found = found

    def main(self, symbol: str, app_name: str) -> Callable[[], object]:
        """The function is called with the handle of the services."""
        main, handle = self._python.function(self.module(app_name), self._file, symbol), self._python.handle
        return lambda: main(handle())

    def library(self, symbol: str) -> tuple[ModuleType, Callable[[int], object]]:
        """The init function gets the handle of the services, and not the LibId."""
        module, handle = self.module(f"library {self._file}"), self._python.handle
        if symbol == NO_SYMBOL:
            return module, lambda lib_id: 0
        init = self._python.function(module, self._file, symbol)
        return module, lambda lib_id: init(handle())

    def module(self, owner: str) -> ModuleType:
        return self._python.module(self._file, self._found, owner)


class PythonFinder(ABC):
    """Finds Python code of applications and libraries; nodes are none.

    Args:
        python: what executes it.
    """

    def __init__(self, python: PythonLoader) -> None:
        self._python = python

    def find(self, file: str, symbol: str | None) -> Code | None:
        found = None if symbol == NODE_SYMBOL else self.look(file)
        return None if found is None else PythonCode(self._python, file, found)

    def exists(self, file: str) -> bool:
        return self.look(file) is not None

    def unload(self, app_name: str) -> None:
        """The module goes when the application starts again."""
        return

    def forget(self) -> None:
        self._python.forget()

    @abstractmethod
    def look(self, file: str) -> Found | None:
        """What stands behind a virtual path; errors as `find`."""


class MissionFolder(PythonFinder):
    """The folder of the mission, with what the mission itself wrote over its files.

    Args:
        python: what executes the code.
        files: where /cf leads.
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
    """The apps that cfepy brings along."""

    def look(self, file: str) -> Found | None:
        return _in_folder(file, shipped("apps"))


class InstalledModules(PythonFinder):
    """Python modules that are installed on the host."""

    def look(self, file: str) -> Found | None:
        return _installed(file)


class WrittenFiles(PythonFinder):
    """Files that the mission itself wrote, or got from the ground.

    Args:
        python: what executes the code.
        files: of the mission.
    """

    def __init__(self, python: PythonLoader, files: FileSystem) -> None:
        super().__init__(python)
        self._files = files

    def look(self, file: str) -> Found | None:
        return find_virtual_code(file, self._files)


def python_finders(python: PythonLoader, files: FileSystem, folder: Path) -> list[Finder]:
    """The finders of Python code, in their order; arguments as those of `MissionFolder`."""
    return [
        MissionFolder(python, files, folder),
        ShippedApps(python),
        InstalledModules(python),
        WrittenFiles(python, files),
    ]


def find_code(file: str, folder: Path) -> Path | str | None:
    """The Python code on the host behind a virtual path below /cf, for tools that look at a mission from outside.

    Args:
        file: the virtual path.
        folder: the mission's folder.

    Returns:
        A source file, or the name of an installed module; None where compiled code is.
    """
    return None if find_compiled(file, folder) is not None else find_declarations(file, folder)


def find_declarations(file: str, folder: Path) -> Path | str | None:
    """As `find_code`, for tools that want the names and packets that Python code declares: for compiled code, those of
    the Python application that goes by its name, such as one that cfepy brings along.
    """
    return _in_folder(file, folder) or _in_folder(file, shipped("apps")) or _installed(file)


def _inside(file: str) -> PurePosixPath:
    """A virtual path below /cf, seen from there."""
    return PurePosixPath(file).relative_to("/cf") if file.startswith("/cf/") else PurePosixPath(file.lstrip("/"))


def _in_folder(file: str, folder: Path) -> Path | None:
    """hk.py or the package hk for /cf/hk.so."""
    inside = _inside(file)
    if inside.suffix not in CODE_SUFFIXES:
        return None
    stem = inside.with_suffix("")
    candidates = (folder / stem.with_suffix(".py"), folder / stem / "__init__.py")
    return next((candidate for candidate in candidates if os.path.isfile(candidate)), None)


def _installed(file: str) -> str | None:
    """The name of the installed module that a virtual path names."""
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
    """Whether the mission wrote over a file of its folder, or removed it; packages are taken as they are."""
    if found.name == "__init__.py" or not found.is_relative_to(folder):
        return False
    try:
        node = files.find(f"/cf/{found.relative_to(folder).as_posix()}")
    except OsalError:
        return False  # a ROS node; OSAL takes no name of this length, so the mission cannot have changed it
    return node is None or bytes(node.data) != read_limited(found, PYTHON_BYTES)


class SourceAlone(SourceFileLoader):
    """The import loader of a mission's Python source file, which neither reads nor writes bytecode.

    Bytecode goes by the second of the file's last change and its size, so it may be that of the edit before.
    """

    def path_stats(self, path: object) -> dict[str, float]:
        """Fail always, so that no bytecode is looked for or written."""
        raise OSError


class VirtualCode(SourceAlone):
    """A Python source file that is on the virtual file system alone, as an import loader; tracebacks show its lines.

    Args:
        path: its virtual path.
        source: its bytes.
    """

    def __init__(self, path: str, source: bytes) -> None:
        super().__init__("", path)
        self.source = source

    def get_filename(self, name: str | None = None) -> str:
        """The virtual path, whatever the module is called."""
        return str(self.path)

    def get_data(self, path: object) -> bytes:
        """The source."""
        return self.source


def find_virtual_code(file: str, files: FileSystem) -> VirtualCode | None:
    """The source behind a virtual path: x.py for /ram/x.so, else the file itself, whatever its suffix; or None.

    Raises:
        OsalError: the path is no good.
    """
    path = PurePosixPath(file)
    for suffix in dict.fromkeys((".py", path.suffix)):
        candidate = str(path.with_suffix(suffix)) if suffix in CODE_SUFFIXES else file
        node = files.find(candidate)
        if node is not None:
            return VirtualCode(candidate, bytes(node.data))
    return None


Found = Path | str | VirtualCode
"""Python code: a source file, the name of an installed module, or what the mission itself wrote."""


def execute(found: Found, name: str, modules: AppModules | None = None) -> ModuleType:
    """Execute Python code as a module of this name.

    Args:
        found: what is executed.
        name: of the module.
        modules: what it has in place of the host's; None, and the apps that cfepy brings along: nothing.

    Raises:
        ImportError: there is nothing to execute.
        BaseException: whatever the code raises.
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
    """Why a function cannot be an entry point, and what to do; None when it can."""
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
        return None  # a function of C that does not tell
    return None


# -- names of modules --------------------------------------------------------------------------------------------------


class ModuleNames:
    """Names in `sys.modules` for the code of one mission: unique in the process, yet the same in every run.

    They can be seen from inside a mission (in a traceback, in `__name__`), so no address of an object may be in them:
    each mission takes the lowest number that no other living mission has.
    """

    def __init__(self) -> None:
        self._root = ""
        self._number = 0
        self._of: dict[str, str] = {}

    def new(self, owner: str) -> str:
        """A name for the module of an application; the one it had before goes, so that restarts pile up nothing."""
        if not self._root:
            self._root = _take_root()
        if owner in self._of:
            _take_out({self._of.pop(owner)})
        self._number += 1
        self._of[owner] = name = f"{self._root}_{self._number}"
        return name

    def forget(self) -> None:
        """Take all modules of the mission out of the process."""
        if self._of:
            _take_out(set(self._of.values()))
        self._of.clear()
        sys.modules.pop(self._root, None)
        self._root = ""


def _take_out(names: set[str]) -> None:
    """Take modules, and those that they consist of, out of the process: in one pass, since it has thousands."""
    ours = [each for each in list(sys.modules) if each.startswith(PREFIX)]
    for each in ours:
        if each.partition(".")[0] in names:
            del sys.modules[each]


def _take_root() -> str:
    mine = ModuleType(PREFIX)  # holds the place
    return next(root for root in map(f"{PREFIX}{{}}".format, count()) if sys.modules.setdefault(root, mine) is mine)
