"""PyKDL's chains: forward kinematics, Jacobians and inverse kinematics."""

from __future__ import annotations

import random
from typing import Any

import pytest

from tests.ros_libraries.world import universe

KDL: Any = universe().importer.load("PyKDL")
JOINTS = ("RotZ", "RotX", "Fixed", "RotY", "Fixed", "TransZ", "TransX", "TransY", "Fixed")
PLACES = ((0, 0, 0), (0, 0, 0.9), (-0.4, 0, 0), (0, 0, 1.2), (0.4, 0, 0), (0, 0, 1.4), *[(0, 0, 0)] * 3)


def six_axes() -> Any:
    """Return a chain with three rotations, three translations, and fixed parts between."""
    chain = KDL.Chain()
    for name, place in zip(JOINTS, PLACES, strict=True):
        chain.addSegment(KDL.Segment(KDL.Joint(getattr(KDL.Joint, name)), KDL.Frame(KDL.Vector(*place))))
    return chain


def positions(*values: float) -> Any:
    found = KDL.JntArray(len(values))
    for at, value in enumerate(values):
        found[at] = value
    return found


@pytest.fixture
def some() -> Any:
    rng = random.Random(4)
    return positions(*(rng.uniform(-3, 3) for _ in range(6)))


def test_straight_chain() -> None:
    tip = KDL.Frame()
    assert KDL.ChainFkSolverPos_recursive(six_axes()).JntToCart(positions(0, 0, 0, 0, 0, 0), tip) == 0
    assert tip == KDL.Frame(KDL.Vector(0, 0, 3.5))


def test_tips_of_all_segments(some: Any) -> None:
    solver, tips, tip = KDL.ChainFkSolverPos_recursive(six_axes()), [], KDL.Frame()
    solver.JntToCart(some, tips)
    for count in range(1, 10):
        solver.JntToCart(some, tip, count)
        assert tip == tips[count - 1]


def test_jacobian_is_the_derivative(some: Any) -> None:
    chain, jac, step = six_axes(), KDL.Jacobian(6), 1e-5
    solver, ends = KDL.ChainFkSolverPos_recursive(chain), (KDL.Frame(), KDL.Frame())
    assert KDL.ChainJntToJacSolver(chain).JntToJac(some, jac) == 0
    for joint in range(6):
        for end, side in zip(ends, (-step, step), strict=True):
            moved = KDL.JntArray(some)
            moved[joint] += side
            solver.JntToCart(moved, end)
        assert KDL.diff(*ends, 2 * step) == jac.getColumn(joint)


def test_velocities_survive_a_round_trip(some: Any) -> None:
    chain, jac, twist, speeds = six_axes(), KDL.Jacobian(6), KDL.Twist(), KDL.JntArray(6)
    KDL.ChainJntToJacSolver(chain).JntToJac(some, jac)
    KDL.MultiplyJacobian(jac, positions(1, 2, 3, 4, 5, 6), twist)
    assert KDL.ChainIkSolverVel_pinv(chain).CartToJnt(some, twist, speeds) == 0
    assert list(speeds.q) == pytest.approx([1, 2, 3, 4, 5, 6])


def test_positions_survive_a_round_trip(some: Any) -> None:
    chain, wanted, reached, found = six_axes(), KDL.Frame(), KDL.Frame(), KDL.JntArray(6)
    forward = KDL.ChainFkSolverPos_recursive(chain)
    forward.JntToCart(some, wanted)
    start = positions(*(value + 0.1 for value in some.q))
    solver = KDL.ChainIkSolverPos_NR(chain, forward, KDL.ChainIkSolverVel_pinv(chain))
    assert solver.CartToJnt(start, wanted, found) == 0
    forward.JntToCart(found, reached)
    assert reached == wanted


def test_limits_are_respected(some: Any) -> None:
    chain, wanted, found = six_axes(), KDL.Frame(), KDL.JntArray(6)
    forward = KDL.ChainFkSolverPos_recursive(chain)
    forward.JntToCart(some, wanted)
    low, high = positions(*[-0.1] * 6), positions(*[0.1] * 6)
    solver = KDL.ChainIkSolverPos_NR_JL(chain, low, high, forward, KDL.ChainIkSolverVel_pinv(chain), 20)
    error = solver.CartToJnt(KDL.JntArray(6), wanted, found)
    assert (error, solver.strError(error)) == (-5, "The maximum number of iterations is exceeded")
    assert all(-0.1 <= value <= 0.1 for value in found.q)


