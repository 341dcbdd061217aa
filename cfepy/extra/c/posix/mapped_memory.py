"""Memory of mmap: pages of zeros, or the bytes of a file.

A mapping is a copy of the file. Bytes of a shared mapping reach the file with msync, with munmap and at the end.
"""

from __future__ import annotations

import errno
from typing import NamedTuple

from cfepy.extra.c.arena import PAGE, Arena, pages
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.engine import engine
from cfepy.extra.c.memory import CMemory
from cfepy.extra.c.posix.open_descriptors import O_ACCMODE, O_RDONLY, O_RDWR, O_WRONLY, Descriptor, failure

PROT_READ, PROT_WRITE, PROT_EXEC = 1, 2, 4
MAP_SHARED, MAP_PRIVATE, MAP_FIXED, MAP_ANONYMOUS = 1, 2, 0x10, 0x20
KIND = 3
RIGHTS = {PROT_READ: 4, PROT_WRITE: 2}


class Mapping(NamedTuple):
    """A mapping.

    Attributes:
        size: its bytes, whole pages.
        file: the file that gets its bytes back; None for other memory.
        offset: the position in the file.
        length: the bytes that belong to the file.
    """

    size: int
    file: Descriptor | None
    offset: int
    length: int


class MappedMemory:
    """The mappings of a processor.

    Args:
        arena: gives the memory.
        memory: the memory of C.
    """

    def __init__(self, arena: Arena, memory: CMemory) -> None:
        self._arena = arena
        self._memory = memory
        self._mappings: dict[int, Mapping] = {}

    def map(self, size: int, protection: int, flags: int, file: Descriptor | None, offset: int) -> int:
        """Map memory.

        Args:
            size: bytes.
            protection: PROT_*.
            flags: MAP_*.
            file: the file; None for anonymous memory.
            offset: the position in the file.

        Returns:
            The address.

        Raises:
            OSError: EINVAL, EACCES, ENODEV, as on Linux.
            CFault: it is at a fixed address, or executable.
        """
        if flags & MAP_FIXED:
            raise CFault("mmap() at a fixed address is not available; pass NULL and no MAP_FIXED")
        if protection & PROT_EXEC:
            raise CFault("mmap() of executable memory is not available; a flight computer loads code by OS_ModuleLoad")
        if not size or offset % PAGE or flags & KIND not in (MAP_SHARED, MAP_PRIVATE):
            raise failure(errno.EINVAL)
        is_shared = flags & KIND == MAP_SHARED
        data = b"" if file is None else self._content(file, size, offset, is_shared and bool(protection & PROT_WRITE))
        address = self._arena.map(size)
        self._memory.poke(address, data)
        keeps = file if is_shared and protection & PROT_WRITE else None
        if keeps is not None:
            keeps.links += 1  # a mapping goes on after close
        self._mappings[address] = Mapping(pages(size), keeps, offset, len(data))
        if not protection & PROT_WRITE:
            engine().protect(address, pages(size), RIGHTS[PROT_READ] if protection & PROT_READ else 0)
        return address

    @staticmethod
    def _content(file: Descriptor, size: int, offset: int, writes: bool) -> bytes:
        if not file.is_regular:
            raise failure(errno.ENODEV)
        mode = file.flags & O_ACCMODE
        if mode == O_WRONLY or (writes and mode == O_RDONLY):
            raise failure(errno.EACCES)
        return file.read_at(size, offset)

    def sync(self, address: int, size: int) -> int:
        """Write the bytes of a shared mapping to its file (msync).

        Raises:
            OSError: EINVAL, ENOMEM.
        """
        if address % PAGE:
            raise failure(errno.EINVAL)
        for start, mapping in self._mappings.items():
            if start <= address and address + size <= start + mapping.size:
                self._write_back(start, mapping)
                return 0
        raise failure(errno.ENOMEM)

    def unmap(self, address: int, size: int) -> int:
        """Remove a mapping (munmap). Memory without one is ignored, as on Linux.

        Raises:
            OSError: EINVAL.
            CFault: the memory is a part of a mapping.
        """
        if address % PAGE or not size:
            raise failure(errno.EINVAL)
        end = address + pages(size)
        for start, mapping in list(self._mappings.items()):
            if start >= end or start + mapping.size <= address:
                continue
            if start < address or start + mapping.size > end:
                raise CFault("munmap() of a part of a mapping is not available; remove all of it")
            self._remove(start)
        return 0

    def close(self) -> None:
        """Write all shared mappings to their files, as the end of a process does."""
        for start in list(self._mappings):
            self._remove(start)

    def _remove(self, address: int) -> None:
        mapping = self._mappings.pop(address)
        self._write_back(address, mapping)
        if mapping.file is not None:
            mapping.file.links -= 1
            if not mapping.file.links and not mapping.file.users:
                mapping.file.close()
        self._arena.unmap(address)

    def _write_back(self, address: int, mapping: Mapping) -> None:
        if mapping.file is not None and mapping.length:
            assert mapping.file.flags & O_ACCMODE == O_RDWR
            mapping.file.write_at(bytes(self._memory.peek(address, mapping.length)), mapping.offset)
