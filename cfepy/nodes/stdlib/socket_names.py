"""Names and addresses for `socket`, on a network with only a loopback interface."""

from __future__ import annotations

import errno
import os
import socket
from collections.abc import Callable
from ipaddress import ip_address
from typing import Any

from cfepy.osal import Place

LOCAL, ANY = "127.0.0.1", "0.0.0.0"
_NAMES = {"": ANY, "localhost": LOCAL, "<any>": ANY, "<broadcast>": "255.255.255.255"}
_HIGHEST_PORT = 65_535
_KINDS = (
    (socket.SOCK_STREAM, socket.IPPROTO_TCP),
    (socket.SOCK_DGRAM, socket.IPPROTO_UDP),
    (socket.SOCK_RAW, 0),
)


def failure(number: int) -> OSError:
    """Return the OSError of an errno, of the class that Python has for it."""
    return OSError(number, os.strerror(number))


def host_of(name: Any, family: int, host_name: str) -> str:
    """Return the numeric address of a host.

    Args:
        name: name or address, as a node gives it.
        family: AF_INET or AF_INET6.
        host_name: name of the simulated computer.

    Raises:
        socket.gaierror: if there is no such host.
    """
    if isinstance(name, (bytes, bytearray)):
        name = name.decode()
    is_ip6 = family == socket.AF_INET6
    name = LOCAL if name in (host_name, f"{host_name}.local") else _NAMES.get(name, name)
    if is_ip6:
        name = {LOCAL: "::1", ANY: "::"}.get(name, name)
    try:
        address = ip_address(name)
    except ValueError:
        raise socket.gaierror(socket.EAI_NONAME, "Name or service not known") from None
    if (address.version == 6) != is_ip6:
        raise socket.gaierror(
            getattr(socket, "EAI_ADDRFAMILY", socket.EAI_FAMILY), "Address family for hostname not supported"
        )
    return str(address)


def place_of(address: Any, family: int, host_name: str, call: str) -> Place:
    """Return the place that an address means.

    Args:
        address: a tuple of host and port.
        family: address family of the socket, AF_INET or AF_INET6.
        host_name: name of the simulated computer.
        call: name of the called function, for the text of errors.

    Raises:
        TypeError: if the address is not such a tuple.
        OverflowError: if the port is not from 0 to 65535.
        socket.gaierror: if there is no such host.
    """
    if not isinstance(address, tuple) or len(address) < 2:
        raise TypeError(f"{call}(): AF_INET address must be tuple, not {type(address).__name__}")
    host, port = address[:2]
    if not isinstance(port, int):
        raise TypeError(f"'{type(port).__name__}' object cannot be interpreted as an integer")
    if not 0 <= port <= _HIGHEST_PORT:
        raise OverflowError(f"{call}(): port must be 0-65535.")
    return Place(host_of(host, family, host_name), port)


def address_of(place: Place) -> tuple[Any, ...]:
    """Return the address of a place as a socket address tuple, with four items for IPv6 and otherwise two."""
    return (place.host, place.port, 0, 0) if place.is_ip6 else (place.host, place.port)


def name_functions(host_name: str) -> dict[str, Callable[..., Any]]:
    """Return the functions of the module `socket` that look up names.

    Args:
        host_name: name of the simulated computer.
    """

    def gethostbyname(name: str) -> str:
        return host_of(name, socket.AF_INET, host_name)

    def gethostbyname_ex(name: str) -> tuple[str, list[str], list[str]]:
        return name, [], [gethostbyname(name)]

    def gethostbyaddr(name: str) -> tuple[str, list[str], list[str]]:
        address = gethostbyname(name)
        return "localhost" if address == LOCAL else host_name, [], [address]

    def getaddrinfo(
        host: Any, port: Any, family: int = 0, type: int = 0, proto: int = 0, flags: int = 0
    ) -> list[tuple[Any, ...]]:
        family = family or (socket.AF_INET6 if isinstance(host, str) and ":" in host else socket.AF_INET)
        missing = "<any>" if flags & socket.AI_PASSIVE else "localhost"
        place = Place(host_of(missing if host is None else host, family, host_name), _port_of(port))
        kinds = [kind for kind in _KINDS if type in (0, kind[0]) and proto in (0, kind[1])]
        kind_of = socket.AddressFamily(family)
        return [(kind_of, kind, protocol, "", address_of(place)) for kind, protocol in kinds]

    def getnameinfo(address: Any, flags: int) -> tuple[str, str]:
        return address[0], str(address[1])

    return {
        "getaddrinfo": getaddrinfo,
        "getfqdn": lambda name="": name or host_name,
        "gethostbyaddr": gethostbyaddr,
        "gethostbyname": gethostbyname,
        "gethostbyname_ex": gethostbyname_ex,
        "gethostname": lambda: host_name,
        "getnameinfo": getnameinfo,
    }


def _port_of(port: Any) -> int:
    if isinstance(port, (bytes, str)):
        text = port.decode() if isinstance(port, bytes) else port
        return int(text) if text.isdecimal() else socket.getservbyname(text)
    return port or 0


def unreachable() -> OSError:
    """Return the error of a network with only this computer: ENETUNREACH."""
    return failure(errno.ENETUNREACH)
