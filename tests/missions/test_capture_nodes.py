"""The capture mission's control law, arm model, kinematics and packet decoder, without any middleware below them."""

from __future__ import annotations

import importlib
import math
import struct
import sys
from collections import deque
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

CAPTURE = Path(__file__).parents[2] / "missions" / "capture"
SCRIPTS = ("arm_description", "arm_control", "main_control", "arm_health", "hk_monitor")
PACKAGES = ("sensor_msgs", "std_msgs", "geometry_msgs")


class AnyName(ModuleType):
    """A message package that has every name: the tests below never make a message."""

    def __getattr__(self, name: str) -> type:
        if name.startswith("__"):
            raise AttributeError(name)
        return type(name, (), {})


@pytest.fixture
def params(monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[str, Any]]:
    """Return parameters for the nodes. The stand-in for rospy has nothing else."""
    values: dict[str, Any] = {}
    rospy = ModuleType("rospy")
    rospy.__dict__["get_param"] = values.get
    rospy.__dict__["logs"] = []
    rospy.__dict__["loginfo"] = lambda text, *args: rospy.__dict__["logs"].append(text % args)
    rospy.__dict__["logerr_throttle"] = lambda period, text: rospy.__dict__["logs"].append(text)
    monkeypatch.setitem(sys.modules, "rospy", rospy)
    for package in PACKAGES:
        monkeypatch.setitem(sys.modules, package, AnyName(package))
        monkeypatch.setitem(sys.modules, f"{package}.msg", AnyName(f"{package}.msg"))
    for script in SCRIPTS:
        monkeypatch.delitem(sys.modules, script, raising=False)
    monkeypatch.syspath_prepend(str(CAPTURE))
    yield values
    for script in SCRIPTS:
        sys.modules.pop(script, None)


def fly_leg(arm: Any, law: Any, leg: Any, seconds: float, delay: int = 2) -> float:
    """Close the loop with some cycles of delay; returns the largest joint error at the end (rad)."""
    pending = deque([[0.0] * 7] * delay)
    for cycle in range(round(seconds * 1000)):
        arm.step(pending.popleft())
        pending.append(law.currents(leg, cycle * 1e-3, arm.encoder_readings(), arm.velocity))
    return max(abs(goal - angle) for goal, angle in zip(leg.goal, arm.position, strict=True))


def loop(params: dict[str, Any], **wrong: Any) -> tuple[Any, Any, Any]:
    """Arm (with its own parameters), control law and the first leg, from where the arm stands."""
    arm_control, main_control = (importlib.import_module(name) for name in ("arm_control", "main_control"))
    law = main_control.ComputedTorque()
    params.update({f"~{name}": value for name, value in wrong.items()})
    arm = arm_control.ArmModel(1e-3)
    leg = main_control.Leg("approach", arm.encoder_readings(), main_control.STANDOFF, 0.0, 3.0)
    return arm, law, leg


def test_arm_reaches_its_goal(params: dict[str, Any]) -> None:
    arm, law, leg = loop(params)
    assert fly_leg(arm, law, leg, 4.0) < 2e-5
    assert max(map(abs, arm.velocity)) < 1e-3


def test_wrong_model_is_corrected(params: dict[str, Any]) -> None:
    arm, law, leg = loop(params, inertia=[6.0, 5.0, 3.0, 2.0, 0.9, 0.7, 0.3], viscous_friction=5.0)
    assert fly_leg(arm, law, leg, 5.0) < 1e-3


def test_held_goal_needs_no_current(params: dict[str, Any]) -> None:
    _, law, leg = loop(params)
    main_control = importlib.import_module("main_control")
    hold = main_control.Leg("hold", leg.goal, leg.goal, 3.0, math.inf)
    assert law.currents(hold, 99.0, leg.goal, [0.0] * 7) == pytest.approx([0.0] * 7)


