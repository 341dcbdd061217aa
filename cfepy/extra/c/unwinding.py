"""The call stack of C code: from the registers where it stopped through the frames of its stack, outwards.

For each address of code, compilers write the place of the function's frame and of the caller's registers into
.eh_frame. It exists also without debug data, for exceptions and debuggers. The table .eh_frame_hdr allows a search by
address (DWARF 5, section 6.4, and the Linux Standard Base, chapter 10). pyelftools would read all of it, which takes
seconds for a library such as libstdc++. Here a function's part is read when it is needed.
"""

from __future__ import annotations

import platform
import struct
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple, Protocol

from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.elf import SharedObject
from cfepy.extra.c.memory import CMemory
from cfepy.interpreter.cached import CachedProperty

INNERMOST, OUTERMOST = 24, 8
"""Calls in the report of a deeper stack."""
_DEEPEST = 1 << 14
_ADDRESS = (1 << 48) - 1
"""The rest of a return address may be a signature (aarch64, -mbranch-protection)."""
Value = Callable[[int], int]
"""Reads the uint64 at an address."""


class Rule(NamedTuple):
    """The place of a register of the caller.

    `kind` is "at" for memory at the frame's address plus `offset` bytes, "is" for this address itself, "register" for
    the register of number `offset`. An `expression`, if there is one, gives the address instead. "gone" is not known.
    """

    kind: str
    offset: int = 0
    expression: bytes = b""


class FrameRow(NamedTuple):
    """The rules at an address of code: the frame's address is a register and an offset, or an expression."""

    register: int
    offset: int
    expression: bytes
    rules: Mapping[int, Rule]


class BadFrameInfo(Exception):
    """Frame information that compilers do not write, or a register that is not known."""


class FrameInfo:
    """The call frame information of one shared object; addresses count from its base.

    Args:
        source: the object.
    """

    def __init__(self, source: SharedObject) -> None:
        self._source = source
        self._known: dict[int, FrameRow | None] = {}

    def row(self, address: int) -> FrameRow | None:
        """Return the rules at an address; None if there are none."""
        if address not in self._known:
            try:
                self._known[address] = self._read(address)
            except (BadFrameInfo, IndexError, struct.error):
                self._known[address] = None
        return self._known[address]

    def _reader(self, address: int) -> _Reader:
        for each in self._source.segments:
            if each.address <= address < each.address + each.file_size:
                return _Reader(self._source.data, address, each.offset - each.address)
        raise BadFrameInfo(f"0x{address:x} is not in the file")

    @CachedProperty
    def _functions(self) -> tuple[list[int], list[int]]:
        """Addresses of functions, and of their entries."""
        start = self._source.unwinding
        reader = self._reader(start)
        version, frames, counted, table = reader.take("<4B")
        if (version, counted, table) != (1, _U32, _FROM_TABLE | _I32):
            raise BadFrameInfo(f"unknown form of table {version} {counted:#x} {table:#x}")
        reader.pointer(frames)
        [count] = reader.take("<I")
        pairs = [start + each for each in reader.take(f"<{2 * count}i")]
        return pairs[::2], pairs[1::2]

    def _read(self, address: int) -> FrameRow | None:
        if not self._source.unwinding:
            return None
        starts, places = self._functions
        number = bisect_right(starts, address) - 1
        if number < 0:
            return None
        reader = self._reader(places[number])
        end = reader.entry()
        [back] = reader.take("<I")
        common = _Common(self._reader(reader.address - 4 - back))
        first = reader.pointer(common.encoding)
        if not first <= address < first + reader.pointer(common.encoding & 0x0F):
            return None
        if common.is_augmented:
            reader.skip(reader.unsigned())
        rules = _Rules(common.code_step, common.data_step)
        rules.run(common.instructions)
        rules.keep_first()
        rules.run(reader.piece(end - reader.address), first, address)
        return rules.row()


# -- contents of the file ----------------------------------------------------------------------------------------------

_U32, _I32, _FROM_HERE, _FROM_TABLE = 0x03, 0x0B, 0x10, 0x30
_FORMS = {0x00: "<Q", 0x02: "<H", 0x03: "<I", 0x04: "<Q", 0x0A: "<h", 0x0B: "<i", 0x0C: "<q"}


