"""OS_Socket*: sockets in the mission's network, and addresses, for C.

An OS_SockAddr_t is a length and a `sockaddr_in` or `sockaddr_in6` of Linux.
"""

from __future__ import annotations

import ipaddress
from struct import Struct
from typing import TYPE_CHECKING, NamedTuple

from cfepy.extra.c.api.osal_values import BAD, NAMED, check_size, in_time, new_id, properties
from cfepy.extra.c.memory import CMemory
from cfepy.osal import (
    OS_SocketDomain_INET,
    OS_SocketDomain_INET6,
    OS_SocketDomain_INVALID,
    OsTime,
    SockAddr,
    socket_addr_init,
)
from cfepy.reading.texts import to_bytes
from cfepy.status import (
    OS_ERR_INVALID_ARGUMENT,
    OS_ERR_NOT_IMPLEMENTED,
    OS_ERROR,
    OS_ERROR_TIMEOUT,
    OsalError,
)

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

ADDRESS_BYTES = 40
"""sizeof(OS_SockAddr_t)."""
OPTIONS = (0, 1)
"""OS_socket_option_t below OS_socket_option_MAX."""
BROKEN = -1
"""A domain that does not exist."""
_LENGTH = Struct("<Q")
_FAMILY = Struct("<H")
_PORT = Struct(">H")


class Family(NamedTuple):
    """Linux's data of a domain: the number of its family, the bytes of a sockaddr, and the place of the host in it."""

    domain: int
    number: int
    size: int
    host_at: int
    host_size: int


FAMILIES = (Family(OS_SocketDomain_INET, 2, 16, 4, 4), Family(OS_SocketDomain_INET6, 10, 28, 8, 16))
_BY_DOMAIN = {family.domain: family for family in FAMILIES}
_BY_NUMBER = {family.number: family for family in FAMILIES}


def read_address(memory: CMemory, at: int) -> SockAddr:
    """Read an OS_SockAddr_t of any length."""
    return _read(memory, at)[0]


def read_target(memory: CMemory, at: int) -> SockAddr:
    """Read an OS_SockAddr_t. Its domain is invalid if its length does not match its family."""
    address, is_whole = _read(memory, at)
    return address if is_whole else SockAddr(BROKEN)


def _read(memory: CMemory, at: int) -> tuple[SockAddr, bool]:
    raw = memory.peek(at, ADDRESS_BYTES)
    (length,), data = _LENGTH.unpack_from(raw), raw[_LENGTH.size :]
    family = _BY_NUMBER.get(_FAMILY.unpack_from(data)[0])
    if family is None:
        return SockAddr(OS_SocketDomain_INVALID), length == 0
    host = ipaddress.ip_address(data[family.host_at : family.host_at + family.host_size])
    return SockAddr(family.domain, str(host), _PORT.unpack_from(data, _FAMILY.size)[0]), length == family.size


def write_address(memory: CMemory, at: int, address: SockAddr) -> None:
    """Write an OS_SockAddr_t."""
    family = _BY_DOMAIN[address.domain]
    raw = bytearray(ADDRESS_BYTES)
    _LENGTH.pack_into(raw, 0, family.size)
    _FAMILY.pack_into(raw, _LENGTH.size, family.number)
    _PORT.pack_into(raw, _LENGTH.size + _FAMILY.size, address.port)
    start = _LENGTH.size + family.host_at
    raw[start : start + family.host_size] = ipaddress.ip_address(address.host).packed
    memory.poke(at, raw)


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_addresses(api, c)
    _declare_opening(api, c)
    _declare_connections(api, c)
    _declare_datagrams(api, c)
    _declare_facts(api, c)


