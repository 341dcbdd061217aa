"""Transform.h: rigid transforms, and StampedTransform of transform_datatypes.h. Imports tf.linear_math."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, overload

from tf.linear_math.matrix3x3 import Matrix3x3
from tf.linear_math.quaternion import Quaternion
from tf.linear_math.vector3 import Vector3


class Transform:
    """A rotation, then a translation; the identity without arguments.

    Args:
        rotation: a matrix, which is copied, or a quaternion.
        origin: translation of the origin, which is copied.
    """

    __slots__ = ("m_basis", "m_origin")
    __hash__ = None  # type: ignore[assignment]  # it can change

    def __init__(self, rotation: Quaternion | Matrix3x3 | None = None, origin: Vector3 | None = None) -> None:
        self.m_basis = Matrix3x3()
        self.m_origin = Vector3() if origin is None else Vector3(*origin)
        if isinstance(rotation, Quaternion):
            self.setRotation(rotation)
        elif rotation is not None:
            self.setBasis(rotation)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Transform):
            return NotImplemented
        return self.m_basis == other.m_basis and self.m_origin == other.m_origin

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.m_basis!r}, {self.m_origin!r})"

    # -- parts -------------------------------------------------------------------------------------------------------

    def getBasis(self) -> Matrix3x3:
        """Return the rotation. Changing it changes the transform."""
        return self.m_basis

    def getOrigin(self) -> Vector3:
        """Return the translation. Changing it changes the transform."""
        return self.m_origin

    def getRotation(self) -> Quaternion:
        """Return the rotation as a quaternion."""
        return self.m_basis.getRotation()

    def setBasis(self, basis: Matrix3x3) -> None:
        """Set the rotation."""
        self.m_basis.setValue(*(cell for row in basis for cell in row))

    def setRotation(self, q: Quaternion) -> None:
        """Set the rotation by a quaternion."""
        self.m_basis.setRotation(q)

    def setOrigin(self, origin: Vector3) -> None:
        """Set the translation."""
        self.m_origin.setValue(*origin)

    def setIdentity(self) -> None:
        """Become the identity."""
        self.m_basis.setIdentity()
        self.m_origin.setZero()

    @staticmethod
    def getIdentity() -> Transform:
        """Return the identity."""
        return Transform()

    def setFromOpenGLMatrix(self, m: Sequence[float]) -> None:
        """Take a 4x4 matrix that is stored column by column."""
        self.m_basis.setFromOpenGLSubMatrix(m)
        self.m_origin.setValue(m[12], m[13], m[14])

    def getOpenGLMatrix(self) -> list[float]:
        """Return the 4x4 matrix, column by column."""
        return [*self.m_basis.getOpenGLSubMatrix(), *self.m_origin, 1.0]

    # -- products ----------------------------------------------------------------------------------------------------

    def __call__(self, x: Vector3) -> Vector3:
        """Return a point, transformed."""
        return self.m_basis * x + self.m_origin

    @overload
    def __mul__(self, other: Transform) -> Transform: ...
    @overload
    def __mul__(self, other: Vector3) -> Vector3: ...
    @overload
    def __mul__(self, other: Quaternion) -> Quaternion: ...
    def __mul__(self, other: Transform | Vector3 | Quaternion) -> Transform | Vector3 | Quaternion:
        if isinstance(other, Transform):
            return Transform(self.m_basis * other.m_basis, self(other.m_origin))
        return self.getRotation() * other if isinstance(other, Quaternion) else self(other)

    def __imul__(self, other: Transform) -> Transform:  # type: ignore[misc]  # other products are no transforms
        self.mult(self, other)
        return self

    def mult(self, t1: Transform, t2: Transform) -> None:
        """Become the product of two transforms."""
        product = t1 * t2
        self.setBasis(product.m_basis)
        self.setOrigin(product.m_origin)

    def inverse(self) -> Transform:
        """Return the inverse transform."""
        back = self.m_basis.transpose()
        return Transform(back, back * -self.m_origin)

    def inverseTimes(self, t: Transform) -> Transform:
        """Return the inverse transform, times another."""
        return Transform(self.m_basis.transposeTimes(t.m_basis), (t.m_origin - self.m_origin) * self.m_basis)

    def invXform(self, inVec: Vector3) -> Vector3:
        """Return a point, transformed by the inverse."""
        return self.m_basis.transpose() * (inVec - self.m_origin)


class StampedTransform(Transform):
    """A transform from a frame to its parent, at a time.

    Args:
        input: the transform, which is copied; None for the identity.
        timestamp: a rospy.Time.
        frame_id: name of the parent.
        child_frame_id: name of the frame.
    """

    __slots__ = ("child_frame_id_", "frame_id_", "stamp_")

    def __init__(
        self, input: Transform | None = None, timestamp: Any = None, frame_id: str = "", child_frame_id: str = ""
    ) -> None:
        super().__init__()
        self.stamp_ = timestamp
        self.frame_id_ = frame_id
        self.child_frame_id_ = child_frame_id
        if input is not None:
            self.setData(input)

    def setData(self, input: Transform) -> None:
        """Take another transform, at the same time and between the same frames."""
        self.setBasis(input.getBasis())
        self.setOrigin(input.getOrigin())

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, StampedTransform):
            return super().__eq__(other)
        of_mine = self.stamp_, self.frame_id_, self.child_frame_id_
        return super().__eq__(other) and of_mine == (other.stamp_, other.frame_id_, other.child_frame_id_)
