"""OSAL's loader (osapi-module.h): modules of code by id and name, and the symbols in them.

Code is Python here, and the mission finds it: it plugs in as `modules` a loader that turns a virtual path into an
object whose attributes are the symbols.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from cfepy.ids import OS_MODULE_BASE
from cfepy.osal.core import Core, OsObject, OsObjectTable, Setup
from cfepy.osal.filesystem import FileSystem
from cfepy.osal.limits import OS_MAX_MODULES, OS_MODULE_FLAG_GLOBAL_SYMBOLS
from cfepy.status import OS_ERR_NOT_IMPLEMENTED, OS_ERROR, OsalError


class CodeSource(Protocol):
    """What finds and executes code."""

    def load_module(self, file: str, owner: str) -> object:
        """Execute the code behind a virtual path anew, and give an object with its symbols.

        Raises:
            OsalError: there is none, or executing it failed.
        """

    def library_symbol(self, name: str) -> object | None:
        """What a name stands for in a library that ES loaded; None when none has it."""


class ModuleAddress(NamedTuple):
    """Where a module lies in memory (OS_module_address_t): nowhere, as `valid` says."""

    valid: bool = False
    flags: int = 0
    code_address: int = 0
    code_size: int = 0
    data_address: int = 0
    data_size: int = 0
    bss_address: int = 0
    bss_size: int = 0


class ModuleInfo(NamedTuple):
    """What `module_info` tells (OS_module_prop_t)."""

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
    """The OS_Module* and OS_Symbol* functions; `modules` is where code comes from, None for nowhere."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self.modules: CodeSource | None = None
        self._paths: FileSystem = setup.files
        self._modules: OsObjectTable[OsModule] = self._table("module", OS_MODULE_BASE, OS_MAX_MODULES)

    def module_load(self, module_name: str, filename: str, flags: int = OS_MODULE_FLAG_GLOBAL_SYMBOLS) -> int:
        """Load code (OS_ModuleLoad).

        Args:
            module_name: unique among modules, at most 19 characters.
            filename: virtual path, e.g. "/cf/hk.so".
            flags: OS_MODULE_FLAG_GLOBAL_SYMBOLS or OS_MODULE_FLAG_LOCAL_SYMBOLS; without effect, since Python modules
                do not see each other's names.

        Returns:
            The module's id.

        Raises:
            OsalError: OS_ERR_NAME_TOO_LONG, OS_ERR_NAME_TAKEN, OS_ERR_NO_FREE_IDS, OS_FS_ERR_* for the path, OS_ERROR
                when there is no such code or executing it failed, OS_ERR_NOT_IMPLEMENTED without a loader.
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

    def module_unload(self, module_id: int) -> None:
        """Forget a module (OS_ModuleUnload); what was taken out of it goes on. OS_ERR_INVALID_ID when there is none."""
        self._unregister(self._modules, self._module(module_id))

    def module_code(self, module_id: int) -> object:
        """What was loaded: an object with the module's symbols. OS_ERR_INVALID_ID when there is no such module."""
        return self._module(module_id).code

    def module_info(self, module_id: int) -> ModuleInfo:
        """Facts about a module (OS_ModuleInfo), or OS_ERR_INVALID_ID."""
        record = self._module(module_id)
        return ModuleInfo(record.name, record.filename)

    def module_symbol_lookup(self, module_id: int, symbol_name: str) -> Any:
        """What a name stands for in a module, mostly a function (OS_ModuleSymbolLookup).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERROR when it has no such name.
        """
        record = self._module(module_id)
        if not hasattr(record.code, symbol_name):
            raise OsalError(OS_ERROR, f"module {record.name} has no symbol {symbol_name}")
        return getattr(record.code, symbol_name)

    def symbol_lookup(self, symbol_name: str) -> Any:
        """What a name stands for in the first module or library that has it (OS_SymbolLookup).

        Raises:
            OsalError: OS_ERROR when none has it.
        """
        for record in self._modules:
            if hasattr(record.code, symbol_name):
                return getattr(record.code, symbol_name)
        found = self.modules.library_symbol(symbol_name) if self.modules is not None else None
        if found is not None:
            return found
        raise OsalError(OS_ERROR, f"unknown symbol {symbol_name}")

    def symbol_table_dump(self, filename: str, size_limit: int) -> None:
        """Write all symbols to a file (OS_SymbolTableDump): there are no addresses to write.

        Raises:
            OsalError: OS_FS_ERR_* for the path, else OS_ERR_NOT_IMPLEMENTED, as on NASA's Linux.
        """
        self._paths.translate(filename)
        raise OsalError(OS_ERR_NOT_IMPLEMENTED, "symbols have no addresses in the simulation")

    def _module(self, module_id: int) -> OsModule:
        record = self._modules.lookup(module_id)
        if record is None:
            raise self._modules.missing(module_id)
        return record
