"""The loader of code for ES and OSAL (OS_ModuleLoad): it asks finders in order, one for each kind of code.

cFE names code by a virtual path, /cf/hk.so. The processor sets the finders: `BuiltInApps` below, and those for ROS
nodes and Python code (`cfepy.mission.python_code`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import PurePosixPath
from typing import Protocol

from cfepy.rtos import TaskExit
from cfepy.status import OS_ERROR, OsalError
from cfepy.writing.console import Console

NO_SYMBOL = "NULL"
"""The entry point of a library without one."""


class Code(Protocol):
    """Code at a virtual path that was found but not loaded yet."""

    def main(self, symbol: str, app_name: str) -> Callable[[], object]:
        """Return the main function of an application; see `ModuleLoader.load` for the errors."""

    def library(self, symbol: str) -> tuple[object, Callable[[int], object]]:
        """Load a library anew; return an object with its symbols as attributes, and its init function, which gets the
        LibId.
        """

    def module(self, owner: str) -> object:
        """Load the code anew for an owner; return an object with its symbols as attributes."""


class Finder(Protocol):
    """Finds one kind of code by its virtual path."""

    def find(self, file: str, symbol: str | None) -> Code | None:
        """Return the code behind a virtual path, or None if this finder has none.

        Args:
            file: the virtual path.
            symbol: the entry point of the application to start; None for a library or another module.

        Raises:
            OsalError: if the path is invalid.
            RemovedCodeError: if the mission removed the code; no other finder may be asked.
        """

    def exists(self, file: str) -> bool:
        """Return whether there is code at a virtual path, with any entry point; see `find` for the errors."""

    def unload(self, app_name: str) -> None:
        """Release the code of an ended application, if that needs any work."""
        return

    def forget(self) -> None:
        """Release all loaded code at the end of the processor."""


class RemovedCodeError(LookupError):
    """Exception for code that the mission removed from its folder."""


class ModuleLoader:
    """The loader of one processor.

    Args:
        console: for missing code and errors in the init function of a library.
        finders: the finders, in the order of the search.
    """

    def __init__(self, console: Console, finders: Sequence[Finder]) -> None:
        self._console = console
        self._finders = tuple(finders)
        self._libraries: list[object] = []

    def exists(self, file: str) -> bool:
        """Return whether there is code at a virtual path."""
        try:
            return any(finder.exists(file) for finder in self._finders)
        except (OsalError, RemovedCodeError):
            return False

    def load(self, file: str, symbol: str, app_name: str) -> Callable[[], object]:
        """Return the main function of an application, ready to be called without arguments.

        Raises:
            OsalError: if the file does not exist or its execution failed (the traceback is on the console).
            SymbolError: if it has no such function.
        """
        return self._find(file, symbol).main(symbol, app_name)

    def load_library(self, file: str, symbol: str) -> Callable[[int], object]:
        """Return the init function of a library; the name NULL gives a function that does nothing. See `load` for the
        errors.
        """
        library, init = self._find(file, None).library(symbol)
        return lambda lib_id: self._init_library(library, init, lib_id)

    def load_module(self, file: str, owner: str) -> object:
        """Execute the code at a virtual path anew, for an owner other than an application (OS_ModuleLoad).

        Raises:
            OsalError: if the file does not exist or its execution failed (the traceback is on the console).
        """
        return self._find(file, None).module(owner)

    def unload(self, app_name: str) -> None:
        """Release the code of an ended application."""
        for finder in self._finders:
            finder.unload(app_name)

    def library_symbol(self, name: str) -> object | None:
        """Return the object of a name in the first loaded library that has it, or None."""
        return next((getattr(library, name) for library in self._libraries if hasattr(library, name)), None)

    def forget(self) -> None:
        """Remove the modules of this mission, and their submodules, from the process."""
        for finder in self._finders:
            finder.forget()

    def _find(self, file: str, symbol: str | None) -> Code:
        try:
            for finder in self._finders:
                found = finder.find(file, symbol)
                if found is not None:
                    return found
        except RemovedCodeError:
            pass
        name = PurePosixPath(file).stem
        # The console is in the trace: a change of this text changes the digests of runs.
        text = f"OS_ModuleLoad: no {name}.py and no package {name} in the mission's folder, no app or module {name}"
        self._console.write(text)
        raise OsalError(OS_ERROR, text)

    def _init_library(self, library: object, init: Callable[[int], object], lib_id: int) -> object:
        """Call an init function and return its result; return a negative number for an error, so that the boot
        continues.
        """
        try:
            result = init(lib_id)
        except (TaskExit, KeyboardInterrupt):
            raise
        except BaseException as error:
            from cfepy.mission.tracebacks import app_traceback

            self._console.write(app_traceback(error))
            return OS_ERROR
        if not isinstance(result, int) or result == 0:  # as ES interprets it
            self._libraries.append(library)
        return result


class MainCode:
    """An application that is a main function without a module."""

    def __init__(self, file: str, make_main: Callable[[str], Callable[[], object]]) -> None:
        self._file = file
        self._make_main = make_main

    def main(self, symbol: str, app_name: str) -> Callable[[], object]:
        return self._make_main(app_name)

    def library(self, symbol: str) -> tuple[object, Callable[[int], object]]:
        raise self._no_module()

    def module(self, owner: str) -> object:
        raise self._no_module()

    def _no_module(self) -> OsalError:
        return OsalError(OS_ERROR, f"{self._file} is an application, not a module")


class BuiltInApps(Finder):
    """Applications without code on a disk.

    Args:
        mains: their main functions, by virtual path.
    """

    def __init__(self, mains: Mapping[str, Callable[[], object]]) -> None:
        self._mains = mains

    def find(self, file: str, symbol: str | None) -> Code | None:
        main = None if symbol is None else self._mains.get(file)
        return None if main is None else MainCode(file, lambda app_name: main)

    def exists(self, file: str) -> bool:
        return file in self._mains

    def forget(self) -> None:
        """Do nothing: there is no code to release."""
