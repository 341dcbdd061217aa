"""cfepy_plant: the motion of a robot with two wheels, its encoders, and the power of its motors."""

from __future__ import annotations

import math

import pytest

from tests.plant_modules import plant_module

drive = plant_module("drive_model")
STEP = 0.02


def driven(speed: float, turn: float, seconds: float, **options: float) -> tuple[object, float]:
    """Drive for a time. Returns the robot, and the energy of its motors in J."""
    robot, energy = drive.DriveModel(drive.Pose(), **options), 0.0
    for _ in range(round(seconds / STEP)):
        robot.pose = robot.step(speed, turn, STEP)
        energy += robot.power * STEP
    return robot, energy


def test_straight_line_has_the_length_of_speed_and_time() -> None:
    robot, _ = driven(0.4, 0, 10, acceleration=1e9)
    assert robot.pose == pytest.approx((4.0, 0.0, 0.0))


def test_acceleration_costs_the_distance_of_a_ramp() -> None:
    robot, _ = driven(0.5, 0, 10, acceleration=1.0)
    assert robot.pose.x == pytest.approx(0.5 * 10 - 0.5**2 / 2, abs=0.5 * STEP)
    assert robot.speed == 0.5


def test_turn_in_place_stays_in_place() -> None:
    robot, _ = driven(0, 1.0, 2.0, acceleration=1e9)
    assert robot.pose == pytest.approx((0.0, 0.0, 2.0))


def test_circle_ends_where_it_began() -> None:
    robot, _ = driven(0.5, math.pi / 5, 10, acceleration=1e9)
    assert robot.pose.x == pytest.approx(0, abs=1e-9)
    assert robot.pose.y == pytest.approx(0, abs=1e-9)
    assert abs(robot.pose.yaw) == pytest.approx(0, abs=1e-9)


def test_wheels_are_not_faster_than_they_can_be() -> None:
    robot, _ = driven(5.0, 0, 5, max_speed=0.6)
    assert robot.speed == 0.6
    robot, _ = driven(0.6, 2.0, 5, max_speed=0.6)
    assert (robot.left, robot.right) == pytest.approx((0.3, 0.6))


def test_energy_is_the_work_against_friction() -> None:
    mass, rolling, efficiency = 8.0, 0.03, 0.5
    _, energy = driven(0.5, 0, 20, acceleration=1e9, mass=mass, rolling=rolling, efficiency=efficiency)
    work = mass * 9.80665 * rolling * 10.0
    kinetic = mass * 0.5**2  # the first step reaches the whole speed with its end's speed
    assert energy == pytest.approx((work + kinetic) / efficiency)


def test_braking_takes_no_energy() -> None:
    robot = drive.DriveModel(drive.Pose())
    for _ in range(100):
        robot.step(0.5, 0, STEP)
    robot.step(0, 0, STEP)
    assert robot.speed < 0.5
    assert robot.power == 0


def test_encoders_without_noise_count_the_pose() -> None:
    encoders = drive.WheelEncoders(0.3)
    for _ in range(100):
        encoders.add(0.01, 0.012)
    assert encoders.pose == pytest.approx(drive.Pose().moved(1.1, 0.2 / 0.3))


def test_encoders_with_steps_lag_by_less_than_a_step() -> None:
    encoders = drive.WheelEncoders(0.3, step=0.01)
    for number in range(1, 200):
        encoders.add(0.003, 0.003)
        assert 0 <= 0.003 * number - encoders.pose.x < 0.01 + 1e-9


def test_noise_depends_on_the_seed_alone() -> None:
    def counted(seed: int) -> object:
        encoders = drive.WheelEncoders(0.3, noise=0.05, seed=seed)
        for _ in range(50):
            encoders.add(0.01, 0.01)
        return encoders.pose

    assert counted(1) == counted(1)
    assert counted(1) != counted(2)
