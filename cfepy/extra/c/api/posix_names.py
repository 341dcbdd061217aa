"""inet_addr, inet_pton, getaddrinfo and related functions: addresses as texts, and names of hosts.

The network has one host, which is called localhost. Other names are unknown.
"""

from __future__ import annotations

import errno
import ipaddress
from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.posix_calls import PosixCalls, Slots
from cfepy.extra.c.posix.inet_addresses import AF_INET, AF_INET6, AF_UNSPEC, host_of_text, packed
from cfepy.extra.c.posix.open_descriptors import failure
from cfepy.osal import Place
from cfepy.reading.texts import to_bytes

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

INADDR_NONE = 0xFFFFFFFF
HOST_NOT_FOUND = 1
EAI_BADFLAGS, EAI_NONAME, EAI_FAMILY, EAI_SOCKTYPE, EAI_SERVICE = -1, -2, -6, -7, -8
EAI_TEXTS = {
    EAI_BADFLAGS: "Bad value for ai_flags",
    EAI_NONAME: "Name or service not known",
    EAI_FAMILY: "ai_family not supported",
    EAI_SOCKTYPE: "ai_socktype not supported",
    EAI_SERVICE: "Servname not supported for ai_socktype",
}
AI_PASSIVE, AI_NUMERICHOST = 1, 4
ADDRINFO = Struct("<iiiiI4xQQQ")
HOSTENT = Struct("<QQiiQ")
LOCAL = "localhost"
KINDS = ((1, 6), (2, 17), (3, 0))
"""Types of sockets with their protocols: stream, datagram, raw."""
_SLOT = 128


class HostNames:
    """The functions on names and addresses.

    Args:
        c: the C side of the processor.
    """

    def __init__(self, c: CRuntime) -> None:
        self._c = c
        self._memory = c.memory
        self._slots = Slots(c, _SLOT)
        self._static: dict[str, int] = {}

    def _room(self, name: str) -> int:
        """Return the static memory of a function."""
        if name not in self._static:
            self._static[name] = self._slots.take()
        return self._static[name]

    def address(self, text: str) -> int:
        found = host_of_text(text)
        return INADDR_NONE if found is None else int.from_bytes(found, "little")

    def read_address(self, text: str, at: int) -> int:
        found = host_of_text(text)
        if found is None:
            return 0
        if at:
            self._memory.poke(at, found)
        return 1

    def text_of(self, address: int) -> int:
        text = ".".join(map(str, address.to_bytes(4, "little")))
        room = self._room("inet_ntoa")
        self._memory.put_text(room, text, 18)
        return room

    def presentation_to_network(self, family: int, text: str, to: int) -> int:
        if family not in (AF_INET, AF_INET6):
            raise failure(errno.EAFNOSUPPORT)
        try:
            kind = ipaddress.IPv4Address if family == AF_INET else ipaddress.IPv6Address
            data = kind("" if "%" in text else text).packed
        except ValueError:
            return 0
        self._memory.poke(to, data)
        return 1

    def network_to_presentation(self, family: int, at: int, to: int, size: int) -> int:
        if family not in (AF_INET, AF_INET6):
            raise failure(errno.EAFNOSUPPORT)
        data = bytes(self._memory.peek(at, 4 if family == AF_INET else 16))
        raw = to_bytes(str(ipaddress.ip_address(data))) + b"\0"
        if len(raw) > size:
            raise failure(errno.ENOSPC)
        self._memory.poke(to, raw)
        return to

    def error_place(self) -> int:
        return self._room("h_errno")

    def host(self, name: str) -> int:
        """Return the struct hostent of a name, with its one address; 0 for an unknown name."""
        found = b"\x7f\0\0\1" if name == LOCAL else host_of_text(name)
        if found is None:
            self._memory.put_u32(self.error_place(), HOST_NOT_FOUND)
            return 0
        room = self._room("gethostbyname")
        addresses, aliases = room + 40, room + 56
        self._memory.poke(room, HOSTENT.pack(self._c.constants.text(name), aliases, AF_INET, 4, addresses))
        self._memory.put_u64(addresses, room + 72)
        self._memory.put_u64(addresses + 8, 0)
        self._memory.put_u64(aliases, 0)
        self._memory.poke(room + 72, found)
        return room

    def addresses(self, name: str | None, service: str | None, hints: int, result: int) -> int:
        flags = family = kind = protocol = 0
        if hints:
            flags, family, kind, protocol, *_ = ADDRINFO.unpack(self._memory.peek(hints, ADDRINFO.size))
        if name is None and service is None:
            return EAI_NONAME
        if family not in (AF_UNSPEC, AF_INET, AF_INET6):
            return EAI_FAMILY
        if service is not None and not (service.isascii() and service.isdigit() and int(service) < 1 << 16):
            return EAI_SERVICE
        port = int(service or 0)
        hosts = self._hosts(name, bool(flags & AI_PASSIVE), bool(flags & AI_NUMERICHOST))
        places = [Place(host, port) for host in hosts if family in (AF_UNSPEC, AF_INET6 if ":" in host else AF_INET)]
        kinds = [each for each in KINDS if kind in (0, each[0]) and protocol in (0, each[1])]
        if not places:
            return EAI_NONAME
        if not kinds:
            return EAI_SOCKTYPE
        following = 0
        for place in reversed(places):
            for type_of_socket, own in reversed(kinds):
                following = self._entry(place, type_of_socket, own, following)
        self._memory.put_u64(result, following)
        return 0

    def _hosts(self, name: str | None, is_passive: bool, is_numeric: bool) -> list[str]:
        if name is None:
            return ["0.0.0.0", "::"] if is_passive else ["::1", "127.0.0.1"]
        if name == LOCAL and not is_numeric:
            return ["::1", "127.0.0.1"]
        found = host_of_text(name)
        if found is not None:
            return [str(ipaddress.ip_address(found))]
        try:
            return [str(ipaddress.IPv6Address(name))]
        except ValueError:
            return []

    def _entry(self, place: Place, kind: int, protocol: int, following: int) -> int:
        at, raw = self._slots.take(), packed(place)
        family = AF_INET6 if place.is_ip6 else AF_INET
        data = ADDRINFO.pack(0, family, kind, protocol, len(raw), at + ADDRINFO.size, 0, following)
        self._memory.poke(at, data + raw)
        return at

    def free(self, at: int) -> None:
        while at:
            following = self._memory.u64(at + 40)
            self._slots.give(at)
            at = following

    def error_text(self, number: int) -> int:
        return self._c.constants.text(EAI_TEXTS.get(number, "Unknown error"))


def declare(api: Declarations, c: CRuntime) -> None:
    calls, names = PosixCalls(api, c), HostNames(c)
    calls.add("inet_addr", "S", names.address)
    calls.add("inet_aton", "Sp", names.read_address, 0)
    calls.add("inet_ntoa", "I", names.text_of)
    calls.add("inet_pton", "iSP", names.presentation_to_network)
    calls.add("inet_ntop", "iPpI", names.network_to_presentation, 0)
    calls.add("gethostbyname", "S", names.host, 0)
    api.add("__h_errno_location", "", names.error_place)
    api.add("getaddrinfo", "sspP", names.addresses, EAI_NONAME)
    api.add("freeaddrinfo", "p", names.free)
    api.add("gai_strerror", "i", names.error_text)
