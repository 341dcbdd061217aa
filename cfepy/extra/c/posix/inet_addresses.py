"""Addresses of sockets in C's form: struct sockaddr_in and sockaddr_in6, and their texts."""

from __future__ import annotations

import errno
import ipaddress
from struct import Struct

from cfepy.extra.c.memory import CMemory
from cfepy.extra.c.posix.open_descriptors import failure
from cfepy.osal import Place

AF_UNSPEC, AF_UNIX, AF_INET, AF_INET6, AF_CAN = 0, 1, 2, 10, 29
SOCKADDR_IN = Struct("<H2s4s8x")
SOCKADDR_IN6 = Struct("<H2sI16sI")
_FAMILY = Struct("<H")


def packed(place: Place) -> bytes:
    """Return the sockaddr of a place."""
    host, port = ipaddress.ip_address(place.host).packed, place.port.to_bytes(2, "big")
    if place.is_ip6:
        return SOCKADDR_IN6.pack(AF_INET6, port, 0, host, 0)
    return SOCKADDR_IN.pack(AF_INET, port, host)


def read_place(memory: CMemory, at: int, size: int, is_ip6: bool, wrong: int = errno.EAFNOSUPPORT) -> Place | None:
    """Return the place in a sockaddr.

    Args:
        memory: the memory of C.
        at: its address.
        size: its bytes.
        is_ip6: the family of the socket.
        wrong: the error for another family.

    Returns:
        The place; None for AF_UNSPEC.

    Raises:
        OSError: EFAULT, EINVAL for too few bytes, or `wrong`.
    """
    if not at:
        raise failure(errno.EFAULT)
    if size < _FAMILY.size:
        raise failure(errno.EINVAL)
    family = int(_FAMILY.unpack(memory.peek(at, _FAMILY.size))[0])
    if family == AF_UNSPEC:
        return None
    if size < (24 if is_ip6 else SOCKADDR_IN.size):
        raise failure(errno.EINVAL)
    if family != (AF_INET6 if is_ip6 else AF_INET):
        raise failure(wrong)
    host_at, host_size = (8, 16) if is_ip6 else (4, 4)
    host = ipaddress.ip_address(bytes(memory.peek(at + host_at, host_size)))
    return Place(str(host), int.from_bytes(memory.peek(at + 2, 2), "big"))


def write_place(memory: CMemory, at: int, size_at: int, place: Place | None) -> None:
    """Write a place into a sockaddr as the kernel does: cut to its size, with the real size.

    Args:
        memory: the memory of C.
        at: address of the sockaddr; 0 for none.
        size_at: address of its size.
        place: the place; None for no address.
    """
    if not at:
        return
    if not size_at:
        raise failure(errno.EFAULT)
    room = memory.u32(size_at)
    if room >> 31:
        raise failure(errno.EINVAL)
    data = b"" if place is None else packed(place)
    memory.poke(at, data[:room])
    memory.put_u32(size_at, len(data))


def host_of_text(text: str) -> bytes | None:
    """Return the address of a text as inet_aton reads it: one to four numbers, each decimal, octal or hexadecimal."""
    words = text.split(None, 1)
    if not words or text[0].isspace():
        return None
    values = []
    for part in words[0].split("."):
        if not part.isascii() or not part.isalnum():
            return None
        base = 16 if part[:2] in ("0x", "0X") else 8 if part.startswith("0") and part != "0" else 10
        try:
            values.append(int(part[2:] or "0" if base == 16 else part, base))
        except ValueError:
            return None
    if len(values) > 4 or any(each > 255 for each in values[:-1]):
        return None
    last = values.pop()
    left = 4 - len(values)
    if last >= 1 << 8 * left:
        return None
    return bytes(values) + last.to_bytes(left, "big")
