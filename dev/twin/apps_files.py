"""Compared content of the files of NASA's flight applications: everything except times and host-dependent orders."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.fs import HEADER_SIZE
from cfepy.fs.header import CONTENT_ID

TIMES = slice(24, 32)
"""In the header of each file."""
DS_FILE, FM_FILE = 10000, 12345
"""Subtypes of DS's files, and of FM's lists of folders."""
DS_CLOSED = slice(64, 72)
"""When DS closed the file."""
DS_HEADER = 76
FM_HEADER = 72
FM_ENTRY = 76
FM_SIZE, FM_CHANGED = slice(64, 68), slice(68, 72)
"""Of a listed file, its size and when it was changed."""


def of_file(path: str, data: bytes, of_packet: Callable[[bytes], bytes | None]) -> bytes:
    """Return the compared content of a file.

    Args:
        path: where it is. A list that lists itself shows how far it was when its turn came.
        data: its content.
        of_packet: returns the compared content of a packet that DS stored, or None to leave it out.
    """
    if len(data) < HEADER_SIZE or int.from_bytes(data[:4], "big") != CONTENT_ID:
        return data
    left = bytearray(data)
    left[TIMES] = bytes(8)
    subtype = int.from_bytes(data[4:8], "big")
    if subtype == DS_FILE:
        left[DS_CLOSED] = bytes(8)
        begin = HEADER_SIZE + DS_HEADER
        told = sorted(each for each in map(of_packet, _packets(data[begin:])) if each is not None)
        return bytes(left[:begin]) + b"".join(told)
    if subtype == FM_FILE:
        begin = HEADER_SIZE + FM_HEADER
        entries = [bytearray(data[at : at + FM_ENTRY]) for at in range(begin, len(data), FM_ENTRY)]
        for entry in entries:
            entry[FM_CHANGED] = bytes(4)
            if entry.partition(b"\0")[0] == path.rpartition("/")[2].encode():
                entry[FM_SIZE] = bytes(4)
        return bytes(left[:begin]) + b"".join(sorted(map(bytes, entries)))
    return bytes(left)


def _packets(data: bytes) -> list[bytes]:
    found = []
    while len(data) > 6:
        size = 7 + int.from_bytes(data[4:6], "big")
        found.append(data[:size])
        data = data[size:]
    return found
