"""Code that is nowhere on the host: a file that a mission wrote itself, or got from the ground, into /ram or /cf."""

from __future__ import annotations

from importlib.machinery import SourceFileLoader
from pathlib import PurePosixPath

from cfepy.osal import FileSystem

SUFFIXES = (".py", ".so", ".obj", ".o", "")


class VirtualCode(SourceFileLoader):
    """A Python source file of the virtual file system, as an import loader; tracebacks show its lines.

    Args:
        path: its virtual path.
        source: its bytes.
    """

    def __init__(self, path: str, source: bytes) -> None:
        super().__init__("", path)
        self.source = source

    def get_filename(self, name: str | None = None) -> str:
        """The virtual path, whatever the module is called."""
        return str(self.path)

    def get_data(self, path: object) -> bytes:
        """The source."""
        return self.source

    def path_stats(self, path: object) -> dict[str, float]:
        """There are none, so nothing is looked for or put beside the file."""
        raise OSError


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
