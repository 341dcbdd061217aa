"""Holdings: resources that applications take from cFE and have to give back, with the line that took each.

It is the ledger of the guard (`--guard`). The handle for applications gets a layer that writes down each address of a
table, message buffer, block of a memory pool, open file, folder or socket, lock, and each object of OSAL that
CFE_ES_CleanUpApp leaves behind. The services themselves know whether it is still held, so nothing is counted twice.
Without the guard the handle has no such layer, and a call costs no more.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from inspect import isroutine
from pathlib import PurePath
from types import FrameType
from typing import Any, NamedTuple

from cfepy.app import Cfe
from cfepy.es import AppRecord, ExecutiveServices
from cfepy.interpreter.own_code import called_as, is_own_code, is_shown
from cfepy.ports import application_of
from cfepy.rtos import Kernel, Task
from cfepy.status import CfeError

LEFT_BEHIND = ", which cFE does not delete when its application ends"
"""Said of objects that CFE_ES_CleanupObjectCallback does not know."""
GIVES = {
    "tbl": ("release_address", "release_addresses", "unregister"),
    "sb": ("release_message_buffer", "transmit_buffer"),
    "es": ("put_pool_buf", "pool_delete", "delete_gen_counter"),
    "os": (
        *("close", "close_all_files", "close_file_by_name", "directory_close", "mut_sem_give", "cond_var_unlock"),
        *("time_base_delete", "cond_var_delete", "rw_lock_delete"),
    ),
}
"""Calls that give something back, by service."""
CONDITION = "of condition "
"""What the name of a condition variable's mutex begins with."""
_FIRST_SWEEP = 256
Key = tuple[object, ...]


@dataclass(slots=True, eq=False)
class Holding:
    """Something that an application took.

    Attributes:
        app: the application.
        resource: its description: `the address of table ARM.Limits`.
        place: the line that took it: `arm.c:12`; empty for code without debug data.
        at_ns: virtual time of the call in ns.
        is_held: returns whether it was not given back since.
    """

    app: Any
    resource: str
    place: str
    at_ns: int
    is_held: Callable[[], bool]

    def __str__(self) -> str:
        """Return the description and the line."""
        return f"{self.resource}, taken at {self.place}" if self.place else self.resource


class HeldRow(NamedTuple):
    """Resources that an application holds from one line: their number, and the virtual time in ns of the oldest."""

    app: str
    text: str
    number: int
    since_ns: int

    def __str__(self) -> str:
        """Return the text, with the number if there are several."""
        return f"{self.text} ({self.number} times)" if self.number > 1 else self.text


class Holdings:
    """The ledger of one processor.

    Args:
        kernel: its tasks and its clock.
        on_leak: gets the application and a text for each kind of thing that it holds when it ends.
    """

    def __init__(self, kernel: Kernel, on_leak: Callable[[str, str], object]) -> None:
        self._kernel = kernel
        self._on_leak = on_leak
        self._all: dict[Key, Holding] = {}
        self._sweep_at = _FIRST_SWEEP
        self._ending: list[Holding] | None = None

    def take(self, key: Key, resource: str, is_held: Callable[[], bool]) -> None:
        """Write down that the calling application took something; other callers are left out.

        Args:
            key: its identity; a later one with the same key replaces it.
            resource: its description, for reports.
            is_held: returns whether it was not given back since.
        """
        app = application_of(self._kernel.current.owner)
        if app is None or app.is_core:
            return
        if len(self._all) >= self._sweep_at:
            self._all = {key: each for key, each in self._all.items() if each.is_held()}
            self._sweep_at = max(2 * len(self._all), _FIRST_SWEEP)
        self._all[key] = Holding(app, resource, _place(sys._getframe(1)), self._kernel.now, is_held)

    def place_of_address(self, handle: int) -> str:
        """Return the line that took the address of a table, given the handle; empty if it is not known."""
        holding = self._all.get(_table_key(handle))
        return "" if holding is None else holding.place

    def giving(self, call: Callable[..., Any], args: tuple[Any, ...], options: Mapping[str, Any]) -> Any:
        """Make a call that gives something back; a `finally` block may still do so while its task is being ended."""
        if self._ending is None:
            return call(*args, **options)
        before = [each for each in self._ending if each.is_held()]
        try:
            return call(*args, **options)
        finally:
            given = {id(each) for each in before if not each.is_held()}
            self._ending = [each for each in self._ending if id(each) not in given]

    @contextmanager
    def ending(self, app: AppRecord) -> Iterator[None]:
        """Clean up an application, and report afterwards its holdings.

        An application that an exception ended is left out: its holdings follow from the exception.
        """
        self._ending = [each for each in self._all.values() if each.app is app and each.is_held()]
        try:
            yield
        finally:
            left, self._ending = self._ending, None
            self._all = {key: each for key, each in self._all.items() if each.app is not app}
            if app.error is None:
                for row in _rows(left):
                    self._on_leak(row.app, str(row))

    def rows(self) -> list[HeldRow]:
        """Return the present holdings of applications, by application and line."""
        return _rows(each for each in self._all.values() if each.is_held())


