"""roslib.message: classes of messages and services by name; the other names are genpy's."""

from __future__ import annotations

import importlib
from typing import Any

from genpy import DeserializationError, Duration, Message, SerializationError, Time, TVal
from genpy.message import check_type, fill_message_args, get_printable_message_args, strify_message

__all__ = [
    "DeserializationError",
    "Duration",
    "Message",
    "SerializationError",
    "TVal",
    "Time",
    "check_type",
    "fill_message_args",
    "get_message_class",
    "get_printable_message_args",
    "get_service_class",
    "strify_message",
]


def get_message_class(message_type: str, reload_on_error: bool = False) -> Any:
    """Return the class of a message, or None.

    Args:
        message_type: full name, such as `std_msgs/String`.
        reload_on_error: accepted.

    Raises:
        ValueError: a name without a package.
    """
    return _find("msg", message_type)


def get_service_class(service_type: str, reload_on_error: bool = False) -> Any:
    """Return the class of a service, or None; see `get_message_class`."""
    return _find("srv", service_type)


def _find(kind: str, full_name: str) -> Any:
    package, slash, name = full_name.partition("/")
    if not slash and full_name == "Header":
        package, slash, name = "std_msgs", "/", full_name
    if not package or not slash or "/" in name:
        raise ValueError(f"message type is missing package name: {full_name}")
    try:
        module = importlib.import_module(f"{package}.{kind}")
    except ImportError:
        return None
    return getattr(module, name, None)
