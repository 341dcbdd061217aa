"""The copy table: it copies bytes of input packets into combined packets. This module also checks such a table."""

from __future__ import annotations

from typing import NamedTuple

from cfepy.msg import is_valid_msg_id

from .packets import COPY_TABLE, MAX_COMBINED_PACKET_SIZE


class CopyEntry(NamedTuple):
    """One entry: `size` bytes from `input_offset` of each input packet to `output_offset` of the combined packet."""

    input_mid: int
    input_offset: int
    output_mid: int
    output_offset: int
    size: int

    @property
    def is_used(self) -> bool:
        """Whether it names packets; an unused entry names none."""
        return is_valid_msg_id(self.input_mid) or is_valid_msg_id(self.output_mid)

    @property
    def input_end(self) -> int:
        """Bytes that an input packet must have."""
        return self.input_offset + self.size

    @property
    def output_end(self) -> int:
        """Bytes that the combined packet must have."""
        return self.output_offset + self.size

    def fault(self) -> str | None:
        """Return the fault of a used entry, in the words of HK's event, or None if it is valid."""
        limit = MAX_COMBINED_PACKET_SIZE
        if not is_valid_msg_id(self.output_mid):
            return f"Invalid Output MID: 0x{self.output_mid:x}"
        if not is_valid_msg_id(self.input_mid):
            return f"Invalid Input MID: 0x{self.input_mid:x}"
        if self.input_end > limit:
            return f"Invalid input offset+size: {self.input_end} > {limit}, mid 0x{self.input_mid:x}"
        if self.output_end > limit:
            return f"Invalid output offset+size: {self.output_end} > {limit}, mid 0x{self.output_mid:x}"
        return None


def read_entries(table: bytes | memoryview) -> list[CopyEntry]:
    """Return all entries of a copy table, unused ones included."""
    return [CopyEntry(*row.values()) for row in COPY_TABLE.unpack(table)]


def find_fault(table: bytes | memoryview) -> str | None:
    """Return the first fault of a copy table with the index of its entry, or None if the table is valid."""
    for index, entry in enumerate(read_entries(table)):
        fault = entry.fault() if entry.is_used else None
        if fault is not None:
            return f"{fault} at entry index {index}"
    return None
