"""LinearMath in C++ (tf/LinearMath, tf2/LinearMath) gives the numbers of the Python classes, and of a real ROS."""

from __future__ import annotations

import math
import random
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.ros_libraries.world import universe
from tests.roscfe.compiling import HEADERS, STRICT, compiled

SOURCE = Path(__file__).with_name("linear_math.cpp")
REAL = Path("/usr/include")
CASES = 2000
lm: Any = universe().importer.load("tf.linear_math")
scalar: Any = lm.scalar

CLOSE = {
    "m inverse": "Python divides by the determinant, C++ by the first row times its cofactors, as ROS does",
    "q arc": "Python divides by a number that C++ multiplies with the inverse of",
    "m diagonal": "Python has the cosine of the exact formula also where the series is used",
    "v float": "a float has 24 bits",
}
"""Functions whose operations or their order differ in Python: equal to 1 in 10^9 of the largest number."""

Line = tuple[str, list[float]]


def inputs(count: int) -> list[list[float]]:
    """Numbers for the functions: round ones and others, angles and rotations, also where an axis locks."""
    chance = random.Random(5)
    cases = []
    for at in range(count):
        numbers = [chance.choice((-2.0, -1.0, -0.5, 0.25, 0.5, 1.0, 3.0)) for _ in range(32)]
        if at % 3:
            numbers = [chance.uniform(-5, 5) for _ in range(32)]
        numbers[9:12] = [chance.uniform(-4, 4) for _ in range(3)]
        if at % 11 == 1:
            numbers[10] = chance.choice((1, -1)) * math.pi / 2
        if at % 7 == 1:
            numbers[16:20] = numbers[12:16]
        if at % 2:
            for first in (12, 16):
                length = math.hypot(*numbers[first : first + 4])
                numbers[first : first + 4] = [number / length for number in numbers[first : first + 4]]
        for cell in (20, 24, 28):
            numbers[cell] += 9.0  # round matrices may have no inverse, else
        numbers[29] = chance.uniform(0.01, 1)
        cases.append(numbers)
    return cases


def flat(value: Any) -> Iterator[float]:
    if isinstance(value, lm.Transform):
        yield from flat(value.getBasis())
        yield from flat(value.getOrigin())
    elif isinstance(value, Iterable):
        for part in value:
            yield from flat(part)
    else:
        yield float(value)


def line(name: str, *values: Any) -> Line:
    return name, list(flat(values))


def changed(value: Any, operation: str, other: Any) -> Any:
    """Return a copy after +=, -=, *= or /=."""
    copy = type(value)(*value)
    return getattr(copy, operation)(other)


def vectors(a: Any, b: Any, c: Any, t: float) -> Iterator[Line]:
    yield line("v add", a + b, a - b, a * b, a / b, -a)
    yield line("v scale", a * t, t * a, a / t)
    yield line("v cross", a.cross(b), lm.tfCross(b, a), a.triple(b, c), lm.tfTriple(c, b, a))
    distances = [a.distance(b), a.distance2(b), a.angle(b), lm.tfAngle(b, c)]
    yield line("v numbers", a.dot(b), a.length(), a.length2(), distances)
    yield line("v axes", a.minAxis(), a.maxAxis(), a.furthestAxis(), a.closestAxis())
    yield line("v normal", a.normalized(), b.normalized(), a.absolute())
    yield line("v rotate", a.rotate(b.normalized(), t))
    between, larger, smaller = lm.Vector3(), lm.Vector3(*a), lm.Vector3(*a)
    between.setInterpolate3(a, b, t)
    larger.setMax(b)
    smaller.setMin(b)
    yield line("v lerp", a.lerp(b, t), lm.lerp(b, c, t), between, larger, smaller)
    steps = ("__iadd__", b), ("__isub__", b), ("__imul__", t), ("__imul__", b), ("__itruediv__", t)
    yield line("v assign", [changed(a, *step) for step in steps])
    yield line("v skew", a.getSkewSymmetricMatrix())
    yield line("v plane", lm.tfPlaneSpace1(a.normalized()))
    yield line("v float", a, a.isZero(), a.fuzzyZero(), a == b, a != b)


