"""CRC-16/ARC and the kinds that cFE only names."""

from __future__ import annotations

import pytest

from cfepy import fs


@pytest.mark.parametrize(
    ("data", "crc"),
    [(b"123456789", 0xBB3D), (b"", 0), (bytes.fromhex("01000200"), 0x9C00), (bytes(100), 0)],
)
def test_known_values(data: bytes, crc: int) -> None:
    assert fs.calculate_crc(data) == fs.crc16(data) == crc


@pytest.mark.parametrize("kind", [fs.CRC_NONE, fs.CRC_8, fs.CRC_32, 99])
def test_other_kinds_of_crc_are_zero(kind: int) -> None:
    assert fs.calculate_crc(b"123456789", 5, kind) == 0


def test_crc_of_no_data_is_the_input_crc() -> None:
    assert fs.calculate_crc(b"", 0x1234, fs.CRC_8) == 0x1234


@pytest.mark.parametrize("size", [511, 512, 513, 1000, 4096, 5000])
def test_crc_of_long_data_equals_the_crc_of_its_single_bytes(size: int) -> None:
    data = bytes(number * number % 251 for number in range(size))
    for before in (0, 0x1234, 0xFFFF):
        crc = before
        for at in range(size):
            crc = fs.crc16(data[at : at + 1], crc)
        assert fs.crc16(data, before) == fs.crc16(memoryview(bytearray(data)), before) == crc
