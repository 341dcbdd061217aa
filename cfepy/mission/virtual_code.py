"""Code that is nowhere on the host: a file that a mission wrote itself, or got from the ground, into /ram or /cf."""

from __future__ import annotations

import importlib.util
from importlib.abc import InspectLoader
from pathlib import PurePosixPath
from types import CodeType

from cfepy.osal import FileSystem

SUFFIXES = (".py", ".so", ".obj", ".o", "")


class VirtualCode(InspectLoader):
    """A Python source file of the virtual file system, as an import loader; tracebacks show its lines.

    Args:
        path: its virtual path.
        source: its bytes.
    """

    def __init__(self, path: str, source: bytes) -> None:
        self.path = path
        self.source = source

    def get_source(self, fullname: str) -> str:
        """The text."""
        return importlib.util.decode_source(self.source)

    def get_code(self, fullname: str) -> CodeType:
        """The code; raises SyntaxError when it is none."""
        return self.source_to_code(self.source, self.path)

    def is_package(self, fullname: str) -> bool:
        """It is a module."""
        return False


def find_virtual_code(file: str, files: FileSystem) -> VirtualCode | None:
    """The source behind a virtual path: x.py for /ram/x.so, else the file itself, whatever its suffix; or None.

    Raises:
        OsalError: the path is no good.
    """
    path = PurePosixPath(file)
    for suffix in dict.fromkeys((".py", path.suffix)):
        candidate = str(path.with_suffix(suffix)) if suffix in SUFFIXES else file
        node = files.find(candidate)
        if node is not None:
            return VirtualCode(candidate, bytes(node.data))
    return None
