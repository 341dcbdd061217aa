"""Macros of compiled applications and their values."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.c import macros_of
from cfepy.extra.c.macros import Macro, Macros
from tests.extra.c.building import compile_c, needs_compiler

MACROS = Macros(
    {
        "BASE": Macro(None, "0x1800"),
        "MIDV": Macro(("topic",), "(BASE_##topic | TOPIC(topic))"),
        "TOPIC": Macro(("name",), "name##_TOPIC"),
        "BASE_CMD": Macro(None, "((uint16)BASE)"),
        "CMD_TOPIC": Macro(None, "0xBA"),
        "CMD_MID": Macro(None, "MIDV(CMD)"),
        "OCTAL": Macro(None, "010 + 1u"),
        "MIXED": Macro(None, "2 + 3 * (7 - 1 << 1) / 4 % 5 ^ ~0 & 6"),
        "ENUM": Macro(None, "TANK_Code_SET"),
        "SELF": Macro(None, "SELF + 1"),
        "TEXT": Macro(None, '"text"'),
        "DEEP": Macro(None, "(" * 4000 + "1" + ")" * 4000),
        "SIGNS": Macro(None, "-" * 4000 + "1"),
        "SHIFT": Macro(None, "1 << 99999999"),
        "ZERO": Macro(None, "1 / 0"),
        "WORD": Macro(None, "1CMD"),
        "OPEN": Macro(None, "MIDV(CMD"),
    }
)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("CMD_MID", 0x18BA),
        ("OCTAL", 9),
        ("MIXED", (2 + 3 * ((7 - 1) << 1) // 4 % 5) ^ (0xFFFFFFFF & 6)),
        ("ENUM", 5),
        *((name, None) for name in ("SELF", "TEXT", "DEEP", "SIGNS", "SHIFT", "ZERO", "WORD", "OPEN", "NOTHING")),
    ],
)
def test_value_is_as_the_compiler_computes_it(name: str, value: int | None) -> None:
    assert MACROS.value(name, {"TANK_Code_SET": 5}) == value


def test_names_have_their_suffix_and_no_arguments() -> None:
    assert MACROS.names("_MID", "_TOPIC") == ["CMD_TOPIC", "CMD_MID"]


@needs_compiler
@pytest.mark.parametrize("version", ["-gdwarf-5", "-gdwarf-4"])
def test_macros_of_a_shared_object(tmp_path: Path, version: str) -> None:
    source = """
        #define TANK_TOPIC(x) TANK_##x##_TOPIC
        #define TANK_CMD_TOPIC 0x20
        #define TANK_CMD_MID (0x1800 | TANK_TOPIC(CMD))
        void TANK_Main(void) { }
    """
    data = compile_c(tmp_path, "tank", source, "-g3", version).read_bytes()
    found = macros_of(data)
    assert found.names("_MID") == ["TANK_CMD_MID"]
    assert found.value("TANK_CMD_MID", {}) == 0x1820


@needs_compiler
def test_object_without_macros_or_damaged_has_none(tmp_path: Path) -> None:
    plain = compile_c(tmp_path, "plain", "#define PLAIN_CMD_MID 1\nvoid PLAIN_Main(void) { }\n").read_bytes()
    assert not macros_of(plain).names("_MID")
    assert not macros_of(b"no object").names("_MID")
    with_macros = compile_c(tmp_path, "tank", "#define TANK_CMD_MID 1\nvoid TANK_Main(void) { }\n", "-g3").read_bytes()
    for cut in range(64, len(with_macros), len(with_macros) // 40):
        macros_of(with_macros[:cut]).names("_MID")