class _Reader:
    """Reads a file from an address on; `back` is the offset from the address to the place in the file."""

    def __init__(self, data: bytes, address: int = 0, back: int = 0) -> None:
        self._data = data
        self.address = address
        self._back = back

    def take(self, form: str) -> tuple[int, ...]:
        found = struct.unpack_from(form, self._data, self.address + self._back)
        self.skip(struct.calcsize(form))
        return found

    def byte(self) -> int:
        self.address += 1
        return self._data[self.address - 1 + self._back]

    def piece(self, size: int) -> bytes:
        at = self.address + self._back
        self.skip(size)
        return self._data[at : at + size]

    def skip(self, size: int) -> None:
        self.address += size

    def unsigned(self) -> int:
        """Return a number of any size, seven bits a byte (LEB128)."""
        value = shift = 0
        while True:
            byte = self.byte()
            value |= (byte & 0x7F) << shift
            shift += 7
            if not byte & 0x80:
                return value

    def signed(self) -> int:
        first = self.address
        value = self.unsigned()
        bits = 7 * (self.address - first)
        return value - (value >> bits - 1 << bits)

    def block(self) -> bytes:
        return self.piece(self.unsigned())

    def text(self) -> bytes:
        at = self.address + self._back
        size = self._data.index(b"\0", at) - at
        return self.piece(size + 1)[:size]

    def pointer(self, encoding: int) -> int:
        here = self.address
        if encoding & 0x0F not in _FORMS or encoding & 0x70 not in (0, _FROM_HERE):
            raise BadFrameInfo(f"unknown form of pointer {encoding:#x}")
        [value] = self.take(_FORMS[encoding & 0x0F])
        return value + (here if encoding & _FROM_HERE else 0)

    def entry(self) -> int:
        """Begin an entry. Returns the address of its end."""
        [size] = self.take("<I")
        if size in (0, 0xFFFFFFFF):
            raise BadFrameInfo(f"invalid entry size: {size} bytes")
        return self.address + size

    @property
    def is_done(self) -> bool:
        return self.address + self._back >= len(self._data)


class _Common:
    """The part that entries of several functions share (CIE)."""

    def __init__(self, reader: _Reader) -> None:
        end = reader.entry()
        _, version = reader.take("<IB")
        letters = reader.text()
        self.is_augmented = letters.startswith(b"z")
        self.code_step = reader.unsigned()
        self.data_step = reader.signed()
        _ = reader.byte() if version == 1 else reader.unsigned()  # the register of the return address, one a processor
        self.encoding = 0
        if self.is_augmented:
            reader.unsigned()
        for letter in letters[1:].decode("latin-1"):
            if letter == "R":
                self.encoding = reader.byte()
            elif letter == "L":
                reader.byte()
            elif letter == "P":
                reader.pointer(reader.byte() & 0x7F)
            elif letter not in "SB":
                raise BadFrameInfo(f"augmentation {letter}")
        self.instructions = reader.piece(end - reader.address)


class _Rules:
    """The rules, as the instructions change them from one address to the next.

    Args:
        code_step: unit of addresses, in bytes of code.
        data_step: unit of offsets, in bytes of the stack.
    """

    def __init__(self, code_step: int, data_step: int) -> None:
        self._code_step = code_step
        self._step = data_step
        self._frame: tuple[int, int, bytes] = (0, 0, b"")
        self._rules: dict[int, Rule] = {}
        self._first: dict[int, Rule] = {}
        self._kept: list[tuple[tuple[int, int, bytes], dict[int, Rule]]] = []

    def keep_first(self) -> None:
        """Save the current rules, to which instructions can restore a register."""
        self._first = dict(self._rules)

    def row(self) -> FrameRow:
        """Return the current rules."""
        return FrameRow(*self._frame, self._rules)

    def run(self, instructions: bytes, at: int = 0, until: int = 0) -> None:
        """Execute the instructions for the addresses from `at`, the function's address, to `until`."""
        reader = _Reader(instructions)
        while not reader.is_done and at <= until:
            code = reader.byte()
            if code >> 6 == 1:
                at += (code & 0x3F) * self._code_step
            elif code in _ADVANCES:
                at += reader.take(_ADVANCES[code])[0] * self._code_step
            elif code >> 6 == 2:
                self._rules[code & 0x3F] = Rule("at", reader.unsigned() * self._step)
            elif code >> 6 == 3:
                self._restore(code & 0x3F)
            elif 0x0C <= code <= 0x0F or code in (0x12, 0x13):
                self._change_frame(code, reader)
            elif code == 0x0A:
                self._kept.append((self._frame, dict(self._rules)))
            elif code == 0x0B:
                self._frame, self._rules = self._kept.pop()
            elif code == 0x2E:  # bytes of arguments, used only by exceptions
                reader.unsigned()
            elif code not in (0x00, 0x2D):  # no operation; a change of the return address's signing
                self._change_rule(code, reader)

    def _restore(self, register: int) -> None:
        if register in self._first:
            self._rules[register] = self._first[register]
        else:
            self._rules.pop(register, None)

    def _change_frame(self, code: int, reader: _Reader) -> None:
        register, offset, _ = self._frame
        if code == 0x0F:
            self._frame = (0, 0, reader.block())
            return
        if code in (0x0C, 0x0D, 0x12):
            register = reader.unsigned()
        if code in (0x0C, 0x0E):
            offset = reader.unsigned()
        elif code in (0x12, 0x13):
            offset = reader.signed() * self._step
        self._frame = (register, offset, b"")

    def _change_rule(self, code: int, reader: _Reader) -> None:
        register = reader.unsigned()
        if code == 0x06:
            self._restore(register)
        elif code == 0x08:
            self._rules.pop(register, None)
        elif code == 0x07:
            self._rules[register] = Rule("gone")
        elif code == 0x09:
            self._rules[register] = Rule("register", reader.unsigned())
        elif code in (0x05, 0x14):
            self._rules[register] = Rule("at" if code == 0x05 else "is", reader.unsigned() * self._step)
        elif code in (0x11, 0x15):
            self._rules[register] = Rule("at" if code == 0x11 else "is", reader.signed() * self._step)
        elif code in (0x10, 0x16):
            self._rules[register] = Rule("at" if code == 0x10 else "is", 0, reader.block())
        else:
            raise BadFrameInfo(f"instruction {code:#x}")


