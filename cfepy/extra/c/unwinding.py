"""The calls that C code is in: from the registers where it stopped through the frames of its stack, outwards.

Compilers write for each address of code where the frame of its function is, and where the registers of its caller are
kept: into .eh_frame, for exceptions and debuggers, also without debug data, with a table to search by address,
.eh_frame_hdr (DWARF 5, section 6.4, and the Linux Standard Base, chapter 10). pyelftools would read all of it, which
takes seconds for a library such as libstdc++; here a function's is read when it is asked for.
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
"""Calls that are told of a stack that has more."""
_DEEPEST = 1 << 14
_ADDRESS = (1 << 48) - 1
"""The rest of a return address may be a signature (aarch64, -mbranch-protection)."""
Value = Callable[[int], int]
"""Reads the uint64 at an address."""


class Rule(NamedTuple):
    """Where a register of the caller is.

    `kind` is "at" for memory at the frame's address and `offset` bytes, "is" for this address itself, "register" for
    the register of number `offset`. Where there is an `expression`, it gives the address instead. "gone" is not known.
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
    """Something that compilers do not write, or a register that is not known."""


class FrameInfo:
    """The call frame information of one shared object; addresses count from its base.

    Args:
        source: the object.
    """

    def __init__(self, source: SharedObject) -> None:
        self._source = source
        self._known: dict[int, FrameRow | None] = {}

    def row(self, address: int) -> FrameRow | None:
        """The rules at an address; None where nothing is known."""
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
        """Addresses of functions, and of what is written of each."""
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


# -- what is in the file -----------------------------------------------------------------------------------------------

_U32, _I32, _FROM_HERE, _FROM_TABLE = 0x03, 0x0B, 0x10, 0x30
_FORMS = {0x00: "<Q", 0x02: "<H", 0x03: "<I", 0x04: "<Q", 0x0A: "<h", 0x0B: "<i", 0x0C: "<q"}


class _Reader:
    """Reads a file on from an address; `back` is from there to the place in the file."""

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
        """A number of any size, seven bits a byte (LEB128)."""
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
        """The beginning of an entry: where it ends."""
        [size] = self.take("<I")
        if size in (0, 0xFFFFFFFF):
            raise BadFrameInfo(f"invalid entry size: {size} bytes")
        return self.address + size

    @property
    def is_done(self) -> bool:
        return self.address + self._back >= len(self._data)


class _Common:
    """What entries of several functions have in common (CIE)."""

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
    """The rules as the instructions change them from one address to the next.

    Args:
        code_step: bytes of code that addresses count in.
        data_step: bytes of the stack that offsets count in.
    """

    def __init__(self, code_step: int, data_step: int) -> None:
        self._code_step = code_step
        self._step = data_step
        self._frame: tuple[int, int, bytes] = (0, 0, b"")
        self._rules: dict[int, Rule] = {}
        self._first: dict[int, Rule] = {}
        self._kept: list[tuple[tuple[int, int, bytes], dict[int, Rule]]] = []

    def keep_first(self) -> None:
        """What instructions give back to a register is what it has now."""
        self._first = dict(self._rules)

    def row(self) -> FrameRow:
        """The rules as they are."""
        return FrameRow(*self._frame, self._rules)

    def run(self, instructions: bytes, at: int = 0, until: int = 0) -> None:
        """Execute those that hold at the address `until`, from that of the function on."""
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
            elif code == 0x2E:  # bytes of arguments, which only exceptions need
                reader.unsigned()
            elif code not in (0x00, 0x2D):  # nothing; the return address is signed from here on, or no longer
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
    """What an expression comes to; of its operations, those that compilers use here, for frames aligned on their own.

    Args:
        expression: the operations (DWARF 5, section 2.5).
        registers: by number.
        read: reads memory.
        first: what is on its stack before.

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
    """What an image tells of itself."""

    def frame_row(self, address: int) -> FrameRow | None:
        """How the frame at an address of code is found; None if that is not known."""


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

    def __init__(self, image_at: Callable[[int], FramedCode | None], memory: CMemory) -> None:
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
