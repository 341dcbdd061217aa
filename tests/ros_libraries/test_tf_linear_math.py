"""tf.linear_math gives the same numbers as the C++ headers of LinearMath (recorded from compiled code)."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from tests.ros_libraries.world import universe

RECORDED: dict[str, list[float]] = json.loads(
    (Path(__file__).parents[1] / "data/tf/linear_math.json").read_text(encoding="utf-8")
)
lm: Any = universe().importer.load("tf.linear_math")
scalar: Any = lm.scalar


def flat(value: Any) -> list[float]:
    if isinstance(value, Iterable):
        return [number for part in value for number in flat(part)]
    if isinstance(value, lm.Transform):
        return flat(value.getBasis()) + flat(value.getOrigin())
    return [float(value)]


def results() -> dict[str, Any]:
    return {**vectors(), **quaternions(), **matrices(), **decompositions(), **transforms(), "scalar": scalars()}


def vectors() -> dict[str, Any]:
    a, b, c = some_vectors()
    interpolated, larger, smaller = lm.Vector3(), lm.Vector3(*a), lm.Vector3(*a)
    interpolated.setInterpolate3(a, b, 0.3)
    larger.setMax(b)
    smaller.setMin(b)
    products = [a.dot(b), a.length(), a.length2(), a.distance(b), a.distance2(b), a.angle(b), a.triple(b, c)]
    skew = a.getSkewSymmetricMatrix()
    planes = lm.tfPlaneSpace1(a.normalized()), lm.tfPlaneSpace1(b.normalized())
    return {
        **{"v add": a + b, "v sub": a - b, "v mul": a * b, "v scale": a * 2.5, "v div": a / b, "v divs": a / 2.5},
        **{"v neg": -a, "v cross": a.cross(b), "v normalized": a.normalized(), "v absolute": a.absolute()},
        "v numbers": [*products, a.minAxis(), a.maxAxis(), a.furthestAxis(), a.closestAxis()],
        **{"v rotate": a.rotate(b.normalized(), 0.6), "v lerp": a.lerp(b, 0.3), "v interpolate": interpolated},
        **{"v max": larger, "v min": smaller, "v skew0": skew[0], "v skew1": skew[1], "v skew2": skew[2]},
        **{"plane1 p": planes[0][0], "plane1 q": planes[0][1], "plane2 p": planes[1][0], "plane2 q": planes[1][1]},
    }


def some_vectors() -> tuple[Any, Any, Any]:
    return lm.Vector3(1.5, -2.25, 3), lm.Vector3(-0.5, 4, 0.75), lm.Vector3(2, 1, -1)


def some_rotations() -> tuple[Any, Any]:
    p, q = lm.Quaternion(), lm.Quaternion()
    p.setRPY(0.3, -0.7, 1.1)
    q.setRPY(-1.2, 0.4, 2.9)
    return p, q


def quaternions() -> dict[str, Any]:
    (a, b, _), (p, q) = some_vectors(), some_rotations()
    angles = [p.getAngle(), p.getAngleShortestPath(), (-p).getAngle(), (-p).getAngleShortestPath()]
    straight = a.normalized()
    return {
        **{"q rpy": p, "q axis": lm.Quaternion(lm.Vector3(1, 2, -2), 0.8), "q euler": lm.Quaternion(0.3, -0.7, 1.1)},
        **{"q mul": p * q, "q mulv": p * a, "v mulq": a * p, "q add": p + q, "q sub": p - q, "q scale": p * 2.0},
        **{"q neg": -p, "q inverse": p.inverse(), "q axis of": q.getAxis()},
        "q numbers": [p.dot(q), (p * 2).length(), p.angle(q), p.angleShortestPath(q), *angles],
        **{"q nearest": p.nearest(q), "q farthest": p.farthest(q), "q rotate": lm.quatRotate(p, a)},
        **{"q slerp": p.slerp(q, 0.3), "q slerp neg": p.slerp(-q, 0.3)},
        "q arc": lm.shortestArcQuat(straight, b.normalized()),
        "q arc back": lm.shortestArcQuat(straight, -straight),
    }


def some_matrix() -> Any:
    return lm.Matrix3x3(2, -1, 0.5, 3, 1, 4, -2, 0.25, 1)


def matrices() -> dict[str, Any]:
    (a, _, _), (p, _), g = some_vectors(), some_rotations(), some_matrix()
    m, turned = lm.Matrix3x3(p), lm.Matrix3x3()
    turned.setRPY(0.3, -0.7, 1.1)
    return {
        **{"m of q": m, "m rpy": turned, "m mul": m * g, "m mulv": g * a, "v mulm": a * g},
        **{"m transpose": g.transpose(), "m inverse": g.inverse(), "m adjoint": g.adjoint(), "m scaled": g.scaled(a)},
        **{"m absolute": g.absolute(), "m transposeTimes": g.transposeTimes(m)},
        "m timesTranspose": g.timesTranspose(m),
        "m numbers": [g.determinant(), g.cofac(0, 1, 2, 0), g.tdotx(a), g.tdoty(a), g.tdotz(a)],
        **{"m row": g.getRow(1), "m column": g.getColumn(1), "m opengl": g.getOpenGLSubMatrix()},
    }


def decompositions() -> dict[str, Any]:
    n = lm.Matrix3x3(some_rotations()[1])
    found = {"m getRPY": n.getRPY(), "m getRPY 2": n.getRPY(2), "m getYPR": n.getEulerYPR()}
    found["m locked"] = lm.Matrix3x3(0, 0, 1, 0, 1, 0, -1, 0, 0).getRPY()
    found["m locked 2"] = lm.Matrix3x3(0, 0, -1, 0, 1, 0, 1, 0, 0).getRPY()
    found["m getRotation"] = n.getRotation()
    for axis, angles in (("x", (3, 0.1, 0.1)), ("y", (0.1, 3, 0.1)), ("z", (0.1, 0.1, 3))):
        matrix = lm.Matrix3x3()
        matrix.setRPY(*angles)
        found[f"m getRotation {axis}"] = matrix.getRotation()
    for name, threshold, steps in (("m diagonal", 1e-6, 20), ("m diagonal coarse", 0.4, 2)):
        symmetric, turned = lm.Matrix3x3(4, 1, -2, 1, 3, 0.5, -2, 0.5, 1), lm.Matrix3x3()
        symmetric.diagonalize(turned, threshold, steps)
        found |= {name: symmetric, f"{name} turned": turned}
    return found


def transforms() -> dict[str, Any]:
    (a, b, _), (p, q) = some_vectors(), some_rotations()
    first, second = lm.Transform(p, a), lm.Transform(q, b)
    product, read = lm.Transform(p, a), lm.Transform()
    product *= second
    read.setFromOpenGLMatrix(first.getOpenGLMatrix())
    return {
        **{"t mul": first * second, "t point": first(b), "t inverse": first.inverse(), "t mulq": first * q},
        **{"t inverseTimes": first.inverseTimes(second), "t invXform": first.invXform(b), "t imul": product},
        **{"t opengl": first.getOpenGLMatrix(), "t from opengl": read},
    }


def scalars() -> list[Any]:
    s = scalar
    return [
        *(s.tfAcos(1.5), s.tfAsin(-1.5), s.tfAtan2Fast(1, 2), s.tfAtan2Fast(-1, -2)),
        *(s.tfNormalizeAngle(7), s.tfNormalizeAngle(-4), s.tfNormalizeAngle(4), s.tfRadians(90), s.tfDegrees(1)),
        *(s.tfFsel(-1, 2, 3), s.tfFuzzyZero(1e-17), s.tfEqual(0.1, 0.2), s.tfEqual(-0.3, 0.2)),
        *(s.tfGreaterEqual(0.3, 0.2), s.tfIsNegative(-1), s.tfSwapEndian(0x01020304), s.tfSwapEndianFloat(1.5)),
        *(s.tfRecipSqrt(4.0), s.TFSIMD_EPSILON, s.TFSIMD_PI, s.tfSelect(1, 2, 3)),
    ]


def test_every_recorded_result_is_computed() -> None:
    assert set(results()) == set(RECORDED)


@pytest.mark.parametrize("name", RECORDED)
def test_results_equal_cpp(name: str) -> None:
    assert flat(results()[name]) == pytest.approx(RECORDED[name], rel=1e-12, abs=1e-12)


def test_objects_change_in_place_like_references() -> None:
    transform = lm.Transform()
    transform.getOrigin().setX(3)
    transform.getBasis()[0].setValue(0, 1, 0)
    assert flat(transform) == [0, 1, 0, 0, 1, 0, 0, 0, 1, 3, 0, 0]
    transform.setIdentity()
    assert transform == lm.Transform.getIdentity()


def test_values_are_copied_into_objects() -> None:
    origin = lm.Vector3(1, 2, 3)
    transform = lm.Transform(lm.Quaternion.getIdentity(), origin)
    stamped = lm.StampedTransform(transform, 5, "map", "base")
    origin.setZero()
    transform.setIdentity()
    assert flat(stamped.getOrigin()) == [1, 2, 3]
    assert stamped == lm.StampedTransform(lm.Transform(None, lm.Vector3(1, 2, 3)), 5, "map", "base")
    assert stamped != lm.StampedTransform(stamped, 6, "map", "base")


def test_swapped_bytes_are_restored() -> None:
    assert scalar.tfUnswapEndianFloat(scalar.tfSwapEndianFloat(-2.5)) == -2.5
    assert scalar.tfUnswapEndianDouble(scalar.tfSwapEndianDouble(math.pi)) == math.pi


def test_minimum_and_maximum() -> None:
    assert (lm.tfMin(1, 2), lm.tfMax(1, 2), lm.tfSetMin(1, 2), lm.tfSetMax(1, 2)) == (1, 2, 1, 2)


def test_names_of_cpp_are_also_in_tf() -> None:
    tf: Any = universe().importer.load("tf")
    assert tf.Quaternion(0, 0, 0, 1) == tf.Transform().getRotation()
    with pytest.raises(AttributeError, match="Quaternion4"):
        _ = tf.Quaternion4
