"""OSAL's loader (osapi-module.h): modules of code by id and name, and their symbols.

Code is Python here, and the mission provides it. The mission sets `modules` to a loader, which turns a virtual path
into an object with the symbols as attributes.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from cfepy.ids import OS_MODULE_BASE
from cfepy.osal.core import Core, OsObject, OsObjectTable, Setup
from cfepy.osal.filesystem import FileSystem
from cfepy.osal.limits import OS_MODULE_FLAG_GLOBAL_SYMBOLS, OS_MODULE_FLAG_LOCAL_SYMBOLS
from cfepy.status import OS_ERR_NOT_IMPLEMENTED, OS_ERROR, OsalError


class CodeSource(Protocol):
    """A loader that finds and executes code."""

    def load_module(self, file: str, owner: str) -> object:
        """Execute the code at a virtual path anew, and return an object with its symbols.

        Raises:
            OsalError: if there is no code, or its execution failed.
        """

    def library_symbol(self, name: str) -> object | None:
        """Return the object of a name in a library that ES loaded, or None if no library has the name."""


class ModuleAddress(NamedTuple):
    """The memory addresses of a module (OS_module_address_t); never valid here."""

    valid: bool = False
    flags: int = 0
    code_address: int = 0
    code_size: int = 0
    data_address: int = 0
    data_size: int = 0
    bss_address: int = 0
    bss_size: int = 0


class ModuleInfo(NamedTuple):
    """The result of `module_info` (OS_module_prop_t)."""

    name: str
    filename: str
    entry_point: int = 0
    host_module_id: int = 0
    addr: ModuleAddress = ModuleAddress()


class OsModule(OsObject):
    """The record of a module."""

    __slots__ = ("code", "filename", "flags")

    def __init__(self, name: str, filename: str, flags: int) -> None:
        super().__init__(name)
        self.filename = filename
        self.flags = flags
        self.code: object = None


class ModuleApi(Core):
    """The OS_Module* and OS_Symbol* functions; `modules` is the loader of code, or None."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self.modules: CodeSource | None = None
        self._paths: FileSystem = setup.files
        self._modules: OsObjectTable[OsModule] = self._table("module", OS_MODULE_BASE, setup.config.os_max_modules)

    def module_load(self, module_name: str, filename: str, flags: int = OS_MODULE_FLAG_GLOBAL_SYMBOLS) -> int:
        """Load code (OS_ModuleLoad).

        Args:
            module_name: unique among modules, at most 19 characters.
            filename: virtual path, e.g. "/cf/hk.so".
            flags: OS_MODULE_FLAG_GLOBAL_SYMBOLS or OS_MODULE_FLAG_LOCAL_SYMBOLS; no effect, because Python modules do
                not share their names.

        Returns:
            The module's id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN, OS_ERR_NO_FREE_IDS, OS_FS_ERR_* for the path, OS_ERROR
                if the code does not exist or its execution failed, OS_ERR_NOT_IMPLEMENTED without a loader.
        """
        record = OsModule(module_name, filename, flags)
        module_id = self._register(self._modules, record, "module", 0)
        try:
            self._paths.translate(filename)
            if self.modules is None:
                raise OsalError(OS_ERR_NOT_IMPLEMENTED, "code cannot be loaded on this system")
            record.code = self.modules.load_module(filename, f"module {module_name}")
        except BaseException:
            self._unregister(self._modules, record)
            raise
        return module_id

    def module_reserve(self, module_name: str, filename: str) -> int:
        """Take a place among the modules for code that ES loads itself, as its call of OS_ModuleLoad does.

        Args:
            module_name: name of the application or library.
            filename: virtual path of its code.

        Returns:
            The module's id.

        Raises:
            OsalError: OS_ERR_NAME_TAKEN, or OS_ERR_NO_FREE_IDS.
        """
        return self._reserve(self._modules, OsModule(module_name, filename, OS_MODULE_FLAG_LOCAL_SYMBOLS)).id

    def module_unload(self, module_id: int) -> None:
        """Forget a module (OS_ModuleUnload); objects taken from it stay usable. It raises OS_ERR_INVALID_ID."""
        self._unregister(self._modules, self._module(module_id))

    def module_code(self, module_id: int) -> object:
        """Return the loaded object, which has the module's symbols. It raises OS_ERR_INVALID_ID."""
        return self._module(module_id).code

    def module_info(self, module_id: int) -> ModuleInfo:
        """Return facts about a module (OS_ModuleInfo), or OS_ERR_INVALID_ID."""
        record = self._module(module_id)
        return ModuleInfo(record.name, record.filename)

    def module_symbol_lookup(self, module_id: int, symbol_name: str) -> Any:
        """Return the object of a name in a module, usually a function (OS_ModuleSymbolLookup).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERROR if the module does not have the name.
        """
        record = self._module(module_id)
        if not hasattr(record.code, symbol_name):
            raise OsalError(OS_ERROR, f"module {record.name} has no symbol {symbol_name}")
        return getattr(record.code, symbol_name)

    def symbol_lookup(self, symbol_name: str) -> Any:
        """Return the object of a name in the first module or library that has it (OS_SymbolLookup).

        Raises:
            OsalError: OS_ERROR if none has it.
        """
        for record in self._modules:
            if record.code is not None and hasattr(record.code, symbol_name):
                return getattr(record.code, symbol_name)
        found = self.modules.library_symbol(symbol_name) if self.modules is not None else None
        if found is not None:
            return found
        raise OsalError(OS_ERROR, f"unknown symbol {symbol_name}")

    def symbol_table_dump(self, filename: str, size_limit: int) -> None:
        """Refuse to write all symbols to a file (OS_SymbolTableDump), because symbols have no addresses.

        Raises:
            OsalError: OS_FS_ERR_* for the path, otherwise OS_ERR_NOT_IMPLEMENTED, as on NASA's Linux.
        """
        self._paths.translate(filename)
        raise OsalError(OS_ERR_NOT_IMPLEMENTED, "symbols have no addresses in the simulation")

    def _module(self, module_id: int) -> OsModule:
        record = self._modules.lookup(module_id)
        if record is None:
            raise self._modules.missing(module_id)
        return record
