"""The functions of libc and of the loader that the compilers' libraries (libstdc++, libgcc) and C++ code need.

Destructors of static objects run when their object is unloaded. Destructors of thread-local objects run when their task
returns. Exceptions are libgcc's, which asks here for the tables of a function.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import TYPE_CHECKING

from cfepy.extra.c.calls import DESCRIPTOR
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.engine import engine

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

FOUND_OBJECT = struct.Struct("<QQQQQ")
"""struct dl_find_object of glibc: flags, lowest and highest address, link map, address of the unwind table."""
OBJECT_INFO = struct.Struct("<QQQHxxxxxxQQQQ")
"""struct dl_phdr_info: base, name, headers, their number, loads, unloads, module and block of thread-locals."""
NOT_FOUND = -1
WAIT_MS = 1
"""Time until a task checks again whether another task has initialised a static variable."""

THROWN_WITHOUT_EXCEPTIONS = {
    "_ZSt17__throw_bad_allocv": "std::bad_alloc",
    "_ZSt25__throw_bad_function_callv": "std::bad_function_call",
    "_ZSt28__throw_bad_array_new_lengthv": "std::bad_array_new_length",
    "__cxa_throw_bad_array_new_length": "std::bad_array_new_length",
    "__cxa_pure_virtual": "a pure virtual function was called",
    "__cxa_deleted_virtual": "a deleted virtual function was called",
    "_ZSt9terminatev": "std::terminate()",
}
"""Functions of libstdc++ that never return, for code without exceptions that is not linked with it."""
THROWN_WITH_TEXT = {
    "_ZSt19__throw_logic_errorPKc": "std::logic_error",
    "_ZSt20__throw_length_errorPKc": "std::length_error",
    "_ZSt20__throw_out_of_rangePKc": "std::out_of_range",
    "_ZSt21__throw_runtime_errorPKc": "std::runtime_error",
    "_ZSt24__throw_invalid_argumentPKc": "std::invalid_argument",
}
RANDOM = ("arc4random", "getentropy", "getrandom")


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_lives(api, c)
    _declare_unwinding(api, c)
    for name, what in THROWN_WITHOUT_EXCEPTIONS.items():
        api.add(name, "", _failing(what))
    for name, what in THROWN_WITH_TEXT.items():
        api.add(name, "s", _failing_with(what))
    api.add("_ZSt24__throw_out_of_range_fmtPKcz", "f", _failing_with("std::out_of_range"))
    for name in RANDOM:
        api.add(name, "", _failing(f"{name}(): random numbers of the host differ in each run and are not available"))


def _declare_lives(api: Declarations, c: CRuntime) -> None:
    """Add functions for thread-local variables and for calls at an end."""
    memory, thread_locals = c.memory, c.thread_locals

    def tls_get_addr(index: int) -> int:
        return thread_locals.address(memory.u64(index), memory.u64(index + 8))

    api.add("__tls_get_addr", "p", tls_get_addr)
    api.add(DESCRIPTOR, "Q", lambda word: thread_locals.address(word >> 32, word & 0xFFFFFFFF))

    def wait_for_guard(guard: int) -> bool:
        while memory.u8(guard + 1):
            c.handle.os.task_delay(WAIT_MS)
        if memory.u8(guard):
            return False
        memory.poke(guard + 1, b"\1")
        return True

    api.add("__cxa_guard_acquire", "p", wait_for_guard)
    api.add("__errno_location", "", thread_locals.errno)
    api.add("__cxa_thread_atexit_impl", "pp-", thread_locals.at_end)
    api.add("__cxa_atexit", "ppp", c.ends.add)
    api.add("atexit", "P", lambda function: c.ends.add(function, 0, function), -1)
    api.add("__cxa_finalize", "p", c.ends.finalize)
    api.data["__libc_single_threaded"] = b"\1"
    api.data["__stack_chk_guard"] = engine().STACK_GUARD.to_bytes(8, "little")


def _declare_unwinding(api: Declarations, c: CRuntime) -> None:
    """Add functions that locate a function's tables, by which exceptions find its frames."""
    memory = c.memory
    rooms: list[int] = []

    def find_object(pc: int, found: int) -> int:
        image = c.image_at(pc)
        if image is None or not image.source.unwinding:
            return NOT_FOUND
        end = image.base + image.size
        memory.poke(found, FOUND_OBJECT.pack(0, image.base, end, 0, image.base + image.source.unwinding))
        return 0

    def iterate(callback: int, data: int) -> int:
        images = c.images()
        rooms[:] = rooms or [c.arena.map(OBJECT_INFO.size)]
        room = rooms[0]
        for image in images:
            at, count = image.source.headers
            name = c.constants.text(image.source.name)
            memory.poke(room, OBJECT_INFO.pack(image.base, name, image.base + at, count, len(images), 0, 0, 0))
            answer = c.status(callback, room, OBJECT_INFO.size, data)
            if answer:
                return answer
        return 0

    api.add("_dl_find_object", "pp", find_object)
    api.add("dl_iterate_phdr", "pp", iterate)


def _ending(text: str) -> CFault:
    """Return a fault in place of the end of the process."""
    fault = CFault(text)
    fault.ends_process = True
    return fault


def _failing(what: str) -> Callable[[], None]:
    def fail() -> None:
        raise _ending(what)

    return fail


def _failing_with(what: str) -> Callable[[str | None], None]:
    def fail(text: str | None) -> None:
        raise _ending(f"{what}: {text or ''}")

    return fail
