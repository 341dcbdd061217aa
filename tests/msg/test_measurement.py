"""Measurements in a layout: calibration, limits, and their texts."""

from __future__ import annotations

import math

import pytest

from cfepy.ground.dictionary import Dictionary
from cfepy.msg import RED, YELLOW, Layout, Measurement, Telemetry, ValueNames
from cfepy.status import UsageError

TEMPERATURE = Measurement("u16", "degC", polynomial=(-40.0, 0.1), yellow=(0, 50), red=(-20, 60))
VOLTAGE = Measurement("u8", "V", points=((0, 0.0), (100, 20.0), (200, 30.0)), red=(22, None))
LAYOUT = Layout("Hk", [("Temp", TEMPERATURE), ("Volts", (VOLTAGE, 2)), ("Mode", ValueNames("u8", OFF=0, ON=1))])
HK = Telemetry("T_HK_TLM", 0x08F0, LAYOUT)


@pytest.mark.parametrize(("raw", "value"), [(0, -40.0), (400, 0.0), (1000, 60.0)])
def test_polynomial_gives_the_value_of_a_raw_number(raw: int, value: float) -> None:
    assert TEMPERATURE.value(raw) == pytest.approx(value)


def test_polynomial_has_rising_powers() -> None:
    assert Measurement("i16", polynomial=(1, 2, 3)).value(10) == 321


@pytest.mark.parametrize(("raw", "value"), [(0, 0), (50, 10), (100, 20), (150, 25), (200, 30), (255, 35.5), (-10, -2)])
def test_points_give_straight_lines_that_continue(raw: int, value: float) -> None:
    assert VOLTAGE.value(raw) == pytest.approx(value)


def test_value_without_calibration_is_the_raw_number() -> None:
    assert Measurement("f32", "rad/s").value(0.25) == 0.25
    assert Measurement("i32").text(-7) == "-7"


@pytest.mark.parametrize(
    ("value", "limit"),
    [(25, ""), (50, ""), (0, ""), (50.1, YELLOW), (-0.1, YELLOW), (60.1, RED), (-20.1, RED), (math.nan, RED)],
)
def test_limits_include_their_ends(value: float, limit: str) -> None:
    assert TEMPERATURE.violated(value) == limit


def test_text_has_the_unit_and_a_mark_that_needs_no_colour() -> None:
    assert [TEMPERATURE.text(raw) for raw in (650, 930, 1100, 390, 100)] == [
        *("25degC", "53degC[yellow>50]", "70degC[red>60]"),
        *("-1degC[yellow<0]", "-30degC[red<-20]"),
    ]
    assert TEMPERATURE.explained(70.0) == "70 degC, above the red limit of 60 degC"
    assert VOLTAGE.explained(21.0) == "21 V, below the red limit of 22 V"


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        ({"type": "char[3]"}, "invalid type 'char[3]' of a measurement; expected a number, such as u16 or f32"),
        ({"type": "u8", "polynomial": (1,), "points": ((0, 0), (1, 1))}, "polynomial cannot be combined with points"),
        ({"type": "u8", "points": ((0, 0),)}, "points must be at least two, with rising raw numbers"),
        ({"type": "u8", "points": ((5, 0), (1, 1))}, "points must be at least two, with rising raw numbers"),
        ({"type": "u8", "red": (5, 1)}, "red must be (LOWEST, HIGHEST), not (5, 1)"),
        ({"type": "u8", "yellow": (0, 9), "red": (1, 8)}, "the red limits must include the yellow ones"),
    ],
)
def test_invalid_measurement_is_refused(arguments: dict[str, object], error: str) -> None:
    with pytest.raises(UsageError) as caught:
        Measurement(**arguments)  # type: ignore[arg-type]
    assert error in caught.value.text


def test_packet_has_the_raw_numbers() -> None:
    plain = Layout("Hk", [("Temp", "u16"), ("Volts", "u8[2]"), ("Mode", "u8")])
    values = {"Temp": 1100, "Volts": [100, 120], "Mode": 1}
    assert LAYOUT.pack(values) == plain.pack(values)
    assert LAYOUT.unpack(plain.pack(values)) == values
    assert [cell.measurement for cell in LAYOUT.cells()] == [TEMPERATURE, VOLTAGE, VOLTAGE, None]


def test_ground_shows_engineering_values_and_raw_numbers_on_demand() -> None:
    dictionary = Dictionary()
    dictionary.add([HK])
    decoded = dictionary.decode(HK.packet(Temp=1100, Volts=[100, 120], Mode=1))
    assert decoded.line() == "Temp=70degC[red>60] Volts=20V[red<22],22V Mode=ON"
    assert decoded.line(raw=True) == "Temp=1100 Volts=100,120 Mode=ON"
    assert decoded.values["Temp"] == 1100
    assert decoded.violations == {"Temp": RED, "Volts[0]": RED}
    assert decoded.measurements["Volts[1]"] == {"value": 22.0, "unit": "V", "violated": ""}
