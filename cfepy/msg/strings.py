"""Text in the fixed-size fields of a message: NUL-filled, and not ended by a NUL when it fills its field.

Stands for CFE_SB_MessageStringSet and CFE_SB_MessageStringGet. Imports only cfepy.status and the primary header.
"""

from __future__ import annotations

from cfepy.msg.header import Packet
from cfepy.status import CFE_SB_BAD_ARGUMENT, CfeError


def message_string_set(text: str, size: int) -> bytes:
    """The bytes of a text field: cut to `size`, or filled up with NULs (CFE_SB_MessageStringSet).

    Raises:
        CfeError: CFE_SB_BAD_ARGUMENT for a negative size.
    """
    if size < 0:
        raise CfeError(CFE_SB_BAD_ARGUMENT, f"a text field of {size} bytes")
    return text.encode("utf-8", "surrogateescape")[:size].ljust(size, b"\0")


def message_string_get(field: Packet, size: int, default: str | None = None) -> str:
    """The text of a field, short enough for a C buffer of `size` bytes (CFE_SB_MessageStringGet).

    Args:
        field: the bytes of the field; the text ends at the first NUL or where the field ends.
        size: bytes of the buffer, the NUL at its end included.
        default: taken when the field is empty.

    Raises:
        CfeError: CFE_SB_BAD_ARGUMENT for a size of 0.
    """
    if size <= 0:
        raise CfeError(CFE_SB_BAD_ARGUMENT, "a buffer of no bytes holds no text")
    data = bytes(field).partition(b"\0")[0]
    if not data and default is not None:
        data = default.encode("utf-8", "surrogateescape")
    return data[: size - 1].decode("utf-8", "surrogateescape")
