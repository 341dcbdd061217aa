"""The links of a loaded object: the API, libraries of the mission, and libraries of the host.

The libraries of the host come with its C++ compiler. They are loaded as all other code, so they use the memory, the
files and the clock of the simulation, and exceptions pass through them. Each application has its own copies, as if they
were linked into it, so their state ends with it.
"""

from __future__ import annotations

import os
import sysconfig
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Protocol

from cfepy.extra.c.calls import DESCRIPTOR, CallTable, Declarations
from cfepy.extra.c.elf import ElfError, SharedObject, read_shared_object
from cfepy.extra.c.image import Image
from cfepy.extra.c.lifetimes import ThreadLocals
from cfepy.extra.c.memory import CMemory
from cfepy.extra.c.refused import REASONS
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import OBJECT_BYTES

LIBRARIES = ("libgcc_s.so.1", "libstdc++.so.6")
"""In the order in which they are loaded."""
IN_IT = "__cxa_throw"
"""A symbol of objects with a statically linked libstdc++."""
UNUSED = frozenset(
    (
        *("__strftime_l", "__wcscoll_l", "__wcsftime_l", "__wcsxfrm_l", "bind_textdomain_codeset"),
        *("bindtextdomain", "dgettext", "iconv", "iconv_close", "iconv_open", "mbsnrtowcs", "putwc", "ungetwc"),
        "wcsnrtombs",
    )
)
"""libc functions of libstdc++ for other locales and wide characters, which cfepy does not provide."""
GUARDS = ("__cxa_guard_acquire", "__cxa_guard_release", "__cxa_guard_abort")
"""Functions that libstdc++ also has; the API's versions know waits of tasks and their order."""
STAND_INS = frozenset(("arc4random", "getentropy", "getrandom"))
"""Refused functions that there is something of, for libstdc++."""
C_LIBRARIES = ("libc.so.6", "libm.so.6")
"""The libraries of NASA's core-cpu1 whose functions all code sees."""
NASAS = ("CFE_", "OS_")
"""How names begin that only cFE, OSAL and the PSP define, so that NASA's loader finds none either."""
STATIC = "-static-libstdc++ -static-libgcc"
FOLDERS = ("/lib", "/usr/lib", "/lib64", "/usr/lib64")


def find_library(name: str) -> Path | None:
    """Return the file of a library as the host's loader finds it: LD_LIBRARY_PATH, then the usual folders."""
    triplet = sysconfig.get_config_var("MULTIARCH") or ""
    given = [each for each in os.environ.get("LD_LIBRARY_PATH", "").split(":") if each]
    usual = [f"{folder}/{triplet}" for folder in FOLDERS[:2] if triplet]
    return next((file for folder in (*given, *usual, *FOLDERS) if (file := Path(folder) / name).is_file()), None)


@cache
def host_library(name: str) -> SharedObject:
    """Return a library of the host, read once.

    Raises:
        ElfError: it does not exist, or is for another computer.
    """
    file = find_library(name)
    if file is None:
        raise ElfError(
            f"library {name} not found on this computer; link the object with {STATIC} so that it is not needed"
        )
    return read_shared_object(read_limited(file, OBJECT_BYTES), file.name)


def wanted_names(source: SharedObject) -> list[str]:
    """Return the names that an object needs and that libraries of the host do not define.

    Raises:
        ElfError: one of those libraries does not exist.
    """
    names = source.wanted()
    if any(each.is_defined and each.name == IN_IT for each in source.symbols):
        names = [name for name in names if name not in UNUSED]
    for library in LIBRARIES:
        if library in source.needed:
            exported = {each.name for each in host_library(library).symbols if each.is_defined}
            names = [name for name in names if name not in exported]
    return names


def refused_names(source: SharedObject) -> set[str]:
    """Return the names in `wanted_names` that bring in the host, so that a call is a fault.

    The functions that libgcov and a statically linked libstdc++ need are provided, and do not count as its own.
    It raises the errors of `wanted_names`.
    """
    found = {name for name in wanted_names(source) if name in REASONS}
    has_libraries = source.has_coverage or any(each.is_defined and each.name == IN_IT for each in source.symbols)
    return found - STAND_INS if has_libraries else found


