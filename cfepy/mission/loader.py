"""The loader that ES and OSAL ask for code (OS_ModuleLoad): it asks finders in order, each of which knows one kind.

cFE names code by a virtual path, /cf/hk.so. The processor says which finders there are: `BuiltInApps` below, and those
of ROS nodes and of Python code (`cfepy.mission.python_code`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import PurePosixPath
from typing import Protocol

from cfepy.rtos import TaskExit
from cfepy.status import OS_ERROR, OsalError
from cfepy.writing.console import Console

NODE_SYMBOL = "__main__"
NO_SYMBOL = "NULL"
"""The entry point of a library that has none."""


class Code(Protocol):
    """Code behind a virtual path, found and not loaded yet."""

    def main(self, symbol: str, app_name: str) -> Callable[[], object]:
        """The main function of an application; errors as `ModuleLoader.load`."""

    def library(self, symbol: str) -> tuple[object, Callable[[int], object]]:
        """A library, loaded anew: what has its symbols as attributes, and its init function, which gets the LibId."""

    def module(self, owner: str) -> object:
        """Load it anew for an owner: what has its symbols as attributes."""


class Finder(Protocol):
    """Finds one kind of code by its virtual path."""

    def find(self, file: str, symbol: str | None) -> Code | None:
        """The code behind a virtual path, None when this finder knows of none.

        Args:
            file: the virtual path.
            symbol: the entry point of the application that is to start; None for a library or another module.

        Raises:
            OsalError: the path is no good.
            RemovedCodeError: there was code, and the mission removed it; no other finder is to be asked.
        """

    def exists(self, file: str) -> bool:
        """Whether there is code behind a virtual path, whatever its entry point is; errors as `find`."""

    def unload(self, app_name: str) -> None:
        """An application has ended: let go of its code, where that takes more than forgetting it."""
        return

    def forget(self) -> None:
        """The processor is at its end: let go of what was loaded."""


class RemovedCodeError(LookupError):
    """The mission removed the code that its folder had."""


class ModuleLoader:
    """The loader of one processor.

    Args:
        console: for what is missing, and for what goes wrong in the init function of a library.
        finders: what is asked for code, in this order.
    """

    def __init__(self, console: Console, finders: Sequence[Finder]) -> None:
        self._console = console
        self._finders = tuple(finders)
        self._libraries: list[object] = []

    def exists(self, file: str) -> bool:
        """Whether there is code behind a virtual path."""
        try:
            return any(finder.exists(file) for finder in self._finders)
        except (OsalError, RemovedCodeError):
            return False

    def load(self, file: str, symbol: str, app_name: str) -> Callable[[], object]:
        """The main function of an application, ready to be called without arguments.

        Raises:
            OsalError: there is no such file, or executing it failed (the traceback is on the console).
            SymbolError: it has no such function.
        """
        return self._find(file, symbol).main(symbol, app_name)

    def load_library(self, file: str, symbol: str) -> Callable[[int], object]:
        """The init function of a library; one that is called NULL does nothing. Errors as `load`."""
        library, init = self._find(file, None).library(symbol)
        return lambda lib_id: self._init_library(library, init, lib_id)

    def load_module(self, file: str, owner: str) -> object:
        """Execute the code behind a virtual path anew, for another owner than an application (OS_ModuleLoad).

        Raises:
            OsalError: there is no such file, or executing it failed (the traceback is on the console).
        """
        return self._find(file, None).module(owner)

    def unload(self, app_name: str) -> None:
        """An application has ended: its code may go."""
        for finder in self._finders:
            finder.unload(app_name)

    def library_symbol(self, name: str) -> object | None:
        """What a name stands for in a library that was loaded, the first one that has it; None when none has it."""
        return next((getattr(library, name) for library in self._libraries if hasattr(library, name)), None)

    def forget(self) -> None:
        """Take the modules of this mission out of the process, with those that they consist of."""
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
        text = (
            f"OS_ModuleLoad: found no {name}.py and no package {name} in the "
            f"mission's folder, and no app or module {name}"
        )
        self._console.write(text)
        raise OsalError(OS_ERROR, text)

    def _init_library(self, library: object, init: Callable[[int], object], lib_id: int) -> object:
        """What the init function returns; a negative number when it fails, so that the boot goes on without it."""
        try:
            result = init(lib_id)
        except (TaskExit, KeyboardInterrupt):
            raise
        except BaseException as error:
            from cfepy.mission.tracebacks import app_traceback

            self._console.write(app_traceback(error))
            return OS_ERROR
        if not isinstance(result, int) or result == 0:  # as ES judges it
            self._libraries.append(library)
        return result


class MainCode:
    """An application that is a main function, and no module."""

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
    """Applications that have no code on a disk.

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
        """There is nothing to let go of."""
