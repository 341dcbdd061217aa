"""OS_ModuleLoad and its kin, with a source of code of a few lines."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from cfepy.osal.limits import OS_MODULE_FLAG_LOCAL_SYMBOLS
from cfepy.osal.modules import ModuleAddress
from cfepy.status import (
    OS_ERR_INVALID_ID,
    OS_ERR_NAME_TAKEN,
    OS_ERR_NAME_TOO_LONG,
    OS_ERR_NO_FREE_IDS,
    OS_ERR_NOT_IMPLEMENTED,
    OS_ERROR,
    OS_FS_ERR_PATH_INVALID,
    OsalError,
)
from tests.osal.helpers import Bench
from tests.osal.test_queues import status_of


class Shelf:
    """Gives modules that know their owners; /cf/bad.so is not a module."""

    def load_module(self, file: str, owner: str) -> object:
        """Return the module."""
        if file == "/cf/bad.so":
            raise OsalError(OS_ERROR, "no such code")
        return SimpleNamespace(owner=owner, **{owner.split()[1].lower(): f"symbol of {file}"})

    def library_symbol(self, name: str) -> object | None:
        """Return the symbol of a library."""
        return "symbol of a library" if name == "LIB_Function" else None


@pytest.fixture
def loader(bench: Bench) -> Bench:
    """Return a bench whose OSAL can load code."""
    bench.os.modules = Shelf()
    return bench


def test_the_life_of_a_module(loader: Bench) -> None:
    os = loader.os
    first = os.module_load("FIRST", "/cf/a.so", OS_MODULE_FLAG_LOCAL_SYMBOLS)
    second = os.module_load("SECOND", "/cf/b.so")
    assert os.module_symbol_lookup(second, "second") == "symbol of /cf/b.so"
    assert os.symbol_lookup("owner") == "module FIRST"
    assert os.symbol_lookup("second") == "symbol of /cf/b.so"
    assert os.symbol_lookup("LIB_Function") == "symbol of a library"
    info = os.module_info(first)
    assert (info.name, info.filename, info.addr) == ("FIRST", "/cf/a.so", ModuleAddress())
    assert not info.addr.valid
    os.module_unload(first)
    assert os.symbol_lookup("owner") == "module SECOND"
    assert status_of(os.module_info, first) == OS_ERR_INVALID_ID
    os.module_load("FIRST", "/cf/a.so")


def test_module_load_refuses_invalid_names_paths_and_code(loader: Bench) -> None:
    os = loader.os
    assert status_of(os.module_load, "n" * 20, "/cf/a.so") == OS_ERR_NAME_TOO_LONG
    assert status_of(os.module_load, "M", "cf") == OS_FS_ERR_PATH_INVALID
    assert status_of(os.module_load, "M", "/cf/bad.so") == OS_ERROR
    os.module_load("M", "/cf/a.so")  # the failed ones left nothing behind
    assert status_of(os.module_load, "M", "/cf/a.so") == OS_ERR_NAME_TAKEN
    for number in range(1, os.config.os_max_modules):
        os.module_load(f"M{number}", "/cf/a.so")
    assert status_of(os.module_load, "ONE_MORE", "/cf/a.so") == OS_ERR_NO_FREE_IDS


def test_unknown_symbols_are_an_error(loader: Bench) -> None:
    os = loader.os
    module = os.module_load("M", "/cf/a.so")
    assert status_of(os.module_symbol_lookup, module, "NotFound") == OS_ERROR
    assert status_of(os.module_symbol_lookup, 0, "m") == OS_ERR_INVALID_ID
    assert status_of(os.symbol_lookup, "NotFound") == OS_ERROR
    assert status_of(os.module_unload, 0) == OS_ERR_INVALID_ID


def test_symbol_table_dump_is_not_available(bench: Bench) -> None:
    assert status_of(bench.os.symbol_table_dump, "/ram/symbols.dat", 10_000) == OS_ERR_NOT_IMPLEMENTED
    assert status_of(bench.os.symbol_table_dump, "/this/is/nowhere", 10_000) == OS_FS_ERR_PATH_INVALID


def test_osal_without_a_loader_loads_nothing(bench: Bench) -> None:
    assert status_of(bench.os.module_load, "M", "/cf/a.so") == OS_ERR_NOT_IMPLEMENTED
