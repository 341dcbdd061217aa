"""PyKDL for nodes: vectors, rotations, frames, twists and wrenches of orocos KDL, in Python.

Names, arguments and results match PyKDL 1.5. Results agree except for the last digits of a double. Kinematic
chains and trees are included with the common solvers; dynamics are not.
"""

from __future__ import annotations

from ._chain import Chain, Joint, Segment
from ._frame import Frame
from ._functions import Add, Divide, Equal, Multiply, MultiplyJacobian, SetToZero, Subtract, addDelta, diff, dot
from ._inertia import RigidBodyInertia, RotationalInertia
from ._joint_arrays import Jacobian, JntArray
from ._rotation import Rotation
from ._solvers import (
    ChainFkSolverPos_recursive,
    ChainIkSolverPos_NR,
    ChainIkSolverPos_NR_JL,
    ChainIkSolverVel_pinv,
    ChainJntToJacSolver,
    SolverI,
)
from ._tree import Tree
from ._twist import Twist, Wrench
from ._vector import Vector

__all__ = [
    "Add",
    "Chain",
    "ChainFkSolverPos_recursive",
    "ChainIkSolverPos_NR",
    "ChainIkSolverPos_NR_JL",
    "ChainIkSolverVel_pinv",
    "ChainJntToJacSolver",
    "Divide",
    "Equal",
    "Frame",
    "Jacobian",
    "JntArray",
    "Joint",
    "Multiply",
    "MultiplyJacobian",
    "RigidBodyInertia",
    "Rotation",
    "RotationalInertia",
    "Segment",
    "SetToZero",
    "SolverI",
    "Subtract",
    "Tree",
    "Twist",
    "Vector",
    "Wrench",
    "addDelta",
    "diff",
    "dot",
]