def _rows(holdings: Iterable[Holding]) -> list[HeldRow]:
    found: dict[tuple[str, str], HeldRow] = {}
    for each in holdings:
        key = each.app.name, str(each)
        row = found.get(key, HeldRow(*key, 0, each.at_ns))
        found[key] = row._replace(number=row.number + 1, since_ns=min(row.since_ns, each.at_ns))
    return sorted(found.values(), key=lambda row: (row.app, row.since_ns, row.text))


def _place(frame: FrameType | None) -> str:
    """Return the innermost line of the application's own code in a stack, otherwise of a library's: `arm.c:12`."""
    library = ""
    while frame is not None:
        file = frame.f_code.co_filename
        if is_shown(file):
            place = f"{PurePath(file).name}:{frame.f_lineno}"
            if is_own_code(file):
                return place
            library = library or place
        frame = frame.f_back
    return library


def noting_executive(holdings: Holdings) -> type[ExecutiveServices]:
    """Return the class of Executive Services that report to a ledger when an application ends."""

    class NotingExecutive(ExecutiveServices):
        def cleanup_app(self, app: AppRecord) -> bool:
            with holdings.ending(app):
                return super().cleanup_app(app)

    return NotingExecutive


# -- the layer on the handle -------------------------------------------------------------------------------------------

After = Callable[[tuple[Any, ...], Any], None]
"""Called with the arguments and the result of a call."""


class _Noted:
    """A service whose calls are written down; attributes are the service's own."""

    def __init__(self, service: Any, holdings: Holdings, takes: Mapping[str, After], gives: Iterable[str]) -> None:
        vars(self).update(_service=service)
        for name, after in takes.items():
            vars(self)[name] = _taking(getattr(service, name), name, after)
        for name in gives:
            vars(self)[name] = _giving(getattr(service, name), name, holdings)

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._service, name)
        if isroutine(value):
            vars(self)[name] = value
        return value

    def __setattr__(self, name: str, value: Any) -> None:
        vars(self).pop(name, None)
        setattr(self._service, name, value)


def _taking(function: Callable[..., Any], name: str, after: After) -> Callable[..., Any]:
    def call(*args: Any, **options: Any) -> Any:
        result = function(*args, **options)
        after((*args, *options.values()), result)
        return result

    return called_as(call, name)


def _giving(function: Callable[..., Any], name: str, holdings: Holdings) -> Callable[..., Any]:
    def call(*args: Any, **options: Any) -> Any:
        return holdings.giving(function, args, options)

    return called_as(call, name)


def noting(handle: Cfe, core: Cfe, kernel: Kernel, holdings: Holdings) -> Cfe:
    """Return the services as applications reach them, with the ledger.

    Args:
        handle: as applications would reach them otherwise.
        core: the services themselves.
        kernel: its tasks.
        holdings: the ledger.
    """
    takes = {
        "tbl": _of_tables(core, holdings),
        "sb": _of_messages(core, holdings),
        "es": {**_of_pools(core, holdings), **_of_counters(core, holdings)},
        "os": {**_of_objects(core, holdings), **_of_locks(core, kernel, holdings)},
    }
    services: dict[str, Any] = {
        name: _Noted(getattr(handle, name), holdings, each, GIVES[name]) for name, each in takes.items()
    }
    return replace(handle, **services)


