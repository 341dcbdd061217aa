"""cfepy_plant: charge, voltage and current of a battery under a load."""

from __future__ import annotations

import pytest

from tests.plant_modules import plant_module

BatteryModel = plant_module("battery_model").BatteryModel


def test_energy_without_resistance_is_power_and_time() -> None:
    battery = BatteryModel(capacity=10, resistance=0)
    battery.give(power=5, seconds=3600)
    assert battery.energy == pytest.approx(5)
    assert battery.charge == pytest.approx(0.5)
    assert battery.current == pytest.approx(5 / 12.6)


def test_voltage_falls_with_charge_and_current() -> None:
    battery = BatteryModel(capacity=10, full=12, empty=10, charge=0.5, resistance=0.2)
    assert battery.voltage == 11
    battery.give(power=11, seconds=0)
    assert battery.voltage == pytest.approx(11 - 0.2)


def test_resistance_takes_energy_too() -> None:
    battery = BatteryModel(capacity=10, full=10, empty=10, resistance=1)
    battery.give(power=20, seconds=360)
    assert battery.energy == pytest.approx(10 - (20 + 4) / 10)


def test_empty_battery_gives_nothing() -> None:
    battery = BatteryModel(capacity=0.001)
    battery.give(power=100, seconds=10)
    assert battery.energy == 0
    battery.give(power=100, seconds=10)
    assert battery.current == 0
