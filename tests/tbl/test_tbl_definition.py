"""`TableType`: tables from plain values and back."""

from __future__ import annotations

from typing import Any

import pytest

from cfepy.msg import Layout
from cfepy.status import UsageError
from cfepy.tbl import TableType, build, read

POINTS = TableType("APP.Points", Layout("Point", [("X", "u8"), ("Y", "u16")]), rows=3, description="Points")
SINGLE = TableType("APP.Single", Layout("Single", [("X", "u8"), ("Y", "u16")]))


@pytest.mark.parametrize(
    "rows",
    [[{}, {"X": 1, "Y": 2}], {1: {"X": 1, "Y": 2}}, {1: {"X": 1, "Y": 2}, 2: {}}],
    ids=["list", "numbered", "all"],
)
def test_rows_can_be_given_in_order_or_by_number(rows: Any) -> None:
    assert POINTS.pack(rows) == bytes.fromhex("00000000 01000200 00000000")


def test_single_row_is_given_by_its_fields() -> None:
    assert SINGLE.pack({"Y": 3}) == bytes.fromhex("00000300") == SINGLE.pack([{"Y": 3}])
    assert SINGLE.pack({}) == bytes(4)


def test_unpack_is_the_inverse() -> None:
    image = bytes(range(POINTS.size))
    rows = POINTS.unpack(image)
    assert len(rows) == 3
    assert rows[2] == {"X": 8, "Y": 0x0B0A}


def test_image_is_ready_for_a_file() -> None:
    image = read(build(POINTS.image([{"X": 9}])))
    assert (image.name, image.description, image.data) == ("APP.Points", "Points", bytes([9]) + bytes(11))


@pytest.mark.parametrize(
    ("kind", "rows", "field"),
    [
        (POINTS, [{}] * 4, "rows"),
        (POINTS, {3: {}}, "rows[3]"),
        (POINTS, {-1: {}}, "rows[-1]"),
        (POINTS, {0: {}, "X": 1}, "rows[X]"),
        (POINTS, [{}, {"Z": 1}], "rows[1].Z"),
        (POINTS, {2: {"X": 256}}, "rows[2].X"),
    ],
)
def test_values_that_do_not_fit_are_refused(kind: TableType, rows: Any, field: str) -> None:
    with pytest.raises(UsageError) as caught:
        kind.pack(rows)
    assert caught.value.field == field


def test_image_of_another_size_is_refused() -> None:
    with pytest.raises(UsageError, match=r"must have 12 bytes for APP\.Points, not 11"):
        POINTS.unpack(bytes(11))
