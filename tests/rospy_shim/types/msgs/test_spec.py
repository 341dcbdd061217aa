"""The .msg parser: genmsg's rules, and errors with their location."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.status import UsageError
from rospy_shim.types.msgs import Library, Shipped, from_full_text
from rospy_shim.types.msgs.spec import parse


def _types(text: str) -> list[tuple[str, str]]:
    return [(field.type, field.attribute) for field in parse(text, "pkg/X", "X.msg").fields]


@pytest.mark.parametrize(
    ("text", "fields"),
    [
        ("", []),
        ("# only a comment\n\n", []),
        ("float64 x # metres\r\n", [("float64", "x")]),
        ("  float64   x\nint8\ty", [("float64", "x"), ("int8", "y")]),
        ("float64[] a\nfloat64[36] b\nstring[0] c", [("float64[]", "a"), ("float64[36]", "b"), ("string[0]", "c")]),
        ("Header header", [("std_msgs/Header", "header")]),
        ("Header[] hs", [("pkg/Header[]", "hs")]),
        ("Foo a\nother/Foo b", [("pkg/Foo", "a"), ("other/Foo", "b")]),
        ("int8 from\nint8 self\nint8 print", [("int8", "from_"), ("int8", "self_"), ("int8", "print")]),
        (["string ", " A=x\\"][0] + "s", [("string", "s")]),
    ],
)
def test_fields(text: str, fields: list[tuple[str, str]]) -> None:
    assert _types(text) == fields


@pytest.mark.parametrize(
    ("line", "value", "text"),
    [
        ("int8 A=-3", -3, "-3"),
        ("uint8 A\t\t= 7 # seven = 7", 7, "7"),
        ("char A=65", 65, "65"),
        ("float32 A=1", 1.0, "1"),
        ("bool A=1", True, "1"),
        ("bool A=False", False, "False"),
        ("string A= keeps # this = too ", "keeps # this = too", "keeps # this = too"),
        ("string A=", "", ""),
    ],
)
def test_constants(line: str, value: object, text: str) -> None:
    (constant,) = parse(line, "pkg/X", "X.msg").constants
    assert (constant.name, constant.value, constant.text) == ("A", value, text)
    assert type(constant.value) is type(value)


@pytest.mark.parametrize(
    "line",
    [
        "float64",
        "float64 x y",
        "float64 1x",
        "float64 _x",
        "float64 a-b",
        "float64[a] x",
        "float64[-1] x",
        "float64[2][3] x",
        "foo!bar x",
        "int8 A=300",
        "int8 A=x",
        "int8 A=1=2",
        "int8 A=",
        "time A=1",
        "string[] A=b",
        "bool A=maybe",
        "int8 ok",
    ],
)
def test_mistakes_name_file_and_line(line: str) -> None:
    with pytest.raises(UsageError, match=r"^/pkg/msg/X\.msg:3: ") as caught:
        parse(f"# head\nint8 ok\n{line}\n", "pkg/X", "/pkg/msg/X.msg")
    assert caught.value.line == 3


def test_only_a_leading_header_counts() -> None:
    assert parse("Header header\nint8 a", "pkg/X", "").has_header
    assert not parse("int8 a\nHeader header", "pkg/X", "").has_header
    assert not parse("Header h", "pkg/X", "").has_header


def test_unknown_and_endless_types(tmp_path: Path) -> None:
    library = Library([Shipped(tmp_path)])
    (tmp_path / "bad.msgs").write_text("# bad/A\nB b\n\n# bad/B\nA a\n\n# bad/C\nint8 i\nNowhere x\n", encoding="utf-8")
    with pytest.raises(UsageError, match="bad/A contains itself"):
        library.message_class("bad/A")
    with pytest.raises(UsageError, match=r"bad\.msgs:9: unknown message type bad/Nowhere"):
        library.message_class("bad/C")
    with pytest.raises(UsageError, match="unknown message type 'bad/D'"):
        library.message_class("bad/D")
    with pytest.raises(UsageError, match="unknown service type 'bad/E'"):
        library.service_class("bad/E")


def test_full_text_round_trip() -> None:
    library = Library([Shipped()])
    text = library.full_text("nav_msgs/Odometry")
    again = from_full_text("nav_msgs/Odometry", text)
    assert again.full_text("nav_msgs/Odometry") == text
    assert again.md5sum("nav_msgs/Odometry") == "cd5e73d190d741a2f92e81eda573aca7"


def test_mistake_in_a_full_text_has_its_line() -> None:
    text = "pkg/B b\n" + "=" * 80 + "\nMSG: pkg/B\nint8 x\nint8 x\n"
    with pytest.raises(UsageError) as caught:
        from_full_text("pkg/A", text).message_class("pkg/A")
    assert caught.value.line == 5
