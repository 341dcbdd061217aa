"""The limits that keep a count in a packet from making more objects than its bytes justify.

An array of messages is read one after the other. Most types fail where the bytes end, so their count needs no check.
Two kinds do not: messages that consist of octets of fixed arrays alone, which genpy accepts even if they are cut short,
and messages that take no bytes at all. The former are limited to the number that the remaining bytes can fill. The
latter are limited to a fixed number in each message, the same as in the headers for C++ (roscfe/wire.h).
"""

from __future__ import annotations

import struct

from rospy_shim.types.msgs.reference import OCTETS, Lookup
from rospy_shim.types.msgs.spec import Spec

MOST_EMPTY = 65_536
"""Maximum number of items without bytes, in all arrays of a message together."""


def unguarded_size(spec: Spec, lookup: Lookup) -> int | None:
    """Return the bytes of a message whose decoding does not fail where the bytes end; None if it does fail.

    Args:
        spec: its type.
        lookup: specs of nested types.
    """
    size = 0
    for field in spec.fields:
        if field.length == 0:
            continue
        if field.is_array and field.length is None:
            return None
        if field.base in OCTETS and field.length is not None:
            size += field.length
            continue
        inner = unguarded_size(lookup(field.base), lookup) if "/" in field.base else None
        if inner is None:
            return None
        size += inner * (field.length or 1)
    return size


def too_short(size: int) -> struct.error:
    """Make the error for bytes that end before `size` more of them."""
    return struct.error(f"unpack requires a buffer of {size} bytes")


def too_many_empty() -> struct.error:
    """Make the error for more than `MOST_EMPTY` items that take no bytes."""
    return struct.error(f"more than {MOST_EMPTY:,} items that take no bytes")
