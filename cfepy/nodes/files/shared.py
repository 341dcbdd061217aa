"""Host modules that open files themselves, such as those in C: they are given places instead of paths."""

from __future__ import annotations

import codecs
import os
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any, Literal
from urllib.parse import quote, unquote

from cfepy.nodes.made_modules import proxy, rebind

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

_PATHS = (str, bytes, os.PathLike)
_IN_MEMORY = (":memory:", "")
_BUSY_S = 0.001  # from one look at a database that is locked to the next
_LOCKED = "database is locked"  # SQLite's text for a lock for which its busy handler waits
_LOOKING = ("SELECT", "PRAGMA", "EXPLAI")
_ENDING = ("COMMIT", "END", "ROLLBA")
_ARRAY_READERS = ("fromfile", "fromregex", "genfromtxt", "load", "loadtxt")
_ARRAY_SUFFIXES = {"save": ".npy", "savez": ".npz", "savez_compressed": ".npz", "savetxt": ""}


def codecs_module(universe: Universe) -> ModuleType:
    """`codecs`: its `open` opens the run's files."""
    return rebind(codecs, ("open",), builtins=universe.builtins)


def sqlite3_module(universe: Universe) -> ModuleType:
    """`sqlite3`: its databases are files of the run; a host database is copied when it is opened.

    A connection waits in virtual time for a lock that another connection has. As in SQLite, a transaction that has read
    does not wait to write, because two of them would wait for each other. Other tasks may run before a statement while
    schedules are explored.
    """
    import sqlite3

    points = universe.file_points

    def place(database: Any) -> Any:
        plain = os.fsdecode(database)
        return database if plain in _IN_MEMORY else universe.claimed(plain)

    def uri_place(uri: str) -> str:
        path, query = _path_in(uri), uri.partition("?")[2]
        if path in _IN_MEMORY or not uri.startswith("file:"):
            return uri
        reads = "mode=ro" in query or "immutable=1" in query
        where = universe.resolve(path) if reads else universe.claimed(path)
        return f"file:{quote(str(where))}{'?' if query else ''}{query}"

    def patient(connection: Any, action: Callable[[], Any], statement: Any = "COMMIT") -> Any:
        """Execute a statement, as soon as no other connection has a lock against it."""
        word = statement.lstrip()[:6].upper() if isinstance(statement, str) else ""
        if points is not None and connection.path in _IN_MEMORY:
            points.pause()
        elif points is not None:
            points.access(universe.absolute(connection.path), word not in _LOOKING)
        waits = not connection.has_read or word in _ENDING
        end_ns = universe.kernel.now + round(connection.patience * 1e9)
        while True:
            try:
                done = action()
            except sqlite3.OperationalError as error:
                if str(error) != _LOCKED or not waits or universe.kernel.now >= end_ns:
                    raise
                universe.clock.wait(_BUSY_S)
            else:
                connection.has_read = connection.in_transaction and (connection.has_read or word in _LOOKING)
                return done

    class Cursor(sqlite3.Cursor):
        __doc__ = sqlite3.Cursor.__doc__

        def execute(self, *args: Any) -> Any:
            return patient(self.connection, lambda: super(Cursor, self).execute(*args), *args[:1])

        def executemany(self, *args: Any) -> Any:
            return patient(self.connection, lambda: super(Cursor, self).executemany(*args), *args[:1])

        def executescript(self, *args: Any) -> Any:
            return patient(self.connection, lambda: super(Cursor, self).executescript(*args))

    class Connection(sqlite3.Connection):
        __doc__ = sqlite3.Connection.__doc__

        def __init__(self, database: Any, timeout: float = 5.0, *args: Any, **options: Any) -> None:
            is_uri = options.get("uri", False) and isinstance(database, str)
            self.path = _path_in(database) if is_uri else os.fsdecode(database)
            self.patience = timeout
            self.has_read = False  # in the transaction that is open
            super().__init__(uri_place(database) if is_uri else place(database), 0.0, *args, **options)

        def cursor(self, factory: Any = Cursor) -> Any:
            return super().cursor(factory)

        def execute(self, *args: Any) -> Any:
            return self.cursor().execute(*args)

        def executemany(self, *args: Any) -> Any:
            return self.cursor().executemany(*args)

        def executescript(self, *args: Any) -> Any:
            return self.cursor().executescript(*args)

        def commit(self) -> None:
            patient(self, super().commit)

        def rollback(self) -> None:
            patient(self, super().rollback)

        def __exit__(self, kind: object, *error: object) -> Literal[False]:
            if kind is None:
                self.commit()
            else:
                self.rollback()
            return False

    Connection.__module__ = Cursor.__module__ = "sqlite3"

    def connect(database: Any, *args: Any, **options: Any) -> Any:
        options.setdefault("factory", Connection)
        return sqlite3.connect(database, *args, **options)

    return proxy(sqlite3, connect=connect, Connection=Connection, Cursor=Cursor)


def _path_in(uri: str) -> str:
    """Return the path in a URI of SQLite; empty for a database in memory."""
    head, _, query = uri.removeprefix("file:").partition("?")
    if head in _IN_MEMORY or "mode=memory" in query:
        return ""
    return unquote(head if not head.startswith("//") else "/" + head[2:].partition("/")[2])


def sqlite3_part(universe: Universe) -> ModuleType:
    """`sqlite3.dbapi2`."""
    import sqlite3.dbapi2

    module = universe.importer.load("sqlite3")
    return proxy(sqlite3.dbapi2, connect=module.connect, Connection=module.Connection, Cursor=module.Cursor)


def array_files(universe: Universe, numpy: ModuleType) -> dict[str, Callable[..., Any]]:
    """NumPy's functions that take paths.

    Args:
        universe: the node's.
        numpy: the host's NumPy.
    """

    points = universe.file_points

    def pause(path: str, is_write: bool) -> None:
        if points is not None:
            points.access(universe.absolute(path), is_write)

    def reading(function: Callable[..., Any]) -> Callable[..., Any]:
        def read(file: Any, *args: Any, **options: Any) -> Any:
            if isinstance(file, _PATHS):
                pause(os.fsdecode(file), False)
            return function(universe.resolve(file) if isinstance(file, _PATHS) else file, *args, **options)

        return read

    def writing(function: Callable[..., Any], suffix: str) -> Callable[..., Any]:
        def write(file: Any, *args: Any, **options: Any) -> Any:
            if not isinstance(file, _PATHS):
                return function(file, *args, **options)
            path = os.fsdecode(file)
            path = path if path.endswith(suffix) else path + suffix
            pause(path, True)
            return function(universe.claimed(path), *args, **options)

        return write

    found = {name: reading(getattr(numpy, name)) for name in _ARRAY_READERS}
    return {**found, **{name: writing(getattr(numpy, name), suffix) for name, suffix in _ARRAY_SUFFIXES.items()}}
