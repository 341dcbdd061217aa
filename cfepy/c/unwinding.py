"""The calls that C code is in: from the registers where it stopped through the frames of its stack, outwards."""

from __future__ import annotations

import platform
import struct
from collections.abc import Callable, Iterator
from typing import NamedTuple

from cfepy.c.faults import CFault
from cfepy.c.frame_info import BadFrameInfo, FrameRow, Rule, value_of
from cfepy.c.image import Image
from cfepy.c.memory import CMemory

INNERMOST, OUTERMOST = 24, 8
"""Calls that are told of a stack that has more."""
_DEEPEST = 1 << 14
_64_BITS = (1 << 64) - 1
_ADDRESS = (1 << 48) - 1
"""The rest of a return address may be a signature (aarch64, -mbranch-protection)."""


class _Machine(NamedTuple):
    """Numbers of registers, and whether a call pushes the return address."""

    stack_pointer: int
    return_address: int
    pc: int
    calls_push: bool


_MACHINES = {"x86_64": _Machine(7, 16, 16, True), "aarch64": _Machine(31, 30, 32, False)}


class Unwinder:
    """Finds the calls that code of one processor is in.

    Args:
        image_at: the image that an address is in.
        memory: of C.
    """

    def __init__(self, image_at: Callable[[int], Image | None], memory: CMemory) -> None:
        self._image_at = image_at
        self._memory = memory
        self._machine = _MACHINES[platform.machine()]

    def calls(self, registers: bytes, is_call: bool) -> list[int]:
        """Addresses of code, the outermost first: in each function, that of its call, and last where the code stopped.

        Where the stack makes no sense, as one that was written over, the list begins behind that.

        Args:
            registers: uint64s by their numbers of DWARF, with the program counter, as the engine tells them.
            is_call: the code stopped in a call: the program counter is where that returns to.
        """
        known = dict(enumerate(struct.unpack(f"<{len(registers) // 8}Q", registers)))
        found = list(self._frames(known, is_call))[::-1]
        return found if len(found) <= OUTERMOST + INNERMOST else [*found[:OUTERMOST], *found[-INNERMOST:]]

    def _frames(self, registers: dict[int, int], is_call: bool) -> Iterator[int]:
        machine = self._machine
        try:
            if self._image_at(registers[machine.pc]) is None:  # what is no function was called: it has no frame
                self._return(registers)
                is_call = True
            for _ in range(_DEEPEST):
                at = registers[machine.pc] - is_call
                image = self._image_at(at)
                if image is None:
                    return
                yield at
                row = image.frame_row(at)
                if row is None:
                    return
                below = registers[machine.stack_pointer]
                registers = self._caller(row, registers)
                if registers[machine.stack_pointer] <= below - (not is_call):  # in the first, there may be no frame yet
                    return
                is_call = True
        except (CFault, BadFrameInfo, KeyError):  # memory that is not there, registers that are not known
            return

    def _return(self, registers: dict[int, int]) -> None:
        machine = self._machine
        if machine.calls_push:
            registers[machine.pc] = self._memory.u64(registers[machine.stack_pointer])
            registers[machine.stack_pointer] += 8
        else:
            registers[machine.pc] = registers[machine.return_address] & _ADDRESS

    def _caller(self, row: FrameRow, registers: dict[int, int]) -> dict[int, int]:
        """The registers of the caller, as far as they are known."""
        machine = self._machine
        if row.expression:
            frame = value_of(row.expression, registers, self._memory.u64)
        else:
            frame = registers[row.register] + row.offset & _64_BITS
        made = dict(registers)
        for number, rule in row.rules.items():
            if rule.kind == "gone":
                made.pop(number, None)
            else:
                made[number] = self._kept(rule, frame, registers)
        made[machine.pc] = made[machine.return_address] & _ADDRESS
        made[machine.stack_pointer] = frame
        return made

    def _kept(self, rule: Rule, frame: int, registers: dict[int, int]) -> int:
        if rule.kind == "register":
            return registers[rule.offset]
        at = frame + rule.offset & _64_BITS
        if rule.expression:
            at = value_of(rule.expression, registers, self._memory.u64, frame)
        return self._memory.u64(at) if rule.kind == "at" else at
