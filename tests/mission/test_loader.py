"""The loader asks its finders in order. Code of another kind than Python needs only one more finder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from cfepy.es import NODE_SYMBOL
from cfepy.mission.loader import BuiltInApps, ModuleLoader
from cfepy.mission.python_code import Code, NodeScripts, PythonLoader, RemovedCodeError, python_finders
from cfepy.nodes import AppModules, make_app_universe
from cfepy.osal import FileSystem
from cfepy.status import OS_ERROR, OsalError
from cfepy.writing.console import Console

HANDLE = object()


class Compiled:
    """A compiled application, which is asked for its symbols by name."""

    add = staticmethod(lambda a, b: a + b)

    def main(self, symbol: str, app_name: str) -> Callable[[], object]:
        return lambda: f"{symbol} of {app_name}"

    def library(self, symbol: str) -> tuple[object, Callable[[int], object]]:
        return self, lambda lib_id: lib_id if symbol == "Fails" else 0

    def module(self, owner: str) -> object:
        return self


class CompiledApps:
    """Finds compiled applications by the first bytes of their file, like a finder for shared objects."""

    def __init__(self, files: FileSystem) -> None:
        self.files = files
        self.forgotten = 0

    def find(self, file: str, symbol: str | None) -> Code | None:
        node = self.files.find(file)
        return Compiled() if node is not None and bytes(node.data).startswith(b"\x7fELF") else None

    def exists(self, file: str) -> bool:
        return self.find(file, None) is not None

    def forget(self) -> None:
        self.forgotten += 1


class Removed(CompiledApps):
    """Knows that the code was removed."""

    def find(self, file: str, symbol: str | None) -> Code | None:
        raise RemovedCodeError(file)


@pytest.fixture
def files(tmp_path: Path) -> FileSystem:
    (tmp_path / "hk.py").write_text(
        "def Main(cfe):\n    return 'python', cfe\n\n\ndef Init(cfe):\n    return 0\n", encoding="utf-8"
    )
    return FileSystem(tmp_path)


@pytest.fixture
def console() -> Console:
    return Console(quiet=True)


@pytest.fixture
def loader(tmp_path: Path, files: FileSystem, console: Console) -> ModuleLoader:
    nodes = NodeScripts(files, tmp_path, lambda file: None, lambda script, app: lambda: f"{script.name} as {app}")
    python = python_finders(PythonLoader(console, lambda: HANDLE, AppModules(make_app_universe)), files, tmp_path)
    built_in = BuiltInApps({"/cf/own.so": lambda: "built in"})
    return ModuleLoader(console, [CompiledApps(files), built_in, nodes, *python])


def test_first_finder_with_the_module_loads_it(loader: ModuleLoader, files: FileSystem) -> None:
    assert loader.load("/cf/hk.so", "Main", "HK")() == ("python", HANDLE)
    assert loader.load("/cf/hk.so", NODE_SYMBOL, "HK")() == "hk.py as HK"
    assert loader.load("/cf/own.so", "any", "OWN")() == "built in"
    files.write_file("/cf/hk.so", b"\x7fELF...")
    assert loader.load("/cf/hk.so", "Main", "HK")() == "Main of HK"
    loader.forget()


def test_libraries_of_any_kind_have_symbols(loader: ModuleLoader, files: FileSystem) -> None:
    files.write_file("/cf/sum.so", b"\x7fELF...")
    assert loader.library_symbol("add") is None
    assert loader.load_library("/cf/sum.so", "Fails")(-1) == -1
    assert loader.library_symbol("add") is None
    assert loader.load_library("/cf/sum.so", "Init")(7) == 0
    assert loader.load_library("/cf/hk.so", "Init")(8) == 0
    assert loader.library_symbol("add") is Compiled.add
    assert loader.library_symbol("Init") is not None
    loader.forget()


def test_unknown_module_is_reported(loader: ModuleLoader, console: Console) -> None:
    for load in (lambda: loader.load("/cf/x.so", "Main", "X"), lambda: loader.load_module("/cf/own.so", "module M")):
        with pytest.raises(OsalError) as caught:
            load()
        assert caught.value.status == OS_ERROR
    assert [line[:28] for line in console.lines] == ["OS_ModuleLoad: no x.py and n", "OS_ModuleLoad: no own.py and"]
    assert [loader.exists(f"/cf/{name}.so") for name in ("hk", "own", "x")] == [True, True, False]
    assert not loader.exists("nowhere/x.so")


def test_removed_code_is_not_loaded_by_another_finder(files: FileSystem, console: Console) -> None:
    removed, other = Removed(files), CompiledApps(files)
    files.write_file("/ram/a.so", b"\x7fELF...")
    loader = ModuleLoader(console, [removed, other])
    assert not loader.exists("/ram/a.so")
    with pytest.raises(OsalError, match=r"no a.py"):
        loader.load("/ram/a.so", "Main", "A")
    loader.forget()
    assert (removed.forgotten, other.forgotten) == (1, 1)
