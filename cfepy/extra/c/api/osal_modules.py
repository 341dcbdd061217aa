"""OS_Module*, OS_Symbol*: loading code, and finding functions and variables by name, for C.

OS_SymbolLookup searches as the dynamic linker of Linux does: first the functions of cFE, OSAL and the PSP and the
exports of libraries, then modules and applications.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.osal_values import BAD, new_id
from cfepy.extra.c.image import LoadedCode
from cfepy.extra.c.memory import chars
from cfepy.osal import OS_MAX_API_NAME, OS_MAX_PATH_LEN, OS_MODULE_FLAG_LOCAL_SYMBOLS
from cfepy.status import (
    OS_ERROR,
    OS_FS_ERR_NAME_TOO_LONG,
    OS_FS_ERR_PATH_INVALID,
    OS_FS_ERR_PATH_TOO_LONG,
    OS_INVALID_POINTER,
    CfeError,
    OsalError,
)

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

MODULE_INFO = Struct(f"<QQ{OS_MAX_PATH_LEN}s{OS_MAX_API_NAME}s4xIIQQQQQQ")
"""OS_module_prop_t."""
_LATE = (OS_ERROR, OS_FS_ERR_PATH_INVALID, OS_FS_ERR_PATH_TOO_LONG, OS_FS_ERR_NAME_TOO_LONG, OS_INVALID_POINTER)
"""Statuses of failures after the module has got its id."""


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_modules(api, c)
    _declare_symbols(api, c)


def _declare_modules(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def load(name: str, file: str | None, flags: int) -> int:
        if file is None:
            raise OsalError(BAD, "missing path")
        module_id = os.module_load(name, file, flags)
        code = os.module_code(module_id)
        if isinstance(code, LoadedCode):
            c.modules[module_id] = code.image_
            if not flags & OS_MODULE_FLAG_LOCAL_SYMBOLS:
                c.openings.with_global_names[code.image_] = None
        return module_id

    def unload(module_id: int) -> None:
        os.module_unload(module_id)
        if module_id in c.modules:
            c.close_image(c.modules.pop(module_id))

    def info(module_id: int, at: int) -> None:
        memory.poke(at, bytes(MODULE_INFO.size))
        module = os.module_info(module_id)
        code = os.module_code(module_id)
        image = code.image_ if isinstance(code, LoadedCode) else None
        where = (0,) * 8
        if image is not None and c.tells_code:
            where = (1, 0, image.base, image.size, image.base, 0, image.base, 0)
        raw = MODULE_INFO.pack(
            0, 0, chars(module.filename, OS_MAX_PATH_LEN), chars(module.name, OS_MAX_API_NAME), *where
        )
        memory.poke(at, raw)

    api.add("OS_ModuleLoad", "=4SsI", new_id(load, *_LATE), BAD)
    api.add("OS_ModuleUnload", "I", unload)
    api.add("OS_ModuleInfo", "IP", info, BAD)


def _declare_symbols(api: Declarations, c: CRuntime) -> None:
    os = c.handle.os

    def look_up(name: str) -> int:
        found = c.symbol(name)
        if found is not None:
            return found
        raise OsalError(OS_ERROR, f"unknown symbol {name}")

    def look_up_in(module_id: int, at: int, name: str) -> None:
        try:
            symbol = os.module_symbol_lookup(module_id, name)
        except CfeError as error:
            if error.status == OS_ERROR:
                c.memory.put_u64(at, 0)
            raise
        c.memory.put_u64(at, symbol if isinstance(symbol, int) else 0)
        if not isinstance(symbol, int):
            raise OsalError(OS_ERROR, f"{name} is not a symbol of compiled code")

    api.add("OS_SymbolLookup", "~8S", look_up, BAD)
    api.add("OS_ModuleSymbolLookup", "IPS", look_up_in, BAD)
    api.add("OS_SymbolTableDump", "SQ", os.symbol_table_dump, BAD)
