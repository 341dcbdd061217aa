"""Compiled code for ES and OSAL: applications, libraries and modules from shared objects."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.es import SymbolError
from cfepy.extra.c.abi import abi_profile
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.elf import ElfError, SharedObject, read_shared_object
from cfepy.extra.c.image import Image, LoadedCode
from cfepy.extra.c.linking import undefined_on_linux
from cfepy.extra.c.runtime import CRuntime
from cfepy.status import OS_ERROR, OsalError
from cfepy.writing.console import Console

NO_SYMBOL = "NULL"
NODE_MARK = "roscfe_node"
"""The symbol that marks a ROS node; the convertor's wrapper defines it."""


class CompiledLoader:
    """Loads shared objects for one processor.

    Args:
        runtime: the C side of the processor.
        console: for messages about load errors and undefined symbols.
        on_node: called before an application runs that is a ROS node.
    """

    def __init__(self, runtime: CRuntime, console: Console, on_node: Callable[[], object]) -> None:
        self.runtime = runtime
        self.on_node = on_node
        self._console = console
        self._read: dict[bytes, SharedObject] = {}

    def code(self, file: str, data: bytes) -> CompiledCode:
        """Return the code in a shared object, not loaded yet.

        Args:
            file: its virtual path.
            data: its bytes.
        """
        return CompiledCode(self, file, data)

    def read(self, file: str, data: bytes) -> SharedObject:
        """Read a shared object. Errors also go to the console.

        Raises:
            OsalError: it cannot be loaded.
        """
        try:
            if data not in self._read:
                self._read[data] = read_shared_object(data, file)
        except ElfError as error:
            raise self._failed(error) from error
        return self._read[data]

    def load(self, file: str, data: bytes) -> Image:
        """Load a shared object, or open the one of the same file that is in memory, as dlopen does on Linux.

        In a safe mission each opening has its own variables. It raises the errors of `read`.
        """
        source = self.read(file, data)
        there = None if self.runtime.handle.os.config.safe else self.runtime.openings.of_file(file, data)
        return self._new(file, source) if there is None else self._again(file, there)

    def _again(self, file: str, image: Image) -> Image:
        self.runtime.openings.again(image)
        self._console.write(f"OS_ModuleLoad: {file} is in memory already, and keeps its variables")
        return image

    def _new(self, file: str, source: SharedObject) -> Image:
        try:
            missing = self.runtime.missing(source)
            nowhere = undefined_on_linux(source, missing)
            if nowhere:
                raise ElfError(f"Error loading shared library: {file}: undefined symbol: {', '.join(nowhere)}")
            if missing:
                self._console.write(f"OS_ModuleLoad: {file} has undefined symbols: {', '.join(missing)}")
            profile = abi_profile(source)
            if profile.contradicts(self.runtime.omit_deprecated):
                self._console.write(
                    f"OS_ModuleLoad: {file} was built {profile.value}, but the mission specifies otherwise"
                )
            image = self.runtime.load(file, source)
            if image.replaced:
                names = ", ".join(sorted(image.replaced))
                self._console.write(f"OS_ModuleLoad: {file} uses {names} of a library in place of its own")
            return image
        except (ElfError, MemoryError) as error:
            raise self._failed(error) from error
        except CFault as error:
            raise self._failed(CFault(f"{file}: {error}")) from error

    def load_application(self, file: str, data: bytes, app_name: str) -> Image:
        """Load an application, as `load` does. Two applications from one file share its variables.

        A ROS node has its own, because it is a process of its own on a robot. It raises the errors of `read`.
        """
        source = self.read(file, data)
        if any(each.name == NODE_MARK and each.is_defined for each in source.symbols):
            return self._new(file, source)
        image = self.load(file, data)
        others = [name for name, each in self.runtime.applications.items() if each is image]
        if others:
            self._console.write(
                f"OS_ModuleLoad: {file} is in use: {app_name} shares the variables of {', '.join(others)}"
            )
        return image

    def symbol(self, image: Image, file: str, symbol: str) -> int:
        """Return the address of an entry point.

        Raises:
            SymbolError: there is none of that name. The image is closed.
        """
        address = image.symbols.get(symbol)
        if address is None:
            self.runtime.close_image(image)
            self._console.write(f"OS_SymbolLookup: {file} has no function {symbol}")
            raise SymbolError(OS_ERROR, symbol)
        return address

    def _failed(self, error: Exception) -> OsalError:
        self._console.write(f"OS_ModuleLoad: {error}")
        return OsalError(OS_ERROR, str(error))


class CompiledCode:
    """Compiled code; see `cfepy.mission.loader.Code`.

    Args:
        loader: loads it.
        file: its virtual path.
        data: its bytes.
    """

    def __init__(self, loader: CompiledLoader, file: str, data: bytes) -> None:
        self._loader = loader
        self._file = file
        self._data = data

    def main(self, symbol: str, app_name: str) -> Callable[[], object]:
        runtime = self._loader.runtime
        image = self._loader.load_application(self._file, self._data, app_name)
        function = self._loader.symbol(image, self._file, symbol)
        runtime.applications[app_name] = image
        if NODE_MARK in image.symbols:
            self._loader.on_node()

        def run() -> None:
            runtime.run_main(function)
            os = runtime.handle.os
            if not os.config.safe:
                os.task_exit()  # ES does not notice that the function has returned

        return run

    def library(self, symbol: str) -> tuple[object, Callable[[int], object]]:
        """Load a library. Its init function gets the LibId."""
        runtime = self._loader.runtime
        image = self._loader.load(self._file, self._data)
        function = 0 if symbol == NO_SYMBOL else self._loader.symbol(image, self._file, symbol)

        def init(lib_id: int) -> int:
            runtime.libraries[self._file] = image  # its own functions may be wanted while it is initialised
            status = runtime.status(function, lib_id) if function else 0
            if status:
                runtime.close_image(image)
                if image not in runtime.images():
                    del runtime.libraries[self._file]
            return status

        return LoadedCode(image), init

    def module(self, owner: str) -> object:
        return LoadedCode(self._loader.load(self._file, self._data))