def _table_key(handle: int) -> Key:
    return "table", int(handle)


def _of_tables(core: Cfe, holdings: Holdings) -> dict[str, After]:
    registry = core.tbl.registry

    def got(handle: int) -> None:
        access = registry.accesses.find(handle)
        if access is not None:
            holdings.take(
                _table_key(handle),
                f"the address of table {access.table.name}",
                lambda: access.locked and access in access.table.accesses,
            )

    def got_several(args: tuple[Any, ...], result: Any) -> None:
        images = result[0] if isinstance(result, tuple) else result
        for handle, image in zip(args[0], images, strict=False):
            if image is not None:
                got(handle)

    return {
        "get_address": lambda args, result: got(args[0]),
        "get_addresses": got_several,
        "get_addresses_in_c": got_several,
    }


def _of_messages(core: Cfe, holdings: Holdings) -> dict[str, After]:
    def got(args: tuple[Any, ...], buffer: Any) -> None:
        resource = f"a message buffer of {args[0]} bytes"
        holdings.take(("buffer", buffer.number), resource, lambda: core.sb.is_held(buffer))

    return {"allocate_message_buffer": got}


def _of_pools(core: Cfe, holdings: Holdings) -> dict[str, After]:
    def got(args: tuple[Any, ...], block: Any) -> None:
        pool, offset = block.pool, block.offset

        def is_held() -> bool:
            found = core.es.pools.find(args[0])
            if found is None or found is not pool:
                return False
            try:
                return found.blocks.size_of(offset) > 0
            except CfeError:
                return False

        holdings.take(("block", pool, offset), f"a pool block of {args[1]} bytes", is_held)

    return {"get_pool_buf": got}


def _of_counters(core: Cfe, holdings: Holdings) -> dict[str, After]:
    counters = core.es.counters

    def got(args: tuple[Any, ...], counter_id: int) -> None:
        resource = f"the counter {args[0]}{LEFT_BEHIND}"
        holdings.take(("counter", counter_id), resource, lambda: counters.find(counter_id) is not None)

    return {"register_gen_counter": got}


def _of_objects(core: Cfe, holdings: Holdings) -> dict[str, After]:
    """Open files and the like, and the objects that cFE does not delete for an application."""
    osal = core.os

    def exists(object_id: int) -> bool:
        try:
            osal.get_resource_name(object_id)
        except CfeError:
            return False
        return True

    def got(resource: str, object_id: int) -> None:
        name = osal.get_resource_name(object_id)
        holdings.take(("object", object_id), resource.format(name=name), lambda: exists(object_id))

    def of(resource: str) -> After:
        return lambda args, object_id: got(resource, object_id)

    def accepted(args: tuple[Any, ...], result: Any) -> None:
        if result is not None:
            got("a socket", result[0])

    return {
        "open_create": of("the open file {name}"),
        "directory_open": of(f"the open folder {{name}}{LEFT_BEHIND}"),
        "socket_open": of("a socket"),
        "socket_accept": accepted,
        "socket_accept_abs": accepted,
        "time_base_create": of(f"the time base {{name}}{LEFT_BEHIND}"),
        "cond_var_create": of(f"the condition variable {{name}}{LEFT_BEHIND}"),
        "rw_lock_create": of(f"the readers-writer lock {{name}}{LEFT_BEHIND}"),
    }


def _of_locks(core: Cfe, kernel: Kernel, holdings: Holdings) -> dict[str, After]:
    def took(name: str) -> None:
        task: Task = kernel.current
        for mutex in task.held:
            if mutex.name == name and mutex.count == 1:  # the first of several takes
                holdings.take(("lock", mutex), f"mutex {name}", lambda mutex=mutex: mutex.owner is task)  # type: ignore[misc]

    return {
        "mut_sem_take": lambda args, _: took(core.os.mut_sem_get_info(args[0]).name),
        "cond_var_lock": lambda args, _: took(CONDITION + core.os.cond_var_get_info(args[0]).name),
    }
