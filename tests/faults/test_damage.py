"""The bits and bytes of a message that a fault changes."""

from __future__ import annotations

from random import Random

import pytest

from cfepy.faults.message_faults import damaged

DATA = bytes(range(16))


def places(changed: bytes, data: bytes = DATA) -> list[int]:
    """Return the numbers of the bits that differ."""
    pairs = enumerate(zip(changed, data, strict=True))
    return [8 * at + bit for at, (one, other) in pairs for bit in range(8) if (one ^ other) >> bit & 1]


@pytest.mark.parametrize("bits", [1, 3, 64])
def test_given_number_of_bits_flips_after_the_header(bits: int) -> None:
    seen: set[int] = set()
    for seed in range(1000):
        found = places(damaged(DATA, 8, {"bits": bits}, Random(seed)))
        assert len(found) == bits
        seen.update(found)
    assert seen == set(range(64, 128))


def test_one_bit_is_the_default() -> None:
    assert len(places(damaged(DATA, 8, {}, Random(1)))) == 1


@pytest.mark.parametrize("start", [16, 20])
def test_packet_without_data_has_its_header_damaged(start: int) -> None:
    found = {place for seed in range(200) for place in places(damaged(DATA, start, {}, Random(seed)))}
    assert (min(found), max(found) < 128, len(found) > 60) == (0, True, True)


def test_more_bits_than_available_flip_all() -> None:
    assert damaged(b"\x0f", 0, {"bits": 50}, Random(1)) == b"\xf0"
    assert damaged(b"", 0, {}, Random(1)) == b""


def test_bytes_are_set_at_existing_positions() -> None:
    options = {"bytes": {0: 255, 15: 254, 16: 253, -16: 252, -17: 251}}
    assert damaged(DATA, 8, options, Random(1)) == bytes([252]) + DATA[1:15] + bytes([254])
