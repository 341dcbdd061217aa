"""Values with names: in commands, telemetry, scripts, and for other ground systems."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from cfepy.ground import dictionary_of, packet_of
from cfepy.ground.values import line_of
from cfepy.ground.xtce import NAMESPACE, xtce_of
from cfepy.msg import Layout, ValueNames
from cfepy.script.text import parse_script
from cfepy.status import UsageError

MODES = Layout("Modes", [("Mode", ValueNames("u8", OFF=0, ON=1)), ("Mask", ValueNames("i16", flags=True, A=1, B=2))])
XTCE = f"{{{NAMESPACE}}}"


def test_layout_accepts_names_and_returns_numbers() -> None:
    assert (
        MODES.unpack(MODES.pack(Mode="ON", Mask="a+B"))
        == {"Mode": 1, "Mask": 3}
        == MODES.unpack(MODES.pack(Mode=1, Mask=3))
    )
    with pytest.raises(UsageError, match="Mode: unknown value 'ONN'; did you mean ON"):
        MODES.pack(Mode="ONN")
    with pytest.raises(UsageError, match=r"Mode: unknown value 'xyz'; expected one of OFF \(0\), ON \(1\)"):
        MODES.pack(Mode="xyz")


@pytest.mark.parametrize(
    ("values", "line"),
    [
        ({"Mode": 1, "Mask": 3}, "Mode=ON Mask=A+B"),
        ({"Mode": 2, "Mask": 5}, "Mode=2 Mask=5"),  # no such value, and a bit without a name
        ({"Mode": 0, "Mask": 0}, "Mode=OFF Mask=0"),
    ],
)
def test_values_are_shown_by_their_names(values: dict[str, int], line: str) -> None:
    assert line_of(values, MODES) == line


@pytest.mark.parametrize(
    ("name", "named", "number"),
    [
        ("CFE_EVS_SET_EVENT_FORMAT_MODE", "MsgFormat=long", "MsgFormat=1"),
        ("CFE_EVS_ENABLE_PORTS", "BitMask=PORT1+PORT3", "BitMask=5"),
        ("CFE_EVS_DISABLE_EVENT_TYPE", "BitMask=DEBUG", "BitMask=1"),
        ("CFE_ES_RESTART", "RestartType=POWERON", "RestartType=2"),
        ("CFE_ES_OVER_WRITE_SYS_LOG", "Mode=DISCARD", "Mode=1"),
        ("CFE_TIME_SET_STATE", "ClockState=INVALID", "ClockState=-1"),
        ("CFE_TIME_SET_SIGNAL", "ToneSource=REDUNDANT", "ToneSource=2"),
        ("CFE_TBL_VALIDATE", "ActiveTableFlag=ACTIVE", "ActiveTableFlag=1"),
    ],
)
def test_commands_accept_names(name: str, named: str, number: str) -> None:
    command = dictionary_of(None).command(name)
    assert packet_of(command, [named]) == packet_of(command, [number])
    path, _, value = named.partition("=")
    with pytest.raises(UsageError, match=f"{path}: .*did you mean {value.split('+')[0].upper()}"):
        packet_of(command, [f"{path}={value.split('+')[0]}X"])


def test_telemetry_line_shows_names() -> None:
    dictionary = dictionary_of(None)
    packet = packet_of(dictionary.command("CFE_EVS_SET_LOG_MODE"), ["LogMode=DISCARD"])
    assert dictionary.decode(packet).line() == "LogMode=DISCARD Spare=0"
    assert dictionary.decode(packet).values == {"LogMode": 1, "Spare": 0}


def test_a_script_compares_with_names() -> None:
    def steps(value: str) -> list[str]:
        text = f"expect tlm CFE_EVS_HK_TLM LogMode == {value}\n"
        return [repr(step.condition) for step in parse_script(text, "x.txt", None, dictionary_of(None)).steps]

    assert steps("DISCARD") == steps("1") != steps("0")
    with pytest.raises(UsageError, match="invalid number 'DISCRAD'; did you mean DISCARD"):
        steps("DISCRAD")


def test_xtce_export_has_the_names() -> None:
    document = ElementTree.fromstring(xtce_of("all", dictionary_of(None)))
    kinds = {each.get("name"): each for each in document.iter(f"{XTCE}EnumeratedArgumentType")}
    labels = kinds["u8_SHORT_LONG"].iter(f"{XTCE}Enumeration")
    assert {each.get("label"): each.get("value") for each in labels} == {"SHORT": "0", "LONG": "1"}
    assert "i16_INVALID_VALID_FLYWHEEL" in {
        each.get("name") for each in document.iter(f"{XTCE}EnumeratedParameterType")
    }
