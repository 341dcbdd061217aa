"""Finding the code of an application: OS_ModuleLoad for Python.

cFE names a module by a virtual path, /cf/hk.so. What stands behind it is looked for in this order: the mission's folder
(hk.py, or a package hk), the apps that cfepy brings along, an installed Python module of that name, and a file that the
mission itself wrote, which may be on /ram. What it wrote over a file of its folder counts, and what it removed there is
gone. An app is executed anew for every start, so that a restart finds its
variables as a fresh C module would.
"""

from __future__ import annotations

import importlib.util
import inspect
import sys
from collections.abc import Callable, Mapping
from pathlib import Path, PurePosixPath
from types import ModuleType
from typing import Any

from cfepy.console import Console
from cfepy.es import SymbolError
from cfepy.mission.module_names import ModuleNames
from cfepy.mission.tracebacks import app_traceback, described
from cfepy.mission.virtual_code import VirtualCode, find_virtual_code
from cfepy.osal import FileSystem
from cfepy.resources import shipped
from cfepy.rtos import TaskExit
from cfepy.status import OS_ERROR, OsalError

Code = Path | str | VirtualCode
NODE_SYMBOL = "__main__"
CODE_SUFFIXES = ("", ".so", ".py", ".obj", ".o")
NODE_SUFFIX = ".so"  # what ES puts after a name that has no suffix


class ModuleLoader:
    """The loader of one mission.

    Args:
        files: where /cf leads.
        folder: the mission's folder.
        console: for what went wrong while a module was executed.
        handle: what an app's main function gets.
        node_main: gives the main function of a ROS node, by its script and its application's name.
        script_of: the script of a node that has it outside the mission's folder, by virtual path.
        built_in: main functions of applications that have no code on a disk, by virtual path.
    """

    def __init__(
        self,
        files: FileSystem,
        folder: Path,
        console: Console,
        handle: Callable[[], Any],
        node_main: Callable[[Path, str], Callable[[], object]],
        script_of: Callable[[str], Path | None] = lambda file: None,
        built_in: Mapping[str, Callable[[], object]] | None = None,
    ) -> None:
        self._files = files
        self._folder = folder
        self._console = console
        self._handle = handle
        self._node_main = node_main
        self._built_in = built_in or {}
        self._script_of = script_of
        self._names = ModuleNames()
        self._libraries: list[ModuleType] = []

    def exists(self, file: str) -> bool:
        """Whether there is code behind a virtual path."""
        if file in self._built_in or self._script_of(file) is not None:
            return True
        try:
            return self._unchanged(find_node(file, self._folder)) is not None or self.find(file) is not None
        except OsalError:
            return False

    def find(self, file: str) -> Code | None:
        """What stands behind a virtual path: a source file, the name of an installed module, virtual code, or None.

        Raises:
            OsalError: the path itself is no good (OS_TranslatePath).
        """
        self._files.translate(file)
        return self._unchanged(find_code(file, self._folder)) or find_virtual_code(file, self._files)

    def _unchanged(self, found: Code | None) -> Code | None:
        """Code on the host, unless the mission wrote over its file, or removed it."""
        if not isinstance(found, Path) or found.name == "__init__.py" or not found.is_relative_to(self._folder):
            return found
        path = f"/cf/{found.relative_to(self._folder).as_posix()}"
        try:
            node = self._files.find(path)
        except OsalError:
            return found  # a ROS node; OSAL takes no name of this length, so nobody can have changed it
        return found if node is not None and bytes(node.data) == found.read_bytes() else None

    def load(self, file: str, symbol: str, app_name: str) -> Callable[[], object]:
        """The main function of an application, ready to be called without arguments.

        Raises:
            OsalError: there is no such file, or executing it failed (the traceback is on the console).
            SymbolError: it has no such function.
        """
        if file in self._built_in:
            return self._built_in[file]
        if symbol == NODE_SYMBOL:
            script = self._script(file)
            return self._node_main(script, app_name)
        main = self._function(self.load_module(file, app_name), file, symbol)
        return lambda: main(self._handle())

    def load_library(self, file: str, symbol: str) -> Callable[[int], object]:
        """The init function of a library; one that is called NULL does nothing. Errors as `load`."""
        module = self.load_module(file, f"library {file}")
        init = None if symbol == "NULL" else self._function(module, file, symbol)
        return lambda lib_id: self._init_library(module, init)

    def library_symbol(self, name: str) -> object | None:
        """What a name stands for in a library that was loaded, the first one that has it; None when none has it."""
        return next((getattr(module, name) for module in self._libraries if hasattr(module, name)), None)

    def forget(self) -> None:
        """Take the modules of this mission out of the process, with those that they consist of."""
        self._names.forget()

    def _init_library(self, module: ModuleType, init: Callable[[Any], object] | None) -> object:
        """What the init function returns; a negative number when it fails, so that the boot goes on without it."""
        try:
            result = 0 if init is None else init(self._handle())
        except (TaskExit, KeyboardInterrupt):
            raise
        except BaseException as error:
            self._console.write(app_traceback(error))
            return OS_ERROR
        if not isinstance(result, int) or result == 0:  # as ES judges it
            self._libraries.append(module)
        return result

    def _function(self, module: ModuleType, file: str, symbol: str) -> Callable[[Any], object]:
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

    def _script(self, file: str) -> Path:
        found = self._script_of(file) or find_node(file, self._folder)
        if found is None:
            raise self._missing(file)
        return found

    def load_module(self, file: str, owner: str) -> ModuleType:
        """Execute the code behind a virtual path anew, for an application or another owner (OS_ModuleLoad).

        Raises:
            OsalError: there is no such file, or executing it failed (the traceback is on the console).
        """
        found = self.find(file)
        if found is None:
            raise self._missing(file)
        try:
            module = execute(found, self._names.new(owner))
        except (TaskExit, KeyboardInterrupt):
            raise
        except BaseException as error:  # also sys.exit(): it is the module that ends, not the process
            self._console.write(app_traceback(error))
            raise OsalError(OS_ERROR, f"{file}: {described(error)}") from error
        if module is None:
            raise self._missing(file)
        return module

    def _missing(self, file: str) -> OsalError:
        name = _stem(file)
        text = f"OS_ModuleLoad: no {name}.py and no package {name} in the mission's folder, no app or module {name}"
        self._console.write(text)
        return OsalError(OS_ERROR, text)