def test_currents_are_limited(params: dict[str, Any]) -> None:
    params["~current_limit"] = 2.0
    arm, _, _ = loop(params)
    arm.step([9.0, -9.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    assert arm.current == [2.0, -2.0, 1.0, 0.0, 0.0, 0.0, 0.0]


def test_model_is_exact_at_any_rate(params: dict[str, Any]) -> None:
    arm_control = importlib.import_module("arm_control")
    fine, coarse = arm_control.ArmModel(1e-3), arm_control.ArmModel(1e-1)
    for _ in range(100):
        fine.step([1.0] * 7)
    coarse.step([1.0] * 7)
    assert fine.position == pytest.approx(coarse.position, abs=1e-12)
    assert fine.velocity == pytest.approx(coarse.velocity, abs=1e-12)


def test_encoder_shows_whole_counts(params: dict[str, Any]) -> None:
    params.update({"~encoder_bits": 8, "~initial_position": 0.1})
    arm, _, _ = loop(params)
    count = 2.0 * math.pi / 256
    assert arm.encoder_readings() == pytest.approx([4 * count] * 7)


def test_parameter_of_the_wrong_length_is_named(params: dict[str, Any]) -> None:
    params["~inertia"] = [1.0, 2.0]
    with pytest.raises(ValueError, match="~inertia: give one finite number or 7"):
        loop(params)


def test_parameter_that_must_be_positive(params: dict[str, Any]) -> None:
    params["~viscous_friction"] = 0.0
    with pytest.raises(ValueError, match="~viscous_friction: every value must be above zero"):
        loop(params)


def test_stretched_arm_points_up(params: dict[str, Any]) -> None:
    description = importlib.import_module("arm_description")
    place, turn = description.hand_pose([0.0] * 7)
    assert place == pytest.approx((0.0, 0.0, 2.35))
    assert turn == pytest.approx((0.0, 0.0, 0.0, 1.0))


def test_bent_arm_points_forward(params: dict[str, Any]) -> None:
    description = importlib.import_module("arm_description")
    place, turn = description.hand_pose([0.0, math.pi / 2, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert place == pytest.approx((2.05, 0.0, 0.3))
    assert turn == pytest.approx((0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5)))


def test_winding_warms_to_its_steady_state(params: dict[str, Any]) -> None:
    windings = importlib.import_module("arm_health").WindingTemperatures()
    for _ in range(20):
        windings.add([2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 100.0)
    assert windings.celsius[0] == pytest.approx(20.0 + 2.4 * 3.5 * 4.0, abs=0.01)
    assert windings.celsius[1] == pytest.approx(20.0)


def combined_packet(count: int) -> SimpleNamespace:
    header = struct.pack(">HHHIH4x", 0x089C, 0xC000 | count, 41, 1001000, 0x8000)
    core = struct.pack("<8B3H2B", 1, 0, 2, 0, 3, 0, 0, 0, 260, 5, 6, 7, 0)
    return SimpleNamespace(data=header + core + struct.pack("<Ifff", 70000, 1.5, 0.25, 21.5))


def test_monitor_reads_the_fields_and_sees_gaps(params: dict[str, Any]) -> None:
    monitor = importlib.import_module("hk_monitor").HkMonitor()
    for count in (0x3FFE, 0x3FFF, 0, 2):
        monitor.on_packet(combined_packet(count))
    monitor.report()
    (line,) = sys.modules["rospy"].__dict__["logs"]
    assert line.startswith("housekeeping 0x089C at 1001000.500 s, 4 received, 1 missing, 0 malformed: ES commands 1,")
    assert "events sent 260, SB pipe overflows 5, SB limit errors 6, TIME commands 7" in line
    assert line.endswith(
        "arm samples 70000, arm peak current [A] 1.5, arm peak speed [rad/s] 0.25, arm hottest motor [C] 21.5"
    )


def test_monitor_refuses_a_short_packet(params: dict[str, Any]) -> None:
    monitor = importlib.import_module("hk_monitor").HkMonitor()
    monitor.on_packet(SimpleNamespace(data=b"\x08\x9c"))
    assert (monitor.received, monitor.malformed) == (0, 1)