_ADVANCES = {0x02: "<B", 0x03: "<H", 0x04: "<I"}


# -- expressions -------------------------------------------------------------------------------------------------------


def value_of(expression: bytes, registers: Mapping[int, int], read: Value, *first: int) -> int:
    """Evaluate an expression. Only the operations that compilers use here are supported, for self-aligned frames.

    Args:
        expression: the operations (DWARF 5, section 2.5).
        registers: by number.
        read: reads memory.
        first: initial values on its stack.

    Raises:
        BadFrameInfo: it has another operation, or needs a register that is not known.
    """
    stack, reader = list(first), _Reader(expression)
    while not reader.is_done:
        code = reader.byte()
        if 0x30 <= code <= 0x4F:
            stack.append(code - 0x30)
        elif 0x70 <= code <= 0x8F and code - 0x70 in registers:
            stack.append(registers[code - 0x70] + reader.signed())
        elif code == 0x06:
            stack.append(read(stack.pop() & _64_BITS))
        elif code in (0x08, 0x09):
            stack.append(reader.take("<B" if code == 0x08 else "<b")[0])
        elif code == 0x10:
            stack.append(reader.unsigned())
        elif code == 0x11:
            stack.append(reader.signed())
        elif code == 0x23:
            stack[-1] += reader.unsigned()
        elif code in _BINARY:
            second = stack.pop()
            stack[-1] = _BINARY[code](stack[-1], second)
        else:
            raise BadFrameInfo(f"operation {code:#x}")
    return stack[-1] & _64_BITS


_64_BITS = (1 << 64) - 1
_BINARY: dict[int, Callable[[int, int], int]] = {
    0x1A: lambda one, two: one & two,
    0x1C: lambda one, two: one - two,
    0x22: lambda one, two: one + two,
    0x24: lambda one, two: one << (two & 63),
    0x2A: lambda one, two: one >= two,
}


# -- frames ------------------------------------------------------------------------------------------------------------


class FramedCode(Protocol):
    """The interface of an image for unwinding."""

    def frame_row(self, address: int) -> FrameRow | None:
        """Return the rules for the frame at an address of code; None if they are not known."""


class _Machine(NamedTuple):
    """Numbers of registers, and whether a call pushes the return address."""

    stack_pointer: int
    return_address: int
    pc: int
    calls_push: bool


_MACHINES = {"x86_64": _Machine(7, 16, 16, True), "aarch64": _Machine(31, 30, 32, False)}


class Unwinder:
    """Finds the call stack of a processor's code.

    Args:
        image_at: returns the image that contains an address.
        memory: of C.
    """

    def __init__(self, image_at: Callable[[int], FramedCode | None], memory: CMemory) -> None:
        self._image_at = image_at
        self._memory = memory
        self._machine = _MACHINES[platform.machine()]

    def calls(self, registers: bytes, is_call: bool) -> list[int]:
        """Return addresses of code, the outermost first: the call in each function, and at last the place of the stop.

        If the stack is invalid, for example overwritten, the list begins after that point.

        Args:
            registers: uint64s by their numbers of DWARF, with the program counter, from the engine.
            is_call: the code stopped in a call, so the program counter is its return address.
        """
        known = dict(enumerate(struct.unpack(f"<{len(registers) // 8}Q", registers)))
        found = list(self._frames(known, is_call))[::-1]
        return found if len(found) <= OUTERMOST + INNERMOST else [*found[:OUTERMOST], *found[-INNERMOST:]]

    def _frames(self, registers: dict[int, int], is_call: bool) -> Iterator[int]:
        machine = self._machine
        try:
            if self._image_at(registers[machine.pc]) is None:  # a called address that is not a function: no frame
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
        except (CFault, BadFrameInfo, KeyError):  # missing memory, unknown registers
            return

    def _return(self, registers: dict[int, int]) -> None:
        machine = self._machine
        if machine.calls_push:
            registers[machine.pc] = self._memory.u64(registers[machine.stack_pointer])
            registers[machine.stack_pointer] += 8
        else:
            registers[machine.pc] = registers[machine.return_address] & _ADDRESS

    def _caller(self, row: FrameRow, registers: dict[int, int]) -> dict[int, int]:
        """Return the registers of the caller, as far as they are known."""
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
