"""The functions that C code can call: the declarations of the API, and the stubs in the arena for its calls."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cfepy.extra.c.arena import PAGE, Arena
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.engine import engine
from cfepy.extra.c.refused import REASONS

STUB = 32
"""Bytes of a stub."""
DESCRIPTOR = "(thread-local)"
"""The function in descriptors of thread-local variables on aarch64, with a special calling convention."""
_STUB_PAGES = 16 * PAGE


class Declared(NamedTuple):
    """A function of the API: its Python function, its signature, and its status for a NULL pointer.

    `signature` has a letter for each parameter; the head of `engine/calls.c` lists them. `on_null` is called before a
    NULL is answered, with the first three arguments as they are, for example for an event.
    """

    function: Callable[..., object] | None
    signature: str
    null_status: int
    on_null: Callable[[int, int, int], object] | None = None


_LIBC_VARIABLES = {"signgam": 8, "daylight": 12, "timezone": 16, "tzname": 24}
_LIBC_VARIABLES |= {f"__{name}": offset for name, offset in _LIBC_VARIABLES.items()}
"""Offsets in `LibcState` of engine/natives.h; linkers add the second names."""


class Declarations:
    """The functions of the API, by name.

    Attributes:
        functions: the declared functions.
        data: variables of libc, by name: their first value.
        places: variables of libc that the engine has, by name: their addresses.

    Args:
        libc: address of the state of libc.
    """

    def __init__(self, libc: int = 0) -> None:
        self.places = {name: libc + offset for name, offset in _LIBC_VARIABLES.items()}
        self.functions: dict[str, Declared] = {name: Declared(None, "", 0) for name in engine().natives()}
        self.data: dict[str, bytes] = {}

    def add(
        self,
        name: str,
        signature: str,
        function: Callable[..., object],
        null_status: int = 0,
        on_null: Callable[[int, int, int], object] | None = None,
    ) -> None:
        """Declare a function. If the engine has it as well, Python is called only when the engine requests it."""
        self.functions[name] = Declared(function, signature, null_status, on_null)

    def __contains__(self, name: str) -> bool:
        return name in self.functions or name in self.data or name in self.places


class CallTable:
    """The functions that were requested so far, each behind its own stub.

    Args:
        arena: memory for the stubs.
        table: the engine's table.
        declared: the API.
    """

    def __init__(self, arena: Arena, table: Any, declared: Declarations) -> None:
        self._arena = arena
        self._table = table
        self._declared = declared
        self._stubs: dict[str, int] = {}
        self._next = self._end = 0
        table.end = self._room()
        engine().make_end(table.end)

    def address(self, name: str) -> int:
        """Return the address for calls of a function. A call of an undefined function is a fault of the caller."""
        stub = self._stubs.get(name)
        if stub is None:
            stub = self._stubs[name] = self._make(name)
        return stub

    def name_at(self, address: int) -> str | None:
        """Return the function whose stub is at an address."""
        return next((name for name, at in self._stubs.items() if at <= address < at + STUB), None)

    def _make(self, name: str) -> int:
        declared = self._declared.functions.get(name) or Declared(_absent(name), "", 0)
        number = self._table.add(name, declared.function, declared.signature, declared.null_status, declared.on_null)
        stub = self._room()
        engine().make_stub(stub, number, name == DESCRIPTOR)
        return stub

    def _room(self) -> int:
        if self._next == self._end:
            self._next = self._arena.map(_STUB_PAGES)
            self._end = self._next + _STUB_PAGES
            engine().protect(self._next, _STUB_PAGES, 7)
        self._next += STUB
        return self._next - STUB


def _absent(name: str) -> Callable[[], object]:
    def fail() -> None:
        instead = f"; {REASONS[name]}" if name in REASONS else ""
        raise CFault(f"{name}() was called, but cfepy and the libraries of the mission do not define it{instead}")

    return fail
