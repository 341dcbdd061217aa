"""tf's LinearMath in Python: the classes and functions of the C++ headers tf/LinearMath/*.h under their own names.

Each header is a module here: Matrix3x3.h is `matrix3x3`, and so on. StampedTransform (tf/transform_datatypes.h) is in
`transform`. Results that C++ returns through references are tuples in Python. A constructor without arguments, which
leaves its object undefined in C++, makes zeros or the identity. Imports the standard library only.
"""

from __future__ import annotations

from tf.linear_math.matrix3x3 import Matrix3x3
from tf.linear_math.min_max import tfMax, tfMin, tfSetMax, tfSetMin
from tf.linear_math.quad_word import QuadWord
from tf.linear_math.quaternion import (
    Quaternion,
    angle,
    angleShortestPath,
    dot,
    inverse,
    length,
    quatRotate,
    shortestArcQuat,
    shortestArcQuatNormalize2,
    slerp,
)
from tf.linear_math.transform import StampedTransform, Transform
from tf.linear_math.vector3 import (
    Vector3,
    lerp,
    tfAngle,
    tfCross,
    tfDistance,
    tfDistance2,
    tfDot,
    tfPlaneSpace1,
    tfTriple,
)

__all__ = [
    "Matrix3x3",
    "QuadWord",
    "Quaternion",
    "StampedTransform",
    "Transform",
    "Vector3",
    "angle",
    "angleShortestPath",
    "dot",
    "inverse",
    "length",
    "lerp",
    "quatRotate",
    "shortestArcQuat",
    "shortestArcQuatNormalize2",
    "slerp",
    "tfAngle",
    "tfCross",
    "tfDistance",
    "tfDistance2",
    "tfDot",
    "tfMax",
    "tfMin",
    "tfPlaneSpace1",
    "tfSetMax",
    "tfSetMin",
    "tfTriple",
]
