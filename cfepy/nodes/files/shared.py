"""Host modules that open files themselves, such as those in C: they are given places instead of paths."""

from __future__ import annotations

import codecs
import os
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any
from urllib.parse import quote, unquote

from cfepy.nodes.made_modules import proxy, rebind

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

_PATHS = (str, bytes, os.PathLike)
_IN_MEMORY = (":memory:", "")
_ARRAY_READERS = ("fromfile", "fromregex", "genfromtxt", "load", "loadtxt")
_ARRAY_SUFFIXES = {"save": ".npy", "savez": ".npz", "savez_compressed": ".npz", "savetxt": ""}


def codecs_module(universe: Universe) -> ModuleType:
    """`codecs`: its `open` opens the run's files."""
    return rebind(codecs, ("open",), builtins=universe.builtins)


def sqlite3_module(universe: Universe) -> ModuleType:
    """`sqlite3`: its databases are files of the run; a host database is copied when it is opened."""
    import sqlite3

    def place(database: Any) -> Any:
        plain = os.fsdecode(database)
        return database if plain in _IN_MEMORY else universe.claimed(plain)

    def uri_place(uri: str) -> str:
        head, _, query = uri.removeprefix("file:").partition("?")
        if not uri.startswith("file:") or head in _IN_MEMORY or "mode=memory" in query:
            return uri
        path = unquote(head if not head.startswith("//") else "/" + head[2:].partition("/")[2])
        reads = "mode=ro" in query or "immutable=1" in query
        where = universe.resolve(path) if reads else universe.claimed(path)
        return f"file:{quote(str(where))}{'?' if query else ''}{query}"

    class Connection(sqlite3.Connection):
        __doc__ = sqlite3.Connection.__doc__

        def __init__(self, database: Any, *args: Any, **options: Any) -> None:
            is_uri = options.get("uri", False) and isinstance(database, str)
            super().__init__(uri_place(database) if is_uri else place(database), *args, **options)

    Connection.__module__ = "sqlite3"

    def connect(database: Any, *args: Any, **options: Any) -> Any:
        options.setdefault("factory", Connection)
        return sqlite3.connect(database, *args, **options)

    return proxy(sqlite3, connect=connect, Connection=Connection)


def sqlite3_part(universe: Universe) -> ModuleType:
    """`sqlite3.dbapi2`."""
    import sqlite3.dbapi2

    module = universe.importer.load("sqlite3")
    return proxy(sqlite3.dbapi2, connect=module.connect, Connection=module.Connection)


def array_files(universe: Universe, numpy: ModuleType) -> dict[str, Callable[..., Any]]:
    """NumPy's functions that take paths.

    Args:
        universe: the node's.
        numpy: the host's NumPy.
    """

    def reading(function: Callable[..., Any]) -> Callable[..., Any]:
        def read(file: Any, *args: Any, **options: Any) -> Any:
            return function(universe.resolve(file) if isinstance(file, _PATHS) else file, *args, **options)

        return read

    def writing(function: Callable[..., Any], suffix: str) -> Callable[..., Any]:
        def write(file: Any, *args: Any, **options: Any) -> Any:
            if not isinstance(file, _PATHS):
                return function(file, *args, **options)
            path = os.fsdecode(file)
            return function(universe.claimed(path if path.endswith(suffix) else path + suffix), *args, **options)

        return write

    found = {name: reading(getattr(numpy, name)) for name in _ARRAY_READERS}
    return {**found, **{name: writing(getattr(numpy, name), suffix) for name, suffix in _ARRAY_SUFFIXES.items()}}
