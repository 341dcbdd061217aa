"""The registry of the Critical Data Store as it stands in the CDS: one record of 72 bytes for each block.

The layout is C's (CFE_ES_CDS_RegRec_t), with one addition: the four bytes that are padding there hold a check value, so
that a damaged record is recognised after a reset. A free record is all zeros. Imports
only cfepy.fs.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

from cfepy.fs import crc16

RECORD = struct.Struct("<IIQQ40s?7x")
FULL_NAME_SIZE = 40
"""Bytes of a block's full name, the NUL included (CFE_MISSION_ES_CDS_MAX_FULL_NAME_LEN)."""

BLOCK_HEADER = struct.Struct("<I")
"""In front of a block's data: their CRC (CFE_ES_CDS_BlockHeader_t)."""

FREE_RECORD = bytes(RECORD.size)

_CHECK_AT = 4


@dataclass(slots=True, eq=False)
class CdsBlock:
    """A block: its handle, where it is, its bytes with the header, its full name, whether it is a critical table."""

    handle: int
    offset: int
    size: int
    name: str
    is_table: bool

    @property
    def user_size(self) -> int:
        """Bytes that its owner sees."""
        return self.size - BLOCK_HEADER.size


def pack(block: CdsBlock) -> bytes:
    """The record of a block."""
    name = block.name.encode("utf-8", "surrogateescape")[: FULL_NAME_SIZE - 1]
    record = RECORD.pack(block.handle, 0, block.offset, block.size, name, block.is_table)
    return _with_check(record, crc16(record))


def is_sound(record: bytes) -> bool:
    """Whether a record is as it was written."""
    found = int.from_bytes(record[_CHECK_AT : _CHECK_AT + 4], "little")
    return found == crc16(_with_check(record, 0))


def unpack(record: bytes) -> CdsBlock:
    """The block that a record tells of."""
    handle, _, offset, size, name, is_table = RECORD.unpack(record)
    return CdsBlock(handle, offset, size, name.partition(b"\0")[0].decode("utf-8", "surrogateescape"), is_table)


def _with_check(record: bytes, check: int) -> bytes:
    return record[:_CHECK_AT] + check.to_bytes(4, "little") + record[_CHECK_AT + 4 :]
