"""rosgraph.network: this machine's name and addresses, and the header of a ROS connection (wiki.ros.org/ROS/TCPROS)."""

from __future__ import annotations

import os
import platform
import socket
import struct
import sys
import urllib.parse as urlparse
from collections.abc import Mapping
from io import BytesIO
from typing import Any

from rosgraph.rosenv import ROS_HOSTNAME, ROS_IP, ROS_IPV6

_SIZE = struct.Struct("<I")


def parse_http_host_and_port(url: str) -> tuple[str, int]:
    """Return host and port of a URL. The default port is 80.

    Raises:
        ValueError: not a URL with a scheme and a host.
    """
    parts = urlparse.urlparse(url) if url else None
    if parts is None or not parts.scheme or not parts.hostname:
        raise ValueError("not a valid URL")
    return parts.hostname, parts.port or 80


def _is_unix_like_platform() -> bool:
    return platform.system() in ("Linux", "FreeBSD", "Darwin")


def get_address_override() -> str | None:
    """Return the address that `__hostname:=` or `__ip:=`, ROS_HOSTNAME or ROS_IP ask for, or None.

    Raises:
        ValueError: an argument with two ":=".
    """
    for argument in sys.argv:
        if argument.startswith(("__hostname:=", "__ip:=")):
            _, *values = argument.split(":=")
            if len(values) != 1:
                raise ValueError(f"invalid ROS command-line remapping argument '{argument}'")
            return values[0]
    for variable in (ROS_HOSTNAME, ROS_IP):
        if variable in os.environ:
            return _checked(variable, os.environ[variable])
    return None


def _checked(variable: str, address: str) -> str:
    """Return the address unchanged. Warn if it is not a valid one."""
    is_ip = variable == ROS_IP
    problem = None
    if not address:
        problem = "an empty string"
    elif "://" in address:
        problem = "protocol should not be included"
    elif (is_ip and "." in address and address.rfind(":") > address.rfind(".")) or (not is_ip and ":" in address):
        problem = "port should not be included"
    elif is_ip and "." not in address and ":" not in address:
        problem = "must be a valid IPv4 or IPv6 address"
    if problem:
        sys.stderr.write(f"invalid {variable} ({problem})\n")
    return address


def use_ipv6() -> bool:
    """Return whether ROS_IPV6 is on."""
    return os.environ.get(ROS_IPV6) == "on"


def get_local_addresses() -> list[str]:
    """Return addresses of this machine."""
    return ["127.0.0.1"]


def get_local_address() -> str:
    """Return the address of this machine that ROS uses."""
    return get_address_override() or ("::1" if use_ipv6() else get_local_addresses()[0])


def is_local_address(hostname: str) -> bool:
    """Return whether a name or address is this machine's."""
    own = {"localhost", "::1", socket.gethostname(), *get_local_addresses()}
    return hostname in own or hostname.startswith("127.")


def get_bind_address(address: str | None = None) -> str:
    """Return the address that a server binds to: all addresses, unless `address` or ROS_IP is the loopback."""
    address = get_address_override() if address is None else address
    if address and (address in ("localhost", "::1") or address.startswith("127.")):
        if use_ipv6():
            return "::1"
        return address if address.startswith("127.") else "127.0.0.1"
    return "::" if use_ipv6() else "0.0.0.0"


def get_host_name() -> str:
    """Return the name of this machine in URIs."""
    return get_address_override() or socket.gethostname()


def create_local_xmlrpc_uri(port: int) -> str:
    """Return the URI of a server of this machine."""
    return f"http://{get_host_name()}:{port}/"


# -- headers ---------------------------------------------------------------------------------------------------------


class ROSHandshakeException(Exception):
    """A header that cannot be read."""


def decode_ros_handshake_header(header_str: bytes) -> dict[str, str]:
    """Return the fields of a header.

    Args:
        header_str: the header; more may follow.

    Raises:
        ROSHandshakeException: it is truncated, or a field has a mistake.
    """
    (size,) = _SIZE.unpack_from(header_str)
    end, at = size + 4, 4
    if end > len(header_str):
        raise ROSHandshakeException(f"Incomplete header. Expected {end} bytes but only have {len(header_str)}")
    found = {}
    while at < end:
        (length,) = _SIZE.unpack_from(header_str, at)
        if length == 0:
            raise ROSHandshakeException("Invalid 0-length handshake header field")
        start, at = at + 4, at + 4 + length
        if at > end:
            raise ROSHandshakeException(f"Invalid line length in handshake header: {end}")
        line = header_str[start:at].decode()
        key, equals, value = line.partition("=")
        if not equals:
            raise ROSHandshakeException(f"Invalid line in handshake header: [{line}]")
        found[key.strip()] = value
    return found


def encode_ros_handshake_header(header: Mapping[Any, Any]) -> bytes:
    """Return a header of some fields."""
    fields = sorted((_encoded(key), _encoded(value)) for key, value in header.items())
    body = b"".join(_SIZE.pack(len(key) + len(value) + 1) + key + b"=" + value for key, value in fields)
    return _SIZE.pack(len(body)) + body


def _encoded(text: Any) -> bytes:
    return text.encode() if isinstance(text, str) else bytes(text)


def read_ros_handshake_header(sock: Any, b: BytesIO, buff_size: int) -> dict[str, str]:
    """Read a header from a socket.

    Args:
        sock: the socket.
        b: gets the bytes after the header.
        buff_size: bytes to read at a time.

    Raises:
        ROSHandshakeException: the connection ends before the header does.
    """
    while True:
        data = sock.recv(buff_size)
        if not data:
            raise ROSHandshakeException(
                f"connection from sender terminated before handshake header received. {b.tell()} bytes were received."
            )
        b.write(data)
        received = b.getvalue()
        if len(received) > 4 and len(received) >= 4 + _SIZE.unpack_from(received)[0]:
            break
    rest = received[4 + _SIZE.unpack_from(received)[0] :]
    b.seek(0)
    b.truncate()
    b.write(rest)
    return decode_ros_handshake_header(received)


def write_ros_handshake_header(sock: Any, header: Mapping[Any, Any]) -> int:
    """Write a header to a socket. Returns the number of bytes."""
    data = encode_ros_handshake_header(header)
    sock.sendall(data)
    return len(data)
