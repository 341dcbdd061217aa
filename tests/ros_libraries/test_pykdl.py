"""PyKDL: calculations with vectors, rotations, frames, twists and wrenches."""

from __future__ import annotations

import copy
import math
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.ros_libraries.world import universe

KDL: Any = universe().importer.load("PyKDL")
ANGLES = st.floats(-math.pi, math.pi)
NUMBERS = st.floats(-10, 10)
VECTORS = st.builds(KDL.Vector, NUMBERS, NUMBERS, NUMBERS)
ROTATIONS = st.builds(KDL.Rotation.RPY, ANGLES, ANGLES, ANGLES)
FRAMES = st.builds(KDL.Frame, ROTATIONS, VECTORS)
TWISTS = st.builds(KDL.Twist, VECTORS, VECTORS)
WRENCHES = st.builds(KDL.Wrench, VECTORS, VECTORS)


def test_vector() -> None:
    v = KDL.Vector(3, 4, 12)
    assert (v.Norm(), v.x(), v[2]) == (13, 3, 12)
    assert v * KDL.Vector(1, 0, 0) == KDL.Vector(0, 12, -4)
    assert 2 * v - v / 0.5 == KDL.Vector.Zero()
    v.z(0)
    assert (v.Normalize(), v) == (5, KDL.Vector(0.6, 0.8, 0))
    nothing = KDL.Vector()
    assert (nothing.Normalize(), nothing.v) == (0, [1, 0, 0])
    assert repr(KDL.Vector(1, -2.5, 1e-7)) == "[           1,        -2.5,       1e-07]"
    with pytest.raises(IndexError, match="out of range"):
        v[3]
    with pytest.raises(TypeError, match="takes nothing, three numbers or a Vector"):
        KDL.Vector(1, 2)


def test_in_place_operators_keep_the_object() -> None:
    v, t = KDL.Vector(1, 2, 3), KDL.Twist(KDL.Vector(1, 2, 3), KDL.Vector())
    same = v, t
    v += KDL.Vector(1, 1, 1)
    t -= t
    assert (v is same[0], t is same[1], v.v) == (True, True, [2, 3, 4])
    assert t == KDL.Twist.Zero()


def test_parts_of_a_frame_are_copies() -> None:
    place = KDL.Vector(1, 2, 3)
    frame = KDL.Frame(KDL.Rotation.RotZ(0.5), place)
    frame.p[0] = 9
    frame[1, 3] = 8
    frame.M.DoRotZ(-0.5)
    assert (place.v, frame.p.v) == ([1, 2, 3], [9, 8, 3])
    assert KDL.Rotation.Identity() == frame.M
    assert repr(KDL.Frame()).count("\n") == 3


def test_angles_at_the_poles() -> None:
    assert KDL.Rotation.RPY(0.3, math.pi / 2, 0.5).GetRPY() == pytest.approx((0, math.pi / 2, 0.2))
    assert KDL.Rotation.EulerZYZ(0.3, 0, 0.5).GetEulerZYZ() == pytest.approx((0.8, 0, 0))
    angle, axis = KDL.Rotation().GetRotAngle()
    assert (angle, axis.v) == (0, [0, 0, 1])


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0.6, -0.8, 0), (0, 0.6, 0.8)])
def test_half_turns(axis: tuple[float, float, float]) -> None:
    rotation = KDL.Rotation.Rot(KDL.Vector(*axis), math.pi)
    angle, found = rotation.GetRotAngle()
    assert angle == math.pi
    assert KDL.Rotation.Rot(found, angle) == rotation
    assert KDL.Rotation.Quaternion(*rotation.GetQuaternion()) == rotation