def _declare_addresses(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def init(at: int, domain: int) -> None:
        memory.poke(at, bytes(ADDRESS_BYTES))
        write_address(memory, at, socket_addr_init(domain))

    def to_string(buffer: int, size: int, at: int) -> None:
        check_size(size)
        text = os.socket_addr_to_string(read_address(memory, at))
        if len(to_bytes(text)) >= size:
            raise OsalError(OS_ERROR, f"{text} needs more than {size} bytes")
        memory.poke(buffer, to_bytes(text) + b"\0")

    def from_string(at: int, text: str) -> None:
        address = read_address(memory, at)
        os.socket_addr_from_string(address, text)
        family = _BY_DOMAIN[address.domain]
        memory.poke(at + _LENGTH.size + family.host_at, ipaddress.ip_address(address.host).packed)

    def get_port(port: int, at: int) -> None:
        memory.poke(port, os.socket_addr_get_port(read_address(memory, at)).to_bytes(2, "little"))

    def set_port(at: int, port: int) -> None:
        address = read_address(memory, at)
        os.socket_addr_set_port(address, port)
        memory.poke(at + _LENGTH.size + _FAMILY.size, _PORT.pack(port))

    api.add("OS_SocketAddrInit", "PI", init, BAD)
    api.add("OS_SocketAddrToString", "PQP", to_string, BAD)
    api.add("OS_SocketAddrFromString", "PS", from_string, BAD)
    api.add("OS_SocketAddrGetPort", "PP", get_port, BAD)
    api.add("OS_SocketAddrSetPort", "PH", set_port, BAD)


def _declare_opening(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def bind(sock_id: int, at: int) -> None:
        os.socket_bind(sock_id, read_address(memory, at))

    def bind_address(sock_id: int, at: int) -> None:
        os.socket_bind_address(sock_id, read_address(memory, at))

    api.add("OS_SocketOpen", "=4II", new_id(os.socket_open, OS_ERR_NOT_IMPLEMENTED, OS_ERROR), BAD)
    api.add("OS_SocketBind", "IP", bind, BAD)
    api.add("OS_SocketBindAddress", "IP", bind_address, BAD)
    api.add("OS_SocketListen", "I", os.socket_listen)
    api.add("OS_SocketShutdown", "II", os.socket_shutdown)


def _declare_connections(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory
    connect_in = in_time(os.socket_connect, OS_ERROR_TIMEOUT)
    connect_by = in_time(os.socket_connect_abs, OS_ERROR_TIMEOUT)
    accept_in = in_time(os.socket_accept, OS_ERROR_TIMEOUT)
    accept_by = in_time(os.socket_accept_abs, OS_ERROR_TIMEOUT)

    def connect(sock_id: int, at: int, timeout: int) -> None:
        connect_in(sock_id, read_target(memory, at), timeout)

    def connect_abs(sock_id: int, at: int, timeout: int) -> None:
        connect_by(sock_id, read_target(memory, at), OsTime(timeout))

    def hand_over(result: tuple[int, SockAddr], at: int) -> int:
        write_address(memory, at, result[1])
        return result[0]

    def accept(sock_id: int, at: int, timeout: int) -> int:
        return hand_over(accept_in(sock_id, timeout), at)

    def accept_abs(sock_id: int, at: int, timeout: int) -> int:
        return hand_over(accept_by(sock_id, OsTime(timeout)), at)

    late = (OS_ERROR_TIMEOUT, OS_ERROR)
    api.add("OS_SocketConnect", "$IPi", connect, BAD)
    api.add("OS_SocketConnectAbs", "$IPq", connect_abs, BAD)
    api.add("OS_SocketAccept", "$=I4Pi", new_id(accept, *late), BAD)
    api.add("OS_SocketAcceptAbs", "$=I4Pq", new_id(accept_abs, *late), BAD)


def _declare_datagrams(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory
    receive_in = in_time(os.socket_recv_from, OS_ERROR_TIMEOUT)
    receive_by = in_time(os.socket_recv_from_abs, OS_ERROR_TIMEOUT)

    def hand_over(result: tuple[bytes, SockAddr], buffer: int, remote: int) -> int:
        data, source = result
        memory.poke(buffer, data)
        if remote:
            write_address(memory, remote, source)
        return len(data)

    def receive(sock_id: int, buffer: int, size: int, remote: int, timeout: int) -> int:
        return hand_over(receive_in(sock_id, size, timeout), buffer, remote)

    def receive_abs(sock_id: int, buffer: int, size: int, remote: int, timeout: int) -> int:
        return hand_over(receive_by(sock_id, size, OsTime(timeout)), buffer, remote)

    def send(sock_id: int, buffer: int, size: int, remote: int) -> int:
        check_size(size)
        return os.socket_send_to(sock_id, memory.peek(buffer, size), read_target(memory, remote))

    api.add("OS_SocketRecvFrom", "$IPQpi", receive, BAD)
    api.add("OS_SocketRecvFromAbs", "$IPQpq", receive_abs, BAD)
    api.add("OS_SocketSendTo", "$IPQP", send, BAD)


def _declare_facts(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def get_option(sock_id: int, option: int, value: int) -> None:
        if option not in OPTIONS:
            raise OsalError(OS_ERR_INVALID_ARGUMENT, f"unknown socket option {option}")
        memory.put_u32(value, 0)
        memory.put_u32(value, os.socket_get_option(sock_id, option))

    def set_option(sock_id: int, option: int, value: int) -> None:
        os.socket_set_option(sock_id, option, memory.u32(value))

    api.add("OS_SocketGetIdByName", "$4S", os.socket_get_id_by_name, BAD)
    api.add("OS_SocketGetInfo", "$IP", properties(memory, NAMED, os.socket_get_info), BAD)
    api.add("OS_SocketGetOption", "IIP", get_option, BAD)
    api.add("OS_SocketSetOption", "IIP", set_option, BAD)
