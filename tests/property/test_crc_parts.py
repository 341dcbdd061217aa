"""A CRC does not depend on how the data is cut."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from cfepy import fs


@given(st.binary(max_size=100), st.binary(max_size=100), st.integers(0, 0xFFFF))
def test_crc_of_parts_equals_the_crc_of_the_whole(first: bytes, second: bytes, start: int) -> None:
    assert fs.crc16(second, fs.crc16(first, start)) == fs.crc16(first + second, start)