def undefined_on_linux(source: SharedObject, missing: list[str]) -> list[str]:
    """Return the missing names that NASA's Linux does not define either, so that dlopen refuses the object.

    Args:
        source: the object.
        missing: names that it needs and that are defined nowhere here.
    """
    if not missing or set(source.needed) - {*LIBRARIES, *C_LIBRARIES}:
        return [name for name in missing if name.startswith(NASAS)]  # another library that it needs may have the others
    try:
        known = {each.name for library in C_LIBRARIES for each in host_library(library).symbols if each.is_defined}
    except ElfError:  # this computer has another C library
        return [name for name in missing if name.startswith(NASAS)]
    known |= set(REASONS)
    return [name for name in missing if name not in known]


class Exports:
    """Names that all code can see.

    Args:
        shared: returns the loaded images that all code sees.
        calls: the functions of the API.
        declared: the declarations of the API.
        map_memory: returns memory of a size.
    """

    def __init__(
        self,
        shared: Callable[[], list[Image]],
        calls: CallTable,
        declared: Declarations,
        map_memory: Callable[[int], int],
    ) -> None:
        self.shared = shared
        self.calls = calls
        self.declared = declared
        self._map = map_memory
        self._memory = CMemory()
        self._variables: dict[str, int] = {}

    def declared_symbol(self, name: str) -> int | None:
        """Return a function or variable of the API or of libc; None if there is none of this name."""
        if name in self.declared.places:
            return self.declared.places[name]
        if name in self.declared.data:
            return self._variable(name)
        return self.calls.address(name) if name in self.declared else None

    def symbol(self, name: str, more: tuple[Image, ...] = (), used: set[Image] | None = None) -> int | None:
        """Return the address of a name, in libraries first; None if it is undefined.

        Args:
            name: the name.
            more: libraries of the host that have it too.
            used: gets the object that has the name.
        """
        if name in GUARDS:
            return self.declared_symbol(name)
        for image in (*self.shared(), *more):
            if name in image.symbols:
                if used is not None:
                    used.add(image)
                return image.symbols[name]
        return self.declared_symbol(name)

    def _variable(self, name: str) -> int:
        if name not in self._variables:
            first = self.declared.data[name]
            at = self._variables[name] = self._map(len(first))
            self._memory.poke(at, first)
        return self._variables[name]


class _Run(Protocol):
    def __call__(self, function: int, *args: int) -> int: ...


class LinkedWith:
    """The links of one object; see `cfepy.extra.c.image.Linker`.

    Args:
        exports: names that all code sees.
        thread_locals: of the processor.
        own: libraries of the host that belong to it.
        run: calls a function of C.
        used: gets the objects whose names it uses.
    """

    def __init__(
        self, exports: Exports, thread_locals: ThreadLocals, own: tuple[Image, ...], run: _Run, used: set[Image]
    ) -> None:
        self._exports = exports
        self._thread_locals = thread_locals
        self._own = own
        self.run = run
        self._used = used

    def resolve(self, name: str) -> int:
        """Return the address; see `Linker`. A call of an undefined function is a fault of the caller."""
        found = self._exports.symbol(name, self._own, self._used)
        return self._exports.calls.address(name) if found is None else found

    def resolve_weak(self, name: str) -> int:
        return self._exports.symbol(name, self._own, self._used) or 0

    def of_library(self, name: str) -> int | None:
        image = next((each for each in self._exports.shared() if name in each.symbols), None)
        if image is None:
            return None
        self._used.add(image)
        return image.symbols[name]

    def resolve_thread_local(self, name: str) -> tuple[int, int]:
        """Return module and offset; see `Linker`.

        Raises:
            ElfError: no library has the variable.
        """
        for image in self._seen():
            if name in image.thread_locals:
                self._used.add(image)
                return self.module_of(image), image.thread_locals[name]
        raise ElfError(f"undefined thread-local variable {name}")

    def thread_local_function(self) -> int:
        return self._exports.calls.address(DESCRIPTOR)

    def module_of(self, image: Image) -> int:
        return self._thread_locals.module_of(image)

    def _seen(self) -> Iterator[Image]:
        yield from self._exports.shared()
        yield from self._own