def test_axis_may_be_anywhere_and_joints_have_names() -> None:
    joint = KDL.Joint("elbow", KDL.Vector(1, 0, 0), KDL.Vector(0, 0, 2), KDL.Joint.RotAxis)
    segment = KDL.Segment("arm", joint, KDL.Frame(KDL.Vector(2, 0, 0)))
    assert segment.pose(0) == KDL.Frame(KDL.Vector(2, 0, 0))
    assert segment.pose(3.141592653589793).p == KDL.Vector(0, 0, 0)
    assert (segment.getName(), joint.getName(), joint.getTypeName()) == ("arm", "elbow", "RotAxis")
    assert KDL.Joint("still").getType() == getattr(KDL.Joint, "None") == KDL.Joint.Fixed


def test_wrong_sizes_are_refused() -> None:
    chain = six_axes()
    solver = KDL.ChainFkSolverPos_recursive(chain)
    assert (solver.JntToCart(KDL.JntArray(2), KDL.Frame()), solver.getError()) == (-4, -4)
    assert solver.JntToCart(KDL.JntArray(6), KDL.Frame(), 10) == -6
    assert KDL.ChainJntToJacSolver(chain).JntToJac(KDL.JntArray(6), KDL.Jacobian(5)) == -4
    with pytest.raises(IndexError, match="out of range"):
        KDL.Jacobian(2)[6, 0]


def test_chains_are_extracted_from_a_tree() -> None:
    tree = KDL.Tree("base")
    torso = KDL.Segment("torso", KDL.Joint("waist", KDL.Joint.RotZ), KDL.Frame(KDL.Vector(0, 0, 1)))
    assert tree.addSegment(torso, "base")
    for name, side in (("left", 1), ("right", -1)):
        place = KDL.Frame(KDL.Rotation.RotX(0.3), KDL.Vector(0, side, 0))
        joint = KDL.Joint(name, KDL.Vector(0, side / 2, 0), KDL.Vector(1, 1, 0), KDL.Joint.RotAxis, -2.0, 0.1)
        assert tree.addSegment(KDL.Segment(name, joint, place), "torso")
    assert not tree.addSegment(torso, "base")
    assert not tree.addSegment(KDL.Segment("x"), "nowhere")
    assert (tree.getNrOfJoints(), tree.getNrOfSegments()) == (3, 3)
    there, back, tips = tree.getChain("left", "right"), tree.getChain("right", "left"), [KDL.Frame(), KDL.Frame()]
    for chain, tip, joints in ((there, tips[0], (0.4, 0.7)), (back, tips[1], (0.7, 0.4))):
        assert KDL.ChainFkSolverPos_recursive(chain).JntToCart(positions(*joints), tip) == 0
    assert tips[0] == tips[1].Inverse()
    assert tree.getChain("base", "left").getNrOfJoints() == 2
    assert tree.getChain("base", "x").getNrOfSegments() == 0


def test_trees_and_chains_on_trees() -> None:
    tree, other = KDL.Tree(), KDL.Tree("its root")
    chain = KDL.Chain()
    for name in ("a", "b"):
        chain.addSegment(KDL.Segment(name, KDL.Joint(KDL.Joint.RotX)))
    assert tree.addChain(chain, "root")
    other.addSegment(KDL.Segment("c"), "its root")
    other.addSegment(KDL.Segment("d"), "c")
    assert tree.addTree(other, "b")
    assert [each.getName() for each in tree.getChain("a", "d").segments] == ["b", "c", "d"]


def test_inertia() -> None:
    ball = KDL.RigidBodyInertia(2, KDL.Vector(0, 0, 1), KDL.RotationalInertia(1, 1, 1))
    assert (ball.getMass(), ball.getCOG().v) == (2, [0, 0, 1])
    assert ball.getRotationalInertia().data == [3, 0, 0, 0, 3, 0, 0, 0, 1]
    centered = ball.RefPoint(KDL.Vector(0, 0, 1))
    assert (centered.getCOG().v, centered.getRotationalInertia().data[0]) == ([0, 0, 0], 1)
    motion = KDL.Twist(KDL.Vector(1, 2, 3), KDL.Vector(0.1, 0.2, 0.3))
    frame = KDL.Frame(KDL.Rotation.RPY(0.1, 0.2, 0.3), KDL.Vector(4, 5, 6))
    # Momentum is the same wherever it is looked at from.
    assert frame * (ball * motion) == (frame * ball) * (frame * motion)
    assert frame.M * (ball * motion) == (frame.M * ball) * (frame.M * motion)
    assert (ball + ball) * motion == (2 * ball) * motion
    assert KDL.RigidBodyInertia.Zero().getCOG() == KDL.Vector()
    with pytest.raises(IndexError, match="out of range"):
        KDL.RotationalInertia.Zero()[9]