def quaternions(p: Any, q: Any, a: Any, b: Any, angles: Any, t: float) -> Iterator[Line]:
    made, euler = lm.Quaternion(), lm.Quaternion()
    made.setRPY(*angles)
    euler.setEuler(*angles)
    yield line("q made", made, euler, lm.Quaternion(a, t))
    yield line("q product", p * q, p * a, a * p, p + q, p - q, p * t, p / t)
    steps = ("__iadd__", q), ("__isub__", q), ("__imul__", q), ("__imul__", t), ("__itruediv__", t)
    yield line("q assign", [changed(p, *step) for step in steps])
    of_two = [p.dot(q), p.length(), p.length2(), p.angle(q), p.angleShortestPath(q)]
    of_one = [made.getAngle(), made.getAngleShortestPath(), lm.dot(p, q), lm.length(q), lm.angle(q, p)]
    yield line("q numbers", of_two, of_one)
    yield line("q axis", made.getAxis(), lm.Quaternion().getAxis())
    yield line("q near", p.nearest(q), p.farthest(q), p.inverse(), lm.inverse(q), p.normalized(), q.normalized())
    yield line("q slerp", p.slerp(q, t), lm.slerp(p, q * -1.0, t), p.slerp(p, t))
    yield line("q rotate", lm.quatRotate(p, a))
    v, w = lm.Vector3(*a), lm.Vector3(*b)
    arcs = [lm.shortestArcQuat(a.normalized(), other) for other in (b.normalized(), -a.normalized())]
    yield line("q arc", arcs, lm.shortestArcQuatNormalize2(v, w), v, w)


def rpy(m: Any, library: str, solution: int = 1) -> list[float]:
    """Return roll, pitch and yaw. In gimbal lock, tf2 takes the roll from the last row; Python's classes are tf's."""
    roll, pitch, yaw = m.getRPY(solution)
    locked = library == "tf2" and abs(m[2][0]) >= 1.0
    return [math.atan2(m[2][1], m[2][2]) if locked else roll, pitch, yaw]


def matrices(g: Any, p: Any, a: Any, angles: Any, library: str) -> Iterator[Line]:
    m, turned = lm.Matrix3x3(p), lm.Matrix3x3()
    turned.setRPY(*angles)
    yield line("m made", m, turned)
    yield line("m product", m * g, g * a, a * g, g * m, g.transposeTimes(m), g.timesTranspose(m), g.scaled(a))
    yield line("m derived", g.transpose(), g.adjoint(), g.absolute())
    yield line("m inverse", g.inverse())
    yield line("m numbers", g.determinant(), g.cofac(0, 1, 2, 0), g.tdotx(a), g.tdoty(a), g.tdotz(a))
    yield line("m parts", g.getRow(1), g.getColumn(2), g == m)
    for each in (m, turned):
        yield line("m angles", rpy(each, library), rpy(each, library, 2))
        yield line("m rotation", each.getRotation())
    locked, up = lm.Matrix3x3(0, 0.6, -0.8, 0, 0.8, 0.6, -1, 0, 0), lm.Matrix3x3(0, 0.6, 0.8, 0, 0.8, -0.6, 1, 0, 0)
    yield line("m locked", rpy(locked, library), rpy(up, library))


def diagonals(g: Any) -> Iterator[Line]:
    for threshold in (1e-6, 0.4):
        upper = g[0][1], g[0][2], g[1][2]
        symmetric = lm.Matrix3x3(g[0][0], upper[0], upper[1], upper[0], g[1][1], upper[2], upper[1], upper[2], g[2][2])
        turned = lm.Matrix3x3()
        symmetric.diagonalize(turned, threshold, 20)
        yield line("m diagonal", symmetric, turned)


def transforms(p: Any, q: Any, a: Any, b: Any) -> Iterator[Line]:
    first, second = lm.Transform(p, a), lm.Transform(q, b)
    product, multiplied, read = lm.Transform(p, a), lm.Transform(), lm.Transform()
    product *= second
    multiplied.mult(first, second)
    cells = first.getOpenGLMatrix()
    read.setFromOpenGLMatrix(cells)
    yield line("t product", first * second, product, multiplied, first * b, first(b), first * q)
    yield line("t back", first.inverse(), first.inverseTimes(second), first.invXform(b), first.getRotation())
    yield line("t opengl", read, read == first)
    for cell in cells:
        yield line("t cell", cell)


