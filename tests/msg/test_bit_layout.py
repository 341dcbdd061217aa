"""Layouts with bits and byte orders of their own."""

from __future__ import annotations

import random
import struct
from typing import Any

import pytest

from cfepy.ground import flat
from cfepy.msg import BitLayout, FieldPlace, Layout, ValueNames
from cfepy.status import CfeError, UsageError

PLACES = [
    FieldPlace(("Version",), "u", 0, 3),
    FieldPlace(("Flag",), "bool", 3, 1),
    FieldPlace(("Count",), "i", 4, 12),
    FieldPlace(("Word",), "u", 16, 32, big_endian=False),
    FieldPlace(("Real",), "f", 48, 32),
    FieldPlace(("Name",), "char", 80, 24),
    FieldPlace(("Rows", 0, "Low"), "u", 104, 16),
    FieldPlace(("Rows", 1, "Low"), "u", 120, 16),
    FieldPlace(("Mode",), "u", 136, 8, names=ValueNames.of("u8", {"Off": 0, "Half/full": 7})),
]
LAYOUT = BitLayout("Mixed", PLACES, 18)
VALUES: dict[str, Any] = {
    "Version": 5,
    "Flag": True,
    "Count": -2,
    "Word": 0x01020304,
    "Real": 1.5,
    "Name": "ab",
    "Rows": [{"Low": 1}, {"Low": 0x102}],
    "Mode": 7,
}
PACKED = "bffe040302013fc000006162000001010207"


def test_pack_puts_each_field_in_its_place() -> None:
    assert LAYOUT.pack(VALUES).hex() == PACKED


def test_unpack_returns_nested_values() -> None:
    assert LAYOUT.unpack(bytes.fromhex(PACKED)) == VALUES


def test_missing_fields_are_zero() -> None:
    assert LAYOUT.pack(Rows=[{}, {"Low": 1}]) == bytes(16) + b"\x01" + bytes(1)


def test_name_of_a_value_may_have_any_characters() -> None:
    assert LAYOUT.pack(Mode="half/FULL")[-1] == 7


@pytest.mark.parametrize(
    ("values", "field", "text"),
    [
        ({"Version": 8}, "Version", "8 does not fit u3; expected 0 to 7"),
        ({"Count": -2049}, "Count", "-2049 does not fit i12; expected -2048 to 2047"),
        ({"Count": 1.5}, "Count", "must be an integer, not 1.5"),
        ({"Name": "abcd"}, "Name", "must have at most 3 bytes, not 4: 'abcd'"),
        ({"Real": 1e300}, "Real", "1e+300 does not fit f32"),
        ({"Mode": "On"}, "Mode", "unknown value 'On'; expected one of Off (0), Half/full (7)"),
        ({"Rows": [{"Low": 1}, {}, {"Low": 3}]}, "Rows[2]", "has no place in Mixed; remove it"),
        ({"Rows": [{"High": 1}]}, "Rows[0].High", "has no place in Mixed; remove it"),
        ({"Other": 1}, "Other", "unknown field of Mixed"),
    ],
)
def test_value_that_does_not_fit_is_named(values: dict[str, Any], field: str, text: str) -> None:
    with pytest.raises(UsageError) as caught:
        LAYOUT.pack(values)
    assert caught.value.field == field
    assert caught.value.text.startswith(text)


def test_short_packet_is_refused() -> None:
    with pytest.raises(CfeError, match="Mixed requires 18 bytes"):
        LAYOUT.unpack(bytes(17))


def test_cells_tell_bits_and_byte_order() -> None:
    found = {cell.path: (cell.type, cell.start, cell.width, cell.big_endian) for cell in LAYOUT.cells()}
    assert found["Count"] == ("i12", 4, 12, True)
    assert found["Word"] == ("u32", 16, 32, False)
    assert found["Rows[1].Low"] == ("u16", 120, 16, True)
    assert (LAYOUT.fields[:3], LAYOUT.sizes["Rows"]) == (("Version", "Flag", "Count"), 4)


def test_put_changes_one_cell_alone() -> None:
    payload = bytearray.fromhex(PACKED)
    for cell in LAYOUT.cells():
        if cell.path == "Count":
            LAYOUT.put(cell, 3, payload)
    assert LAYOUT.unpack(payload) == {**VALUES, "Count": 3}


def test_struct_inside_of_another_layout() -> None:
    outer = Layout("Outer", [("Id", "u8"), ("Inner", LAYOUT)])
    data = outer.pack(Id=9, Inner=VALUES)
    assert data.hex() == "09" + PACKED
    assert outer.unpack(data) == {"Id": 9, "Inner": VALUES}
    assert [cell.offset for cell in outer.cells()][:2] == [0, 1]


def test_random_bytes_survive_a_round_trip() -> None:
    draw = random.Random(3)
    for _ in range(200):
        places, at = [], 0
        for number in range(draw.randint(1, 8)):
            kind = draw.choice("uib")
            bits = 1 if kind == "b" else draw.randint(1 if kind == "u" else 2, 64)
            whole = bits % 8 == 0 and at % 8 == 0
            places.append(
                FieldPlace(
                    (f"F{number}",), "bool" if kind == "b" else kind, at, bits, not (whole and draw.random() < 0.5)
                )
            )
            at += bits
        layout = BitLayout("Random", places, -(-at // 8))
        data = int.from_bytes(draw.randbytes(layout.size), "big") >> (8 * layout.size - at) << (8 * layout.size - at)
        packed = data.to_bytes(layout.size, "big")
        assert layout.pack(layout.unpack(packed)) == packed


def test_places_of_a_plain_struct_read_as_the_plain_layout() -> None:
    plain = Layout("Plain", [("A", "u8"), ("B", "i32"), ("C", "f64"), ("D", "u16[3]")])
    places = [
        FieldPlace(("A",), "u", 0, 8),
        FieldPlace(("B",), "i", 32, 32, big_endian=False),
        FieldPlace(("C",), "f", 64, 64, big_endian=False),
        *(FieldPlace(("D", number), "u", 128 + 16 * number, 16, big_endian=False) for number in range(3)),
    ]
    layout = BitLayout("Placed", places, plain.size)
    data = plain.pack(A=1, B=-2, C=struct.unpack("<d", bytes(range(8)))[0], D=[1, 2, 3])
    assert flat(layout.unpack(data)) == flat(plain.unpack(data))
