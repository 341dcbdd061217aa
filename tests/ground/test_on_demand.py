"""Lists whose items are decoded when they are read."""

from __future__ import annotations

import pytest

from cfepy.ground.on_demand import DecodingList


def read_into(read: list[int]) -> DecodingList[str]:
    """Return the decoded numbers 0 to 9; `read` gets each that is decoded."""
    return DecodingList([*range(10)], lambda number: read.append(number) or f"<{number}>")  # type: ignore[func-returns-value]


def test_last_item_is_decoded_alone_and_once() -> None:
    read: list[int] = []
    items = read_into(read).present()
    assert (items[-1], items[9], items[-10], len(items)) == ("<9>", "<9>", "<0>", 10)
    assert read == [9, 0]


def test_items_of_several_requests_are_decoded_once() -> None:
    read: list[int] = []
    decoded = read_into(read)
    assert decoded.present()[3:5] == ["<3>", "<4>"]
    assert list(decoded.present()) == [f"<{number}>" for number in range(10)]
    assert decoded.present()[::-1][0] == "<9>"
    assert sorted(read) == [*range(10)]


def test_items_of_an_earlier_request_do_not_grow_with_the_list() -> None:
    raw = [1]
    decoded = DecodingList(raw, str)
    before = decoded.present()
    raw.append(2)
    assert (before, decoded.present()) == (["1"], ["1", "2"])
    with pytest.raises(IndexError, match="index 1 is outside of 1 items"):
        before[1]


def test_items_compare_and_show_as_a_list() -> None:
    items = DecodingList([1, 2], str).present()
    assert items == ["1", "2"]
    assert items == ("1", "2")
    assert items == DecodingList([1, 2], str).present()
    assert items != ["1"]
    assert items != ["1", "3"]
    assert items != "12"
    more = ["3"]
    assert (repr(items), items + more, more + items) == ("['1', '2']", ["1", "2", "3"], ["3", "1", "2"])
    assert "2" in items
    assert not DecodingList([], str).present()
