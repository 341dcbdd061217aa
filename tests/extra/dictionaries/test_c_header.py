"""Structs in C headers that are compared with compiled ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.dictionaries import header_difference

COMPILED = (("one", "u8", 1), ("two", "u8", 1), ("list", "i16", 4), ("last", "f32", 1))


def found(tmp_path: Path, *members: str) -> tuple[int, str] | None:
    """Compare a struct with these lines."""
    file = tmp_path / "packets.h"
    file.write_text("\n".join(("typedef struct {", *members, "} Payload_t;", "")), encoding="utf-8")
    return header_difference(file, "Payload_t", COMPILED)


@pytest.mark.parametrize(
    "members",
    [
        ("uint8 one;", "uint8 two;", "int16 list[4];", "float last;"),
        ("uint8 one, two; /* a, b */", "int16 list[4];", "float last;"),
        ("#if 0", "uint8 old:4;", "int old2;", "#endif", "uint8 one, two;", "int16 list[2][2];", "float last;"),
    ],
)
def test_same_members_are_no_difference(members: tuple[str, ...], tmp_path: Path) -> None:
    assert found(tmp_path, *members) is None


def test_changed_member_has_its_line(tmp_path: Path) -> None:
    assert found(tmp_path, "uint8 one,", "  new;", "int16 list[4];", "float last;") == (
        3,
        ".new: is here, where two is",
    )
    assert found(tmp_path, "uint8 one, two;", "int16 list[3];", "float last;") == (3, ".list: has 3 items here, but 4")
    assert found(tmp_path, "uint8 one, two;", "uint16 list[4];", "float last;") == (3, ".list: is u16 here, but i16")
    assert found(tmp_path, "uint8 one, two;", "int16 list[4];") == (1, ": has 3 members here, but 4")


@pytest.mark.parametrize(
    "line",
    ["uint8 bits:3;", "char *name;", "#ifdef WIDE", "void (*call)(int a, int b);", "uint8 a, *b;", "#if 0\n#else"],
)
def test_struct_in_another_form_is_not_compared(line: str, tmp_path: Path) -> None:
    more = "#endif" if line.startswith("#") else ""
    assert found(tmp_path, line, "uint8 other;", more, "float last;") is None
