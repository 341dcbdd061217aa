"""A shared object in memory, loaded by cfepy itself, so that its address is the same in each run.

The host's loader would use another address in each run, share its variables between missions of one process, and take
names from any library of the host. Here each load is a fresh copy, sees exactly the symbols that it is given, and ends
when it is unmapped.
"""

from __future__ import annotations

import re
import struct
from typing import Protocol

from cfepy.extra.c.arena import PAGE, Arena
from cfepy.extra.c.elf import ElfError, Relocation, SharedObject, Symbol
from cfepy.extra.c.engine import engine
from cfepy.extra.c.source_places import CodePlace, Places, places_of
from cfepy.extra.c.unwinding import FrameInfo, FrameRow
from cfepy.interpreter.cached import CachedProperty

_RELATIVE, _ABSOLUTE, _ADDRESS, _CHOSEN = "relative", "absolute", "address", "chosen"
_MODULE, _OFFSET, _FIXED_OFFSET, _DESCRIPTOR = "module", "offset", "fixed offset", "descriptor"
_KINDS = {
    "x86_64": {
        1: _ABSOLUTE, 6: _ADDRESS, 7: _ADDRESS, 8: _RELATIVE, 37: _CHOSEN, 16: _MODULE, 17: _OFFSET, 18: _FIXED_OFFSET
    },
    "aarch64": {
        257: _ABSOLUTE, 1025: _ABSOLUTE, 1026: _ABSOLUTE, 1027: _RELATIVE, 1032: _CHOSEN,
        1028: _MODULE, 1029: _OFFSET, 1030: _FIXED_OFFSET, 1031: _DESCRIPTOR,
    },
}  # fmt: skip
_X86_DESCRIPTOR = 36
_THREAD_LOCAL = "STT_TLS"
_CHOSEN_FUNCTION = "STT_GNU_IFUNC"
_THREAD_POINTER = re.compile(rb"[\x40-\x5f]\xd0\x3b\xd5")
_ZERO = 0xD2800000
_EXECUTE = 1
_WORD = struct.Struct("<Q")
_64_BITS = (1 << 64) - 1


def without_thread_pointer(code: bytes) -> bytes:
    """Return aarch64 code that gets 0 for the thread pointer (mrs xN, tpidr_el0 becomes mov xN, 0).

    The register has an address of the host's thread, which differs in each run. Compilers keep it for the thread-local
    variables of a whole function, so each called function leaves it on its stack. With 0, a descriptor returns the
    address of the variable itself. The register itself cannot be changed meanwhile, because signal handlers, such as
    Python's, use it.
    """
    made = bytearray(code)
    for found in _THREAD_POINTER.finditer(code):
        if found.start() % 4 == 0:
            struct.pack_into("<I", made, found.start(), _ZERO | code[found.start()] & 0x1F)
    return bytes(made)


class Linker(Protocol):
    """The symbols of other objects that an image can use."""

    def resolve(self, name: str) -> int:
        """Return the address of a symbol that the image does not have itself."""

    def resolve_weak(self, name: str) -> int:
        """Return the address of a symbol that may be missing; 0 if it is."""

    def of_library(self, name: str) -> int | None:
        """Return the address of a symbol in the libraries that all code sees; None if they do not have it."""

    def resolve_thread_local(self, name: str) -> tuple[int, int]:
        """Return module and offset of a thread-local variable of another object."""

    def thread_local_function(self) -> int:
        """Return the function that a descriptor of a thread-local variable calls (aarch64)."""

    def module_of(self, image: Image) -> int:
        """Return the number of an image's thread-local variables."""

    def run(self, function: int, *args: int) -> int:
        """Call a function of the image, which is in its place by then."""


