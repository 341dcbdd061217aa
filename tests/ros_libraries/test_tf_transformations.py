"""tf.transformations gives the same results as ROS's module (recorded from it)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.ros_libraries.world import universe

RECORDED: list[Any] = json.loads(
    (Path(__file__).parents[1] / "data/tf/transformations.json").read_text(encoding="utf-8")
)
FUNCTIONS = sorted({name for name, *_ in RECORDED})
tr: Any = universe().importer.load("tf.transformations")
A, B, C = (0.3, -0.2, 0.8), (0.5, 0.9, -0.4), (-0.7, 0.1, 0.6)
PARTS: list[tuple[str, Any]] = [
    ("reflection_from_matrix", tr.reflection_matrix(A, B)),
    ("rotation_from_matrix", tr.rotation_matrix(1.2, A, B)),
    ("rotation_from_matrix", tr.rotation_matrix(-2.2, (1, 0, 0))),
    ("rotation_from_matrix", tr.rotation_matrix(0.4, (0, 1, 0))),
    ("scale_from_matrix", tr.scale_matrix(-1.5, A)),
    ("scale_from_matrix", tr.scale_matrix(2.5, A, B)),
    ("shear_from_matrix", tr.shear_matrix(0.6, A, C, np.cross(A, B))),
    ("projection_from_matrix", tr.projection_matrix(A, B)),
    ("projection_from_matrix", tr.projection_matrix(A, B, direction=C)),
    ("projection_from_matrix", tr.projection_matrix(A, B, perspective=C)),
]


def agree(found: Any, wanted: Any) -> bool:
    """Return whether nested numbers are equal except for the last digits."""
    if wanted is None or found is None:
        return wanted is found
    if isinstance(found, tuple):
        return len(found) == len(wanted) and all(map(agree, found, wanted))
    return np.shape(found) == np.shape(wanted) and np.allclose(found, wanted, rtol=1e-9, atol=1e-9)


def tupled(argument: Any, name: str) -> Any:
    """Axes are a tuple in Python, a list in the file."""
    return tuple(argument) if "euler" in name and isinstance(argument, list) and len(argument) == 4 else argument


@pytest.mark.parametrize("function", FUNCTIONS)
def test_results_equal_the_recorded_ones(function: str) -> None:
    for name, args, options, wanted in RECORDED:
        if name != function:
            continue
        if name == "euler_from_quaternion":
            args = [args[0], *(tupled(each, name) for each in args[1:])]
        else:
            args = [tupled(each, name) for each in args]
        options = {key: tupled(value, name) for key, value in options.items()}
        if isinstance(wanted, dict):
            with pytest.raises((KeyError, ValueError)) as caught:
                getattr(tr, name)(*args, **options)
            assert caught.type.__name__ == wanted["error"]
        else:
            found = getattr(tr, name)(*args, **options)
            assert agree(found, wanted), f"{name}{(*args, options)}: {found} instead of {wanted}"


def test_all_functions_are_recorded_or_tested_here() -> None:
    here = {"Arcball", "random_vector", *(name for name, _ in PARTS)}
    assert set(tr.__all__) == {*FUNCTIONS, *here}


@pytest.mark.parametrize(("take_apart", "matrix"), PARTS, ids=lambda value: value if isinstance(value, str) else "")
def test_matrix_is_recomposed_from_its_parts(take_apart: str, matrix: Any) -> None:
    parts = getattr(tr, take_apart)(matrix)
    again = getattr(tr, take_apart.replace("_from", ""))(*parts)
    assert tr.is_same_transform(matrix, again)


def test_a_matrix_without_depth_is_projected_perspectively() -> None:
    matrix = tr.projection_matrix(A, B, perspective=C, pseudo=True)
    assert tr.is_same_transform(matrix, tr.projection_matrix(*tr.projection_from_matrix(matrix, pseudo=True)))


def test_angle_and_axis_of_a_turn() -> None:
    angle, axis, point = tr.rotation_from_matrix(tr.rotation_matrix(0.7, (0, 0, 2)))
    assert (angle * axis[2], axis[0], axis[1]) == pytest.approx((0.7, 0, 0))
    assert point[3] == 1.0


def test_results_are_written_to_out() -> None:
    vectors = np.array([[3.0, 4.0], [6.0, 8.0]])
    lengths = np.empty(2)
    assert tr.vector_norm(vectors, axis=1, out=lengths) is None
    assert lengths.tolist() == [5.0, 10.0]
    assert tr.unit_vector(vectors, axis=1, out=vectors) is None
    assert vectors.tolist() == [[0.6, 0.8], [0.6, 0.8]]


def test_random_numbers_belong_to_the_node() -> None:
    drawn = [universe().importer.load("tf.transformations").random_vector(3).tolist() for _ in range(2)]
    assert drawn[0] == drawn[1]
    assert all(0.0 <= number < 1.0 for number in drawn[0])
    assert tr.vector_norm(tr.random_quaternion()) == pytest.approx(1.0)


def test_ball_turns_as_it_is_dragged() -> None:
    ball = tr.Arcball(initial=np.identity(4))
    ball.place([320, 320], 320)
    ball.down([500, 250])
    ball.drag([475, 275])
    assert np.sum(ball.matrix()) == pytest.approx(3.90583455)
    ball.next()
    assert not np.allclose(ball.matrix(), np.identity(4))


def test_ball_is_constrained_to_its_axes() -> None:
    ball = tr.Arcball(initial=[0, 0, 0, 1])
    ball.place([320, 320], 320)
    ball.setaxes([1, 1, 0], [-1, 1, 0])
    ball.setconstrain(True)
    assert ball.getconstrain()
    ball.down([400, 200])
    ball.drag([200, 400])
    assert np.sum(ball.matrix()) == pytest.approx(0.2055924)
    with pytest.raises(ValueError, match="not a quaternion or matrix"):
        tr.Arcball(initial=[1, 2])
