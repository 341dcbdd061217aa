"""Failures of C code, as exceptions."""

from __future__ import annotations

import re
from collections.abc import Callable

from cfepy.interpreter.host_system import signal_number


class CFault(Exception):
    """A processor exception in C code, or a bad address that it passed. Its text names the fault and the place.

    Attributes:
        called_from: the address to which the last call of that code returns; 0 for none.
        at: the address of the code at fault; 0 when that is not known.
        ends_process: whether NASA's process on Linux ends here; otherwise it is a finding of cfepy's alone, or SIGFPE,
            which NASA's PSP handles.
        is_anywhere: the code was stopped from outside, at a place that differs in each run, so its stack is not
            recorded.
        registers: of the code that it came from last, and whether that is in a call; see
            `cfepy.extra.c.unwinding.Unwinder`.
    """

    __module__ = "builtins"  # so that a report, which has 80 characters, begins with `CFault:`
    called_from = 0
    at = 0
    ends_process = False
    is_anywhere = False
    registers: tuple[bytes, bool] = (b"", False)


class CJump(CFault):
    """A longjmp() to code that called this one through cfepy. It is a fault if that code does not exist.

    Its arguments are the text of the fault, the buffer of setjmp() and the value.
    """

    __module__ = "builtins"

    def __str__(self) -> str:
        return str(self.args[0])


_BAD_ADDRESSES = frozenset({signal_number("SIGSEGV"), signal_number("SIGBUS")})
_WORDS = {
    signal_number("SIGSEGV"): "SIGSEGV (invalid or read-only memory)",
    signal_number("SIGBUS"): "SIGBUS (a bad address)",
    signal_number("SIGFPE"): "SIGFPE (such as a division by zero)",
    signal_number("SIGILL"): "SIGILL (invalid instruction)",
    signal_number("SIGTRAP"): "SIGTRAP (a trap that the compiler put there)",
}
_HANDLED = signal_number("SIGFPE")
"""The only signal of faults that CFE_PSP_SetDefaultExceptionEnvironment of NASA's Linux handles."""
_ENDING = re.compile(r"bad address |(abort|exit)\(|(free|realloc)\(\) of .* malloc did not give")
"""How the text of a fault of a call begins after which NASA's process ends."""
_NEAR_STACK = 1 << 16
_BAD_ADDRESS = re.compile("bad address (0x[0-9a-f]+)")


def explained(fault: CFault, place_of: Callable[[int], str], about: Callable[[int], str]) -> CFault:
    """Return a fault of the engine's in words, with the address of the code at fault.

    Args:
        fault: as the engine raised it: signal, address of the instruction, of the caller if the instruction is not in
            an application, address that was used, bytes from the stack's lowest to its pointer. Or a text: then the
            last call of the code is at fault.
        place_of: the place of an address of code: `CASE_Main (case.c:12)`.
        about: description of an address of data; empty when that is not known.
    """
    if len(fault.args) != 5:
        return _of_call(fault, place_of, about)
    number, pc, caller, address, left = fault.args
    words = _WORDS.get(number, f"signal {number}")
    if -_NEAR_STACK < left < 512 and number in _BAD_ADDRESSES:
        words = "stack overflow"
    at = caller - 1 if caller else pc  # a return address: the call is before it
    where = place_of(at)
    if caller:
        where = (
            f"a call by {where} of an address that is not a function"
            if pc == address
            else f"a function that {where} called"
        )
    used = ""
    if number in _BAD_ADDRESSES:
        block = about(address)
        used = f", address 0x{address:x}" + (f", {block}" if block else "")
    made = CFault(f"{words} in {where}{used}")
    made.at = at
    made.ends_process = number != _HANDLED
    return made


def _of_call(fault: CFault, place_of: Callable[[int], str], about: Callable[[int], str]) -> CFault:
    """Return a fault of a call's arguments with its place. A fault that has its place already is returned as it is."""
    if fault.at or not fault.called_from:
        return fault
    bad = _BAD_ADDRESS.match(str(fault))
    block = about(int(bad[1], 16)) if bad is not None else ""
    made = CFault(", ".join(filter(None, (str(fault), block, f"in {place_of(fault.called_from - 1)}"))))
    made.at = fault.called_from - 1
    made.ends_process = fault.ends_process or _ENDING.match(str(fault)) is not None
    return made
