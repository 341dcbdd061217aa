"""Sockets for tests: bound ones, connected ones, and invalid ones."""

from __future__ import annotations

from cfepy.osal.limits import OS_CHECK, OS_FILE_FLAG_CREATE, OS_READ_WRITE
from cfepy.osal.sockaddr import OS_SocketDomain_INET, OS_SocketDomain_INET6, SockAddr
from cfepy.osal.streams import OS_SocketType_DATAGRAM, OS_SocketType_STREAM
from tests.osal.helpers import Bench

INET, INET6 = OS_SocketDomain_INET, OS_SocketDomain_INET6
DATAGRAM, STREAM = OS_SocketType_DATAGRAM, OS_SocketType_STREAM
NO_SOCKET = 0x6FFFF


def address(port: int, host: str = "127.0.0.1", domain: int = INET) -> SockAddr:
    return SockAddr(domain, host, port)


def bound(bench: Bench, port: int, kind: int = DATAGRAM, host: str = "127.0.0.1", domain: int = INET) -> int:
    sock_id = bench.os.socket_open(domain, kind)
    bench.os.socket_bind(sock_id, address(port, host, domain))
    return sock_id


def connection(bench: Bench, port: int = 9997) -> tuple[int, int, int]:
    """Return a server, the client's end and the server's end of a connection."""
    server, client = bound(bench, port, STREAM), bench.os.socket_open(INET, STREAM)
    assert bench.os.socket_connect(client, address(port), OS_CHECK)
    accepted = bench.os.socket_accept(server, OS_CHECK)
    assert accepted is not None
    return server, client, accepted[0]


def a_file(bench: Bench) -> int:
    return bench.os.open_create("/ram/test.txt", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
