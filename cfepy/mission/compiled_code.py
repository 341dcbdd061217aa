"""Compiled code of applications and libraries: the ELF files named in a startup script.

An ELF file is never taken for another kind of file. If it cannot be loaded, the application fails, and no Python file
of the same name replaces it. The loader comes from an add-on, which is loaded when there is an ELF file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Protocol

from cfepy.es import NODE_SYMBOL, StartupEntry
from cfepy.mission.loader import Code, Finder
from cfepy.osal import FileSystem
from cfepy.reading.input_files import beginning_of, read_limited
from cfepy.reading.input_limits import OBJECT_BYTES
from cfepy.status import OsalError

ELF = b"\x7fELF"
FILES = "/cf/"


def find_compiled(file: str, folder: Path) -> Path | None:
    """Return the ELF file on the host behind a virtual path below /cf, for tools that examine a mission from outside.

    Args:
        file: the virtual path.
        folder: the mission's folder.
    """
    if not file.startswith(FILES) or ".." in file:
        return None
    found = folder / file.removeprefix(FILES)
    return found if beginning_of(found, len(ELF)) == ELF else None


class CompiledRuntime(Protocol):
    """The C side of a processor, for missions and debuggers."""

    def images(self) -> Iterable[Any]:
        """Return the loaded images: each has a `base` address, and a `source` with `name` and `data`."""

    def unload(self, app_name: str) -> object:
        """Unload the code of an ended application."""

    def close(self) -> object:
        """Release everything at the end of the processor."""


class CodeLoader(Protocol):
    """Loads compiled code for a processor."""

    @property
    def runtime(self) -> CompiledRuntime:
        """The C side of the processor."""

    def code(self, file: str, data: bytes) -> Code:
        """Return the code in a shared object, not loaded yet.

        Args:
            file: its virtual path.
            data: its bytes.
        """


class CompiledFiles(Finder):
    """Finds shared objects in the mission's folder, and those that the mission itself wrote.

    Args:
        files: the mission's files.
        make_loader: makes the loader for the first one.
        built: shared objects elsewhere on the host, by their virtual paths.
    """

    def __init__(
        self, files: FileSystem, make_loader: Callable[[], CodeLoader], built: Mapping[str, Path] | None = None
    ) -> None:
        self._files = files
        self._built = built or {}
        self._make_loader = make_loader
        self._loader: CodeLoader | None = None

    def prepare(self, entries: Iterable[StartupEntry]) -> None:
        """Make the loader before a boot whose startup script names compiled code, so that it can reach the core's
        memory.
        """
        if any(entry.symbol != NODE_SYMBOL and self.exists(entry.path) for entry in entries):
            self._loader_made()

    def find(self, file: str, symbol: str | None) -> Code | None:
        data = self._data(file)
        return None if data is None else self._loader_made().code(file, data)

    def _loader_made(self) -> CodeLoader:
        if self._loader is None:
            self._loader = self._make_loader()
        return self._loader

    @property
    def runtime(self) -> CompiledRuntime | None:
        """The C side of the processor; None if no compiled code was loaded."""
        return None if self._loader is None else self._loader.runtime

    def exists(self, file: str) -> bool:
        return self._data(file) is not None

    def unload(self, app_name: str) -> None:
        if self._loader is not None:
            self._loader.runtime.unload(app_name)

    def forget(self) -> None:
        if self._loader is not None:
            self._loader.runtime.close()
            self._loader = None

    def _data(self, file: str) -> bytes | None:
        try:
            node = self._files.find(file)
        except OsalError:  # an illegal path, such as one that is too long
            return None
        if node is None and file in self._built:
            return read_limited(self._built[file], OBJECT_BYTES)
        if node is None or bytes(node.data[: len(ELF)]) != ELF:
            return None
        return bytes(node.data)
