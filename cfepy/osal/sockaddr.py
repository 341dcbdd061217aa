"""OSAL's network addresses (OS_SockAddr_t, OS_SocketAddr*): IPv4 and IPv6, as mutable objects."""

from __future__ import annotations

import re

from cfepy.osal.network import Place
from cfepy.status import (
    OS_ERR_BAD_ADDRESS,
    OS_ERR_EMPTY_SET,
    OS_ERR_INVALID_ARGUMENT,
    OS_ERR_NOT_IMPLEMENTED,
    OS_ERR_TRY_AGAIN,
    OS_INVALID_POINTER,
    OsalError,
)

OS_SocketDomain_INVALID = 0
OS_SocketDomain_INET = 1
OS_SocketDomain_INET6 = 2

ANY_HOST = {OS_SocketDomain_INET: "0.0.0.0", OS_SocketDomain_INET6: "::"}
HIGHEST_PORT = 0xFFFF
LOOPBACK, LOOPBACK_NAME = "127.0.0.1", "localhost"
_PART = re.compile(r"0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*", re.ASCII)
_HOST_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]*(\.[A-Za-z0-9_-]+)*\.?", re.ASCII)


class SockAddr:
    """A network address (OS_SockAddr_t); `socket_addr_init` makes one.

    Args:
        domain: OS_SocketDomain_INET or OS_SocketDomain_INET6; OS_SocketDomain_INVALID for an empty address.
        host: host as text; None means all hosts.
        port: 0 to 65535.
    """

    __slots__ = ("domain", "host", "port")

    def __init__(self, domain: int = OS_SocketDomain_INVALID, host: str | None = None, port: int = 0) -> None:
        self.domain = domain
        self.host = host if host is not None else ANY_HOST.get(domain, "")
        self.port = port

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SockAddr) and (self.domain, self.place) == (other.domain, other.place)

    __hash__ = None  # type: ignore[assignment]  # it can be changed

    def __repr__(self) -> str:
        return f"SockAddr({self.host}:{self.port})"

    @property
    def place(self) -> Place:
        """The address as a `Place` on the network."""
        return Place(self.host, self.port)


def from_place(place: Place) -> SockAddr:
    """Return the address of a place on the network."""
    return SockAddr(OS_SocketDomain_INET6 if place.is_ip6 else OS_SocketDomain_INET, place.host, place.port)


def socket_addr_init(domain: int) -> SockAddr:
    """Return an address of all hosts without a port (OS_SocketAddrInit).

    Args:
        domain: OS_SocketDomain_INET or OS_SocketDomain_INET6.

    Raises:
        OsalError: OS_ERR_NOT_IMPLEMENTED for any other domain.
    """
    if domain not in ANY_HOST:
        raise OsalError(OS_ERR_NOT_IMPLEMENTED, f"unknown address domain {domain}")
    return SockAddr(domain)


def socket_addr_to_string(addr: SockAddr) -> str:
    """Return the host of an address as text, without the port (OS_SocketAddrToString): "localhost" for 127.0.0.1, and
    the numbers of others.

    Raises:
        OsalError: OS_INVALID_POINTER; OS_ERR_BAD_ADDRESS for an address without domain.
    """
    check_address(addr)
    return host_name(addr.host)


def host_name(host: str) -> str:
    """Return the name of a host; a computer knows no other than "localhost" without a name server."""
    return LOOPBACK_NAME if host == LOOPBACK else host


def socket_addr_from_string(addr: SockAddr, string: str) -> None:
    """Set the host of an address; its port stays (OS_SocketAddrFromString).

    Args:
        addr: the address to change.
        string: numbers as getaddrinfo takes them, such as "127.0.0.1", "127.1", "0x7f000001" or "::1"; or "localhost".

    Raises:
        OsalError: OS_INVALID_POINTER; OS_ERR_BAD_ADDRESS for an address without domain; OS_ERR_TRY_AGAIN for another
            name, because the network has no name server; OS_ERR_EMPTY_SET for an address of the other domain, and for
            a text that cannot be a name.
    """
    check_address(addr)
    ip4, ip6 = _ip4_of(string), _ip6_of(string)
    host = ip4 if addr.domain == OS_SocketDomain_INET else ip6
    if host is not None:
        addr.host = host
    elif ip4 is None and ip6 is None and _HOST_NAME.fullmatch(string):
        raise OsalError(OS_ERR_TRY_AGAIN, f"host {string!r} cannot be looked up; the network has no name server")
    else:
        raise OsalError(OS_ERR_EMPTY_SET, f"invalid network address {string!r}")


def _ip4_of(string: str) -> str | None:
    """Return the numbers of "localhost", or of a text that inet_aton takes: one to four parts, decimal, octal or
    hexadecimal, of which the last fills the bytes that are left.
    """
    if string == LOOPBACK_NAME:
        return LOOPBACK
    parts = string.split(".")
    if len(parts) > 4 or not all(map(_PART.fullmatch, parts)):
        return None
    *firsts, last = (int(part, 8 if re.fullmatch("0[0-7]+", part) else 0) for part in parts)
    room = 4 - len(firsts)
    if last >= 256**room or any(first > 255 for first in firsts):
        return None
    return ".".join(map(str, bytes(firsts) + last.to_bytes(room, "big")))


def _ip6_of(string: str) -> str | None:
    """Return an IPv6 address in its usual form, or None for another text or an address that names an interface."""
    import ipaddress

    try:
        host = str(ipaddress.IPv6Address(string))
    except ValueError:
        return None
    return None if "%" in host else host


def socket_addr_get_port(addr: SockAddr) -> int:
    """Return the port of an address (OS_SocketAddrGetPort).

    Raises:
        OsalError: OS_INVALID_POINTER; OS_ERR_BAD_ADDRESS for an address without domain.
    """
    check_address(addr)
    return addr.port


def socket_addr_set_port(addr: SockAddr, port_num: int) -> None:
    """Set the port of an address (OS_SocketAddrSetPort).

    Raises:
        OsalError: OS_INVALID_POINTER; OS_ERR_BAD_ADDRESS for an address without domain; OS_ERR_INVALID_ARGUMENT for a
            port that does not fit in 16 bits.
    """
    check_address(addr)
    if not 0 <= port_num <= HIGHEST_PORT:
        raise OsalError(OS_ERR_INVALID_ARGUMENT, f"invalid port {port_num}")
    addr.port = port_num


def check_address(addr: SockAddr | None) -> SockAddr:
    """Return the address if it is valid.

    Raises:
        OsalError: OS_INVALID_POINTER for None, OS_ERR_BAD_ADDRESS for an address without a domain.
    """
    check_given(addr)
    assert addr is not None
    if addr.domain not in ANY_HOST:
        raise OsalError(OS_ERR_BAD_ADDRESS, "the address has no domain")
    return addr


def check_target(addr: SockAddr) -> None:
    """Check the target address of a call; an address without a domain (all zeros) passes, and the network refuses it.

    Raises:
        OsalError: OS_ERR_BAD_ADDRESS for an unknown domain.
    """
    if addr.domain != OS_SocketDomain_INVALID:
        check_address(addr)


def check_given(addr: SockAddr | None) -> None:
    """Raise OS_INVALID_POINTER for None."""
    if addr is None:
        raise OsalError(OS_INVALID_POINTER, "missing address")