def scalars(x: float, y: float) -> Iterator[Line]:
    s = scalar
    angles = [s.tfAcos(x), s.tfAsin(x), s.tfAtan2Fast(y, x)]
    yield line("s angles", angles, s.tfNormalizeAngle(x), s.tfRadians(x), s.tfDegrees(x))
    near = [s.tfFuzzyZero(x), s.tfEqual(x, y), s.tfGreaterEqual(x, y), s.tfIsNegative(x)]
    yield line("s choose", s.tfFsel(x, y, 2), near)
    yield line("s root", s.tfRecipSqrt(y * y + 1), s.tfSwapEndianFloat(x), s.tfSwapEndian(0x01020304), s.tfFabs(x))


def in_python(n: list[float], library: str) -> Iterator[Line]:
    a, b, c, angles = (lm.Vector3(*n[at : at + 3]) for at in (0, 3, 6, 9))
    p, q = lm.Quaternion(*n[12:16]), lm.Quaternion(*n[16:20])
    g = lm.Matrix3x3(*n[20:29])
    yield from vectors(a, b, c, n[29])
    yield from quaternions(p, q, a, b, angles, n[29])
    yield from matrices(g, p, a, angles, library)
    yield from diagonals(g)
    yield from transforms(p, q, a, b)
    yield from scalars(n[30], n[31])


def answers(program: Path, cases: list[list[float]]) -> list[str]:
    text = "\n".join(" ".join(map(float.hex, case)) for case in cases)
    return subprocess.run([program], input=text, capture_output=True, text=True, check=True).stdout.splitlines()


def parsed(text: str) -> Line:
    name, numbers = text.split(":")
    return name, [float.fromhex(number) for number in numbers.split()]


def equal(name: str, found: list[float], wanted: list[float]) -> bool:
    if name in CLOSE:
        scale = max(map(abs, wanted))
        return found == pytest.approx(wanted, rel=1e-6 if name == "v float" else 1e-9, abs=1e-9 * scale, nan_ok=True)
    return found == wanted


@pytest.mark.slow
@pytest.mark.parametrize("library", ["tf", "tf2"])
def test_numbers_equal_python(library: str, tmp_path: Path) -> None:
    define = ["-DOF_TF"] if library == "tf" else []
    cases = inputs(CASES)
    lines = map(parsed, answers(compiled(tmp_path, [SOURCE], *STRICT, *define), cases))
    for case in cases:
        for name, wanted in in_python(case, library):
            found_name, found = next(lines)
            assert found_name == name
            assert equal(name, found, wanted), (name, found, wanted)
    assert next(lines, None) is None


@pytest.mark.slow
@pytest.mark.parametrize("library", ["tf", "tf2"])
def test_numbers_equal_a_real_ros(library: str, tmp_path: Path) -> None:
    """Results are bitwise equal, optimised as in Debian's ROS, which turns the powers in ROS's code into products."""
    if not (REAL / library / "LinearMath").is_dir():
        pytest.skip(f"there is no lib{library}-dev on this computer; the comparison with Python has to do")
    define = ["-DOF_TF"] if library == "tf" else []
    cases = inputs(CASES)
    ours = compiled(tmp_path, [SOURCE], *STRICT, *define, "-O2", name="ours")
    real = compiled(tmp_path, [SOURCE], *define, "-O2", "-w", name="real", headers=[])
    assert answers(ours, cases) == answers(real, cases)


@pytest.mark.slow
@pytest.mark.parametrize("options", [STRICT, ["-Wall", "-Wextra", "-Werror", "-pedantic"]])
def test_both_libraries_may_be_in_one_node(options: list[str], tmp_path: Path) -> None:
    source = tmp_path / "both.cpp"
    names = [path.relative_to(HEADERS) for path in sorted(HEADERS.glob("tf*/LinearMath/*.h"))]
    assert len(names) == 14
    source.write_text(
        "".join(f'#include "{name}"\n' for name in names)
        + "#include <type_traits>\n"
        + 'static_assert(!std::is_same<tf::Transform, tf2::Transform>::value, "distinct");\n'
        + 'static_assert(!std::is_convertible<tf::Vector3, tf2::Vector3>::value, "distinct");\n'
        + "int main() { return (2 * tf::Vector3(1, 2, 3))[0] == tf2::Vector3(1, 2, 3).y() ? 0 : 1; }\n",
        encoding="utf-8",
    )
    assert subprocess.run([compiled(tmp_path, [source], *options)], check=False).returncode == 0
