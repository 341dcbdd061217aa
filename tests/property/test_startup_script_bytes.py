"""The startup script's reader accepts any bytes without an exception."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from cfepy.es.startup_script import check, parse


@given(st.binary(max_size=400))
def test_any_bytes_give_one_result_for_each_entry(data: bytes) -> None:
    results = list(parse(data))
    assert len(results) == data.partition(b"!")[0].count(b";")
    assert [result.number for result in results] == list(range(1, len(results) + 1))
    assert all(1 <= result.line <= 1 + data.count(b"\n") for result in results)
    assert all(1 <= note.line <= 1 + data.count(b"\n") for note in check(data))


@given(st.lists(st.sampled_from([b"CFE_APP", b"CFE_LIB", b",", b";", b"\n", b" ", b"hk", b"0x", b"!", b"/", b"."])))
def test_bytes_like_a_script_give_one_result_for_each_entry(parts: list[bytes]) -> None:
    data = b"".join(parts)
    assert len(list(parse(data))) == data.partition(b"!")[0].count(b";")
    check(data)
