"""Decompression of damaged or truncated LZ4 frames, compared with the package lz4, which decompresses complete ones."""

from __future__ import annotations

import random
import struct
from collections.abc import Iterator
from itertools import pairwise

import lz4.frame
import pytest

from ros_libraries.rosbag_storage import lz4_frames

BLOCK_AT = 11  # behind the header of a frame without a size, and the size of its first block
DRAW = random.Random(11)
TEXT = bytes(DRAW.choices(b"abcd", k=3000)) + bytes(2000) + b"abcd" * 700 + DRAW.randbytes(1500)
FRAMES = [
    {"block_size": size, "block_linked": linked, "block_checksum": sums, "store_size": sums, "compression_level": level}
    for size in (lz4.frame.BLOCKSIZE_MAX64KB, lz4.frame.BLOCKSIZE_MAX1MB)
    for linked in (True, False)
    for sums in (True, False)
    for level in (0, 9)
]


def tokens(block: bytes) -> Iterator[int]:
    """Yield where the sequences of a block begin, by the description of the format (lz4_Block_format.md)."""
    at = 0
    while at < len(block):
        yield at
        literals, match = divmod(block[at], 16)
        literals, at = full_length(block, at + 1, literals)
        _, at = full_length(block, at + literals + 2, match)


def full_length(block: bytes, at: int, length: int) -> tuple[int, int]:
    """Return a length with its continuation bytes, and their end."""
    if length == 15:
        rest = next(index for index in range(at, len(block)) if block[index] != 255)
        return 15 + sum(block[at : rest + 1]), rest + 1
    return length, at


def beginning(frame: bytes) -> bytes:
    return lz4_frames.beginning(frame, 1 << 22)


@pytest.mark.parametrize("options", FRAMES)
def test_longer_part_of_a_frame_gives_a_longer_part_of_the_text(options: dict[str, int]) -> None:
    text = TEXT * 20  # several blocks of 64 KB
    frame = lz4.frame.compress(text, content_checksum=True, **options)
    found = [beginning(frame[:cut]) for cut in range(0, len(frame), 997)]
    assert all(text.startswith(each) for each in found)
    assert all(len(one) <= len(other) for one, other in pairwise(found))
    assert beginning(frame) == text


@pytest.fixture(scope="module")
def frame() -> bytes:
    """A frame of one block."""
    return lz4.frame.compress(TEXT, block_linked=False, store_size=False)


@pytest.fixture(scope="module")
def places(frame: bytes) -> list[int]:
    """Where the sequences of its block begin."""
    size = struct.unpack_from("<I", frame, BLOCK_AT - 4)[0]
    return [BLOCK_AT + each for each in tokens(frame[BLOCK_AT : BLOCK_AT + size])]


def test_each_complete_sequence_of_a_block_is_unpacked(frame: bytes, places: list[int]) -> None:
    found = [beginning(frame[:place]) for place in places]
    assert len(found) > 100
    assert all(TEXT.startswith(each) for each in found)
    assert all(len(one) < len(other) for one, other in pairwise(found))


def test_damaged_byte_keeps_each_sequence_before_it(frame: bytes, places: list[int]) -> None:
    for at in range(BLOCK_AT, len(frame) - 4, 5):
        damaged = bytearray(frame)
        damaged[at] ^= 1 << DRAW.randrange(8)
        before = max(place for place in places if place <= at)
        assert beginning(bytes(damaged)).startswith(beginning(frame[:before])), at
