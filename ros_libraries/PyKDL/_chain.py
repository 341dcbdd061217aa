"""Kinematic chains: `Joint`, `Segment` and `Chain`."""

from __future__ import annotations

from typing import Any, ClassVar

from ._frame import Frame
from ._inertia import RigidBodyInertia
from ._rotation import Rotation
from ._twist import Twist
from ._vector import Vector

_AXES = {"X": Vector(1, 0, 0), "Y": Vector(0, 1, 0), "Z": Vector(0, 0, 1)}


class Joint:
    """A joint with one degree of freedom, or none.

    `Joint(name="NoName", type=Joint.Fixed, scale=1, offset=0, ...)`, or with origin and axis before the type. The name
    may be left out. Inertia, damping and stiffness are accepted but ignored. Its motion is `scale * q + offset`.
    """

    RotAxis, RotX, RotY, RotZ, TransAxis, TransX, TransY, TransZ = range(8)
    Fixed: ClassVar[int] = 8
    # In PyKDL, "None" is the older name of Fixed, but a keyword in Python. getattr(Joint, "None") finds it.

    def __init__(self, *args: Any) -> None:
        if len(args) == 1 and isinstance(args[0], Joint):
            self.__dict__.update(args[0].__dict__)
            return
        rest = list(args)
        self._name = rest.pop(0) if rest and isinstance(rest[0], str) else "NoName"
        self._origin, self._axis = Vector(), Vector()
        if rest and isinstance(rest[0], Vector):
            self._origin, self._axis = Vector(rest.pop(0)), Vector(rest.pop(0))
            self._axis.Normalize()
        self._type = rest.pop(0) if rest else Joint.Fixed
        self.scale, self.offset = [*map(float, rest[:2]), 1.0, 0.0][:2] if len(rest) != 1 else (float(rest[0]), 0.0)
        if self.getTypeName()[-1] in _AXES:
            self._axis = Vector(_AXES[self.getTypeName()[-1]])

    def pose(self, q: float) -> Frame:
        """Return where the joint's moving end is.

        Args:
            q: its position, in rad or m.
        """
        way = self.scale * q + self.offset
        if self._type < Joint.TransAxis:
            return Frame(Rotation.Rot(self._axis, way), self._origin)
        return Frame(self._origin + self._axis * way) if self._type < Joint.Fixed else Frame()

    def twist(self, q_dot: float) -> Twist:
        """How its moving end moves, at a speed in rad/s or m/s."""
        motion = self._axis * (self.scale * q_dot)
        if self._type < Joint.TransAxis:
            return Twist(Vector(), motion)
        return Twist(motion, Vector()) if self._type < Joint.Fixed else Twist()

    def JointAxis(self) -> Vector:
        """Return the axis it turns about or moves along."""
        return Vector(self._axis)

    def JointOrigin(self) -> Vector:
        """Return a point on the axis."""
        return Vector(self._origin)

    def getName(self) -> str:
        """Return its name."""
        return str(self._name)

    def getType(self) -> int:
        """One of the numbers of this class."""
        return int(self._type)

    def getTypeName(self) -> str:
        """Return the name of its type."""
        return _TYPE_NAMES[self._type]

    def __repr__(self) -> str:
        return f"{self._name}:[{self.getTypeName()}, axis: {self._axis}, origin{self._origin}]"


_TYPE_NAMES = ("RotAxis", "RotX", "RotY", "RotZ", "TransAxis", "TransX", "TransY", "TransZ", "Fixed")
setattr(Joint, "None", Joint.Fixed)


class Segment:
    """A joint and the rigid body behind it.

    `Segment(name="NoName", joint=Joint(), f_tip=Frame(), I=RigidBodyInertia.Zero())`; the name may be left out.
    """

    def __init__(self, *args: Any) -> None:
        if len(args) == 1 and isinstance(args[0], Segment):
            self.__dict__.update(args[0].__dict__)
            return
        rest = list(args)
        self._name = rest.pop(0) if rest and isinstance(rest[0], str) else "NoName"
        self._joint = Joint(rest[0]) if rest else Joint()
        # The tip is given for the joint's position 0, and kept as seen from the joint's moving end.
        self._tip = self._joint.pose(0).Inverse() * (rest[1] if len(rest) > 1 else Frame())
        self._inertia = rest[2] if len(rest) > 2 else RigidBodyInertia.Zero()

    def pose(self, q: float) -> Frame:
        """Return where its tip is, seen from its root."""
        found: Frame = self._joint.pose(q) * self._tip
        return found

    def twist(self, q: float, q_dot: float) -> Twist:
        """How its tip moves, seen from its root."""
        return self._joint.twist(q_dot).RefPoint(self._joint.pose(q).M * self._tip.p)

    def getFrameToTip(self) -> Frame:
        """Return where its tip is at the joint's position 0."""
        return self.pose(0)

    def getName(self) -> str:
        """Return its name."""
        return str(self._name)

    def getJoint(self) -> Joint:
        """Return its joint."""
        return self._joint

    def getInertia(self) -> RigidBodyInertia:
        """Return its inertia."""
        return self._inertia

    def setInertia(self, I_in: RigidBodyInertia) -> None:
        """Set its inertia."""
        self._inertia = I_in

    def _moves(self) -> bool:
        """Return whether its joint has a degree of freedom."""
        return self._joint.getType() != Joint.Fixed


class Chain:
    """Segments one behind another: `Chain()` or a copy of another one."""

    def __init__(self, other: Chain | None = None) -> None:
        self.segments: list[Segment] = list(other.segments) if other is not None else []

    def addSegment(self, segment: Segment) -> None:
        """Add a segment at the end."""
        self.segments.append(Segment(segment))

    def addChain(self, chain: Chain) -> None:
        """Add a chain at the end."""
        self.segments += chain.segments

    def getNrOfJoints(self) -> int:
        """Return how many joints move."""
        return sum(segment._moves() for segment in self.segments)

    def getNrOfSegments(self) -> int:
        """Return how many segments there are."""
        return len(self.segments)

    def getSegment(self, index: int) -> Segment:
        """Return a segment by its number."""
        return self.segments[index]

    def __repr__(self) -> str:
        return "\n".join(
            f"{each.getName()}:[{each.getJoint()!r},\n {each.getFrameToTip()!r}]" for each in self.segments
        )