class Image:
    """A loaded object.

    Args:
        source: its file.
        arena: memory for it.
        linker: gives symbols of other objects.

    Attributes:
        base: its lowest address.
        size: its bytes.
        symbols: addresses of its exports.
        thread_locals: offsets of its exported thread-local variables.
        replaced: its own symbols in place of which it uses a library's symbols.

    Raises:
        ElfError: it needs a loader feature that this one does not have.
    """

    def __init__(self, source: SharedObject, arena: Arena, linker: Linker) -> None:
        self.source = source
        self.size = source.size
        self.symbols: dict[str, int] = {}
        self.thread_locals: dict[str, int] = {}
        self.replaced: list[str] = []
        self._arena = arena
        self._linker = linker
        self._engine = engine()
        self.base = arena.map(self.size)
        try:
            self._fill()
        except BaseException:
            self.unload()
            raise

    def _fill(self) -> None:
        source, base = self.source, self.base
        for segment in source.segments:
            data = source.data[segment.offset : segment.offset + segment.file_size]
            if source.machine == "aarch64" and segment.rights & _EXECUTE:
                data = without_thread_pointer(data)
            self._engine.poke(base + segment.address, data)
        exported = [each for each in source.symbols if each.is_defined and each.name]
        self.symbols = {each.name: base + each.address for each in exported if each.kind != _THREAD_LOCAL}
        self.thread_locals = {each.name: each.address for each in exported if each.kind == _THREAD_LOCAL}
        memory = self._engine.view(base, self.size)
        try:
            chosen = self._relocate(memory)
        finally:
            memory.release()
        for segment in source.segments:
            start = base + segment.address & -PAGE
            self._engine.protect(start, base + segment.address + segment.memory_size - start, segment.rights)

        self._engine.loaded(source.name, source.data, base)
        if chosen:
            self._choose(chosen)

    def _relocate(self, memory: memoryview) -> list[tuple[int, int]]:
        """Fill in the words. Returns the addresses of indirect words, each with the function that gives its value."""
        kinds, base = _KINDS[self.source.machine], self.base
        known: dict[int, int] = {}
        chosen = []
        for each in self.source.relocations:
            kind = kinds.get(each.kind)
            if kind == _RELATIVE:
                value = base + each.addend
            elif kind == _CHOSEN:
                chosen.append((each.address, base + each.addend))
                continue
            elif kind in (_ABSOLUTE, _ADDRESS):
                value = known.get(each.symbol, -1)
                if value < 0:
                    value = known[each.symbol] = self._address_of(self.source.symbols[each.symbol])
                if kind == _ABSOLUTE:
                    value += each.addend
                if self.source.symbols[each.symbol].kind == _CHOSEN_FUNCTION:
                    chosen.append((each.address, value))
            elif kind == _DESCRIPTOR:
                module, offset = self._thread_local(each)
                _WORD.pack_into(memory, each.address + _WORD.size, module << 32 | offset)
                value = self._linker.thread_local_function()
            else:
                self._check(each, kind)
                module, offset = self._thread_local(each)
                value = module if kind == _MODULE else offset
            _WORD.pack_into(memory, each.address, value & _64_BITS)
        return chosen

    def _address_of(self, symbol: Symbol) -> int:
        if symbol.is_defined:
            is_inline = symbol.is_weak and symbol.name.startswith("_Z")  # each object in C++ has its own
            found = None if is_inline or not symbol.name else self._linker.of_library(symbol.name)
            if found is None:
                return self.base + symbol.address
            self.replaced.append(symbol.name)
            return found
        return self._linker.resolve_weak(symbol.name) if symbol.is_weak else self._linker.resolve(symbol.name)

    def _check(self, word: Relocation, kind: str | None) -> None:
        name = self.source.name
        if kind == _FIXED_OFFSET:
            raise ElfError(
                f"{name} has thread-local variables in the initial-exec model, which a library loaded at run "
                "time cannot have; compile it with -fPIC -ftls-model=global-dynamic"
            )
        if self.source.machine == "x86_64" and word.kind == _X86_DESCRIPTOR:
            raise ElfError(f"{name} uses TLS descriptors; compile it with -mtls-dialect=gnu")
        if kind is None:
            raise ElfError(f"{name}: relocation {word.kind} of {self.source.machine} is not supported")

    def _thread_local(self, word: Relocation) -> tuple[int, int]:
        """Return module and offset of a thread-local variable."""
        symbol = self.source.symbols[word.symbol]
        if word.symbol == 0 or symbol.is_defined:
            return self._linker.module_of(self), (symbol.address if word.symbol else 0) + word.addend
        module, offset = self._linker.resolve_thread_local(symbol.name)
        return module, offset + word.addend

    def _choose(self, chosen: list[tuple[int, int]]) -> None:
        """Resolve indirect functions (STT_GNU_IFUNC), for which the image chooses one of several implementations."""
        for address, function in chosen:
            self._engine.poke(self.base + address, _WORD.pack(self._linker.run(function)))

    @property
    def functions_at_load(self) -> list[int]:
        """Addresses of functions to call after loading, such as constructors of C++."""
        source = self.source
        first = [self.base + source.function_at_load] if source.function_at_load else []
        return first + self._array(*source.functions_at_load)

    @property
    def functions_at_end(self) -> list[int]:
        """Addresses of functions to call before it is unloaded, such as destructors of C++."""
        source = self.source
        last = [self.base + source.function_at_end] if source.function_at_end else []
        return self._array(*source.functions_at_end)[::-1] + last

    def _array(self, at: int, count: int) -> list[int]:
        array = struct.unpack(f"<{count}Q", self._engine.peek(self.base + at, 8 * count))
        return [each for each in array if each not in (0, _64_BITS)]

    @property
    def _places(self) -> Places:
        return places_of(self.source.data, self.source.name)

    @CachedProperty
    def _frames(self) -> FrameInfo:
        return FrameInfo(self.source)

    def frame_row(self, address: int) -> FrameRow | None:
        """Return the rules for the frame at an address of code; None if they are not known."""
        return self._frames.row(address - self.base)

    def place_at(self, address: int) -> CodePlace:
        """Return the place in its source of an address in this image."""
        return self._places.at(address - self.base)

    def variable_at(self, address: int) -> str:
        """Return the variable that an address in this image belongs to; empty without symbols."""
        return self._places.variable_at(address - self.base)

    def __contains__(self, address: int) -> bool:
        return self.base <= address < self.base + self.size

    def unload(self) -> None:
        """Take it out of memory."""
        self._arena.unmap(self.base)


class LoadedCode:
    """A loaded object, with the addresses of its symbols as attributes.

    Args:
        image: the object.

    Attributes:
        image_: the object; the underscore avoids a clash with a symbol.
    """

    def __init__(self, image: Image) -> None:
        self.image_ = image

    def __getattr__(self, name: str) -> int:
        try:
            return self.image_.symbols[name]
        except KeyError:
            raise AttributeError(name) from None
