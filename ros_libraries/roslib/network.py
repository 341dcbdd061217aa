"""roslib.network: an older name of rosgraph.network."""

from __future__ import annotations

from rosgraph.network import (
    ROSHandshakeException,
    create_local_xmlrpc_uri,
    decode_ros_handshake_header,
    encode_ros_handshake_header,
    get_address_override,
    get_bind_address,
    get_host_name,
    get_local_address,
    get_local_addresses,
    is_local_address,
    parse_http_host_and_port,
    read_ros_handshake_header,
    write_ros_handshake_header,
)
from rosgraph.rosenv import ROS_HOSTNAME, ROS_IP

__all__ = [
    "ROS_HOSTNAME",
    "ROS_IP",
    "ROSHandshakeException",
    "create_local_xmlrpc_uri",
    "decode_ros_handshake_header",
    "encode_ros_handshake_header",
    "get_address_override",
    "get_bind_address",
    "get_host_name",
    "get_local_address",
    "get_local_addresses",
    "is_local_address",
    "parse_http_host_and_port",
    "read_ros_handshake_header",
    "write_ros_handshake_header",
]
