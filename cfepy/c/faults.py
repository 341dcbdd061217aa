"""What goes wrong in C code, as exceptions."""

from __future__ import annotations

import signal
from collections.abc import Callable


class CFault(Exception):
    """A processor exception in C code, or a bad address that it handed over: its text tells what and where."""


_WORDS = {
    signal.SIGSEGV: "SIGSEGV (no such memory, or not to be written)",
    signal.SIGBUS: "SIGBUS (a bad address)",
    signal.SIGFPE: "SIGFPE (such as a division by zero)",
    signal.SIGILL: "SIGILL (no such instruction)",
}
_NEAR_STACK = 1 << 16


def explained(fault: CFault, place_of: Callable[[int], str]) -> CFault:
    """A fault of the engine's, in words.

    Args:
        fault: as the engine raised it: signal, address of the instruction, of the caller if the instruction is none
            of an application's, address that was used, bytes from the stack's lowest to its pointer. Or a text.
        place_of: where an address of code is: `CASE_Main+0x10 (case.c:12)`.
    """
    if len(fault.args) != 5:
        return fault
    number, pc, caller, address, left = fault.args
    words = _WORDS.get(number, f"signal {number}")
    if -_NEAR_STACK < left < 512 and number in (signal.SIGSEGV, signal.SIGBUS):
        words = "stack overflow"
    if not caller:
        where = place_of(pc)
    else:
        by = place_of(caller - 1)  # it is a return address: the call is before it
        where = f"a call by {by} of what is no function" if pc == address else f"a function that {by} called"
    used = f", address 0x{address:x}" if number in (signal.SIGSEGV, signal.SIGBUS) else ""
    return CFault(f"{words} in {where}{used}")