@given(ROTATIONS)
@example(KDL.Rotation.RPY(0.0, 1.1e-6, 0.0))
def test_rotation_is_reconstructed_from_each_representation(rotation: Any) -> None:
    assert KDL.Rotation.RPY(*rotation.GetRPY()) == rotation
    assert KDL.Rotation.EulerZYX(*rotation.GetEulerZYX()) == rotation
    # KDL takes a tilt of up to 1.42e-6 rad (its cosine is then 1 - 1e-12) for none.
    assert KDL.Equal(KDL.Rotation.EulerZYZ(*rotation.GetEulerZYZ()), rotation, 2e-6)
    assert KDL.Rotation.Quaternion(*rotation.GetQuaternion()) == rotation
    assert KDL.Equal(KDL.Rotation.Rot(rotation.GetRot(), rotation.GetRot().Norm(0)), rotation, 1e-5)
    assert KDL.Rotation(rotation.UnitX(), rotation.UnitY(), rotation.UnitZ()) == rotation


@given(FRAMES, VECTORS, TWISTS, WRENCHES)
def test_frames_move_and_move_back(frame: Any, vector: Any, twist: Any, wrench: Any) -> None:
    assert frame * frame.Inverse() == KDL.Frame.Identity()
    for value in (vector, twist, wrench):
        assert KDL.Equal(frame.Inverse(frame * value), value, 1e-9)
        assert KDL.Equal(frame.M.Inverse(frame.M * value), value, 1e-9)
    # Power does not depend on where it is looked at from.
    assert KDL.dot(frame * twist, frame * wrench) == pytest.approx(KDL.dot(wrench, twist), abs=1e-9)


@given(FRAMES, FRAMES, st.floats(0.1, 10))
def test_add_delta_reverses_diff(a: Any, b: Any, dt: float) -> None:
    assert KDL.Equal(KDL.addDelta(a, KDL.diff(a, b, dt), dt), b, 1e-4)


@given(TWISTS, VECTORS)
def test_reference_points(twist: Any, place: Any) -> None:
    assert KDL.Equal(twist.RefPoint(place).RefPoint(-place), twist, 1e-9)
    assert KDL.Frame(-place) * twist == twist.RefPoint(place)


def test_integrate() -> None:
    frame = KDL.Frame()
    for _ in range(100):
        frame.Integrate(KDL.Twist(KDL.Vector(1, 0, 0), KDL.Vector(0, 0, math.pi / 2)), 100)
    assert KDL.Rotation.RotZ(math.pi / 2) == frame.M
    straight = KDL.Frame()
    straight.Integrate(KDL.Twist(KDL.Vector(2, 0, 0), KDL.Vector()), 4)
    assert straight.p == KDL.Vector(0.5, 0, 0)


def test_denavit_hartenberg() -> None:
    dh, craig = KDL.Frame.DH(1, 0.2, 2, 0.3), KDL.Frame.DH_Craig1989(1, 0.2, 2, 0.3)
    assert dh.p == KDL.Vector(math.cos(0.3), math.sin(0.3), 2)
    assert craig.p == KDL.Vector(1, -2 * math.sin(0.2), 2 * math.cos(0.2))


@pytest.mark.parametrize(
    "value",
    [
        KDL.Vector(1, 2, 3),
        KDL.Twist(KDL.Vector(1, 2, 3), KDL.Vector(4, 5, 6)),
        KDL.Wrench(KDL.Vector(1, 2, 3), KDL.Vector(4, 5, 6)),
        KDL.Rotation.RotX(0.5),
        KDL.Frame(KDL.Rotation.RotX(0.5), KDL.Vector(1, 2, 3)),
    ],
    ids=lambda value: type(value).__name__,
)
def test_copies(value: Any) -> None:
    twins = [copy.copy(value), copy.deepcopy(value), type(value)(value)]
    assert all(twin == value and twin is not value and hash(twin) == hash(value) for twin in twins)
    index: Any = (1, 0) if type(value) in (KDL.Rotation, KDL.Frame) else 1
    for twin in twins:
        twin[index] = 99
        assert twin[index] == 99 != value[index]
        assert twin != value
    assert value != "text"


def test_set_to_zero() -> None:
    values = [KDL.Vector(1, 2, 3), KDL.Twist(KDL.Vector(1, 2, 3), KDL.Vector(1, 2, 3)), KDL.JntArray(2)]
    for value in values:
        value[1] = 5
        KDL.SetToZero(value)
        assert value[1] == 0