def find_code(file: str, folder: Path) -> Path | str | None:
    """What stands behind a virtual path below /cf; see the module's text."""
    inside = PurePosixPath(file).relative_to("/cf") if file.startswith("/cf/") else PurePosixPath(file.lstrip("/"))
    if inside.suffix not in CODE_SUFFIXES:
        return _installed(str(inside).replace("/", "."))
    stem = inside.with_suffix("")
    for root in (folder, shipped("apps")):
        for candidate in (root / stem.with_suffix(".py"), root / stem / "__init__.py"):
            if candidate.is_file():
                return candidate
    return _installed(str(stem).replace("/", "."))


def execute(found: Code, name: str) -> ModuleType | None:
    """Execute what `find_code` found, as a module of this name; None when there is nothing to execute.

    Raises:
        BaseException: whatever the code raises.
    """
    spec = _spec(found, name)
    if spec is None or spec.loader is None:
        return None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def find_node(file: str, folder: Path) -> Path | None:
    """The script of a ROS node behind a virtual path below /cf: a file x, as ROS scripts are often called, or x.py.

    OSAL never opens it, so OSAL's limits for file names do not hold for it; it must be below /cf all the same.
    """
    if ".." in file:
        return None
    plain = folder / file.removeprefix("/cf/").removesuffix(NODE_SUFFIX)
    if plain.is_file():
        return plain
    found = find_code(file, folder)
    return found if isinstance(found, Path) else None


def _installed(name: str) -> str | None:
    if not all(part.isidentifier() for part in name.split(".")):
        return None
    try:
        spec = importlib.util.find_spec(name)
    except (ImportError, ValueError):
        return None
    return name if spec is not None and spec.has_location else None


def _spec(found: Code, name: str) -> importlib.machinery.ModuleSpec | None:
    if isinstance(found, VirtualCode):
        return importlib.util.spec_from_loader(name, found, origin=found.path)
    if isinstance(found, str):
        installed = importlib.util.find_spec(found)
        if installed is None or installed.origin is None:
            return None
        found = Path(installed.origin)
    inner = [str(found.parent)] if found.name == "__init__.py" else None
    return importlib.util.spec_from_file_location(name, found, submodule_search_locations=inner)


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
        return f"does not take one argument, the handle of the services; write `def {function.__name__}(cfe):`"
    except ValueError:
        return None  # a function of C that does not tell
    return None


def _stem(file: str) -> str:
    return PurePosixPath(file).stem
