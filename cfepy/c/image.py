"""A shared object in memory: loaded by cfepy itself, so that it is at an address that is the same in each run.

The host's loader would put it elsewhere in each run, share its variables between missions of one process, and take
names from any library of the host. Here each load is a fresh copy, sees exactly the symbols that it is given, and is
gone when it is unmapped.
"""

from __future__ import annotations

import struct
from collections.abc import Callable

from cfepy.c.arena import Arena
from cfepy.c.elf import ElfError, SharedObject
from cfepy.c.engine import engine
from cfepy.c.places import CodePlace, Places
from cfepy.cached import CachedProperty

_RELATIVE, _ABSOLUTE, _ADDRESS = "relative", "absolute", "address"
_KINDS = {
    "x86_64": {1: _ABSOLUTE, 6: _ADDRESS, 7: _ADDRESS, 8: _RELATIVE},
    "aarch64": {257: _ABSOLUTE, 1025: _ABSOLUTE, 1026: _ABSOLUTE, 1027: _RELATIVE},
}
_WORD = struct.Struct("<Q")
_64_BITS = (1 << 64) - 1


class Image:
    """A loaded object.

    Args:
        source: its file.
        arena: where it is put.
        resolve: the address of a symbol that it does not have itself.

    Attributes:
        base: its lowest address.
        size: its bytes.
        symbols: addresses of what it exports.

    Raises:
        ElfError: it needs something of the loader that this one does not have.
    """

    def __init__(self, source: SharedObject, arena: Arena, resolve: Callable[[str], int]) -> None:
        self.source = source
        self.size = source.size
        self.symbols: dict[str, int] = {}
        self._arena = arena
        self._engine = engine()
        self.base = arena.map(self.size)
        try:
            self._fill(resolve)
        except BaseException:
            self.unload()
            raise

    def _fill(self, resolve: Callable[[str], int]) -> None:
        source, base = self.source, self.base
        for segment in source.segments:
            self._engine.poke(base + segment.address, source.data[segment.offset : segment.offset + segment.file_size])
        self.symbols = {each.name: base + each.address for each in source.symbols if each.is_defined and each.name}
        memory = self._engine.view(base, self.size)
        try:
            self._relocate(memory, resolve)
        finally:
            memory.release()
        for segment in source.segments:
            start = base + segment.address & ~4095
            self._engine.protect(start, base + segment.address + segment.memory_size - start, segment.rights)

    def _relocate(self, memory: memoryview, resolve: Callable[[str], int]) -> None:
        kinds, symbols, base = _KINDS[self.source.machine], self.source.symbols, self.base
        known: dict[int, int] = {}
        for each in self.source.relocations:
            kind = kinds.get(each.kind)
            if kind is None:
                raise ElfError(f"{self.source.name}: relocation {each.kind} of {self.source.machine} is not supported")
            if kind == _RELATIVE:
                value = base + each.addend
            else:
                value = known.get(each.symbol, -1)
                if value < 0:
                    symbol = symbols[each.symbol]
                    if symbol.is_defined:
                        value = base + symbol.address
                    else:
                        value = 0 if symbol.is_weak else resolve(symbol.name)
                    known[each.symbol] = value
                if kind == _ABSOLUTE:
                    value += each.addend
            _WORD.pack_into(memory, each.address, value & _64_BITS)

    @property
    def functions_at_load(self) -> list[int]:
        """Addresses of functions that are called when it was loaded, such as constructors of C++."""
        at, count = self.source.functions_at_load
        array = struct.unpack(f"<{count}Q", self._engine.peek(self.base + at, 8 * count))
        first = [self.base + self.source.function_at_load] if self.source.function_at_load else []
        return first + [each for each in array if each not in (0, _64_BITS)]

    @CachedProperty
    def _places(self) -> Places:
        return Places(self.source.data, self.source.name)

    def place_at(self, address: int) -> CodePlace:
        """Where in its source an address in this image is."""
        return self._places.at(address - self.base)

    def __contains__(self, address: int) -> bool:
        return self.base <= address < self.base + self.size

    def unload(self) -> None:
        """Take it out of memory."""
        self._arena.unmap(self.base)


class LoadedCode:
    """A loaded object, with its symbols as attributes: their addresses.

    Args:
        image: the object.

    Attributes:
        image_: the same; called so because symbols are attributes, too.
    """

    def __init__(self, image: Image) -> None:
        self.image_ = image

    def __getattr__(self, name: str) -> int:
        try:
            return self.image_.symbols[name]
        except KeyError:
            raise AttributeError(name) from None
