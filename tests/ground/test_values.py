"""Field values from text, and text from values."""

from __future__ import annotations

import pytest

from cfepy.ground.values import flat, line_of, number_of, packet_of, text_of
from cfepy.msg import Command, Layout
from cfepy.status import UsageError

INNER = Layout("Inner", [("Name", "char[8]"), ("Id", "u16")])
COMMAND = Command(
    "APP_SET",
    0x1882,
    3,
    Layout(
        "Set",
        [
            ("Count", "u8"),
            ("Signed", "i16"),
            ("Ratio", "f32"),
            ("On", "bool"),
            ("Masks", "u32[3]"),
            ("Inner", INNER),
            ("Points", (INNER, 2)),
            ("Grid", "u8[2][2]"),
            ("Names", "char[2][4]"),
        ],
    ),
)


def read(*words: str) -> dict[str, object]:
    return flat(COMMAND.read(packet_of(COMMAND, words)))


@pytest.mark.parametrize(
    ("word", "path", "value"),
    [
        ("Count=16", "Count", 16),
        ("Count=0x10", "Count", 16),
        ("Count=0b11", "Count", 3),
        ("Count=007", "Count", 7),
        ("Signed=-3", "Signed", -3),
        ("Ratio=2.5", "Ratio", 2.5),
        ("Ratio=-1e3", "Ratio", -1000.0),
        ("On=true", "On", True),
        ("On=0", "On", False),
        ("Inner.Name=HK", "Inner.Name", "HK"),
        ("Inner.Name=a=b", "Inner.Name", "a=b"),
        ("Points[1].Id=9", "Points[1].Id", 9),
        ("Masks[2]=7", "Masks[2]", 7),
        ("Names[1]=ab", "Names[1]", "ab"),
    ],
)
def test_value_is_written_to_its_field_only(word: str, path: str, value: object) -> None:
    changed = {name: each for name, each in read(word).items() if each != read()[name]}
    assert changed == ({path: value} if value else {})
    assert read(word)[path] == value


def test_arrays_are_written_with_commas() -> None:
    values = read("Masks=1,0x2", "Grid=1,2,3,4", "Names=ab,cd")
    assert [values[f"Masks[{number}]"] for number in range(3)] == [1, 2, 0]
    assert [values[path] for path in ("Grid[0][0]", "Grid[0][1]", "Grid[1][0]", "Grid[1][1]")] == [1, 2, 3, 4]
    assert (values["Names[0]"], values["Names[1]"]) == ("ab", "cd")


def test_packet_has_the_header_of_its_command() -> None:
    assert packet_of(COMMAND, ["Count=1", "Inner.Id=2"]) == COMMAND.packet(Count=1, Inner={"Id": 2})


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("Cuont=1", "Cuont: unknown field of APP_SET; did you mean Count?"),
        ("Inner=1", "Inner: unknown field of APP_SET; did you mean Inner.Id?"),
        ("Inner", "invalid field value 'Inner'; expected FIELD=VALUE"),
        ("Count=300", "Count: 300 does not fit u8"),
        ("Count=-1", "Count: -1 does not fit u8; expected 0 to 255"),
        ("Count=1.5", "Count: must be an integer, not '1.5'"),
        ("Count=", "Count: must be an integer, not ''"),
        ("Ratio=x", "Ratio: must be a number, not 'x'"),
        ("On=maybe", "On: must be true or false, not 'maybe'"),
        ("Masks=1,2,3,4", "Masks: must have at most 3 items, not 4"),
        ("Masks=1,x", "Masks[1]: must be an integer, not 'x'"),
        ("Masks[3]=1", "Masks[3]: unknown field of APP_SET; did you mean Masks?"),
        ("Inner.Name=muchtoolong", "Inner.Name: must have at most 8 bytes, not 11: 'muchtoolong'"),
    ],
)
def test_mistake_names_the_field_and_the_valid_values(word: str, said: str) -> None:
    with pytest.raises(UsageError) as error:
        packet_of(COMMAND, [word])
    assert str(error.value).startswith(said)


def test_all_wrong_fields_are_raised_together() -> None:
    with pytest.raises(UsageError) as error:
        packet_of(COMMAND, ["Cuont=1", "Ratio=x", "Masks=1,2,3,4", "Inner"])
    assert [each.field for each in error.value.each] == ["Cuont", "Ratio", "Masks", None]


def test_field_given_twice_is_refused() -> None:
    with pytest.raises(UsageError, match="Count: is given twice"):
        packet_of(COMMAND, ["Count=1", "Count=2"])


def test_command_without_fields_refuses_a_field() -> None:
    with pytest.raises(UsageError, match="X: APP_NOOP has no fields"):
        packet_of(Command("APP_NOOP", 0x1882, 0), ["X=1"])


def test_numbers_of_any_kind() -> None:
    assert [number_of(text) for text in ("0x10", "-3", "2.5", "true", "FALSE", "08")] == [16, -3, 2.5, 1, 0, 8]
    with pytest.raises(ValueError, match="hold"):
        number_of("hold")


def test_line_of_values_can_be_typed() -> None:
    words = ["Count=3", "Ratio=0.5", "Masks=1,2,3", "Inner.Name=a b", "Points[0].Id=4"]
    line = line_of(COMMAND.read(packet_of(COMMAND, words)))
    assert line == (
        'Count=3 Signed=0 Ratio=0.5 On=0 Masks=1,2,3 Inner.Name="a b" Inner.Id=0 Points[0].Name="" Points[0].Id=4 '
        'Names="",""'
    )


def test_values_as_text() -> None:
    assert [text_of(value) for value in (b"\x01\xff", 1 / 3, True, "", "x", "a,b", -1)] == [
        "01ff", "0.3333333", "1", '""', "x", '"a,b"', "-1",
    ]  # fmt: skip
