"""`Tree`: a kinematic tree of segments, from which you can extract chains."""

from __future__ import annotations

from ._chain import Chain, Joint, Segment


class Tree:
    """Segments by name, each attached to another one. The root has a name but no segment."""

    def __init__(self, root_name: str = "root") -> None:
        self.root_name = root_name
        self.segments: dict[str, Segment] = {}
        self.hooks: dict[str, str] = {}

    def addSegment(self, segment: Segment, hook_name: str) -> bool:
        """Attach a segment to the end of another one. Returns False if that does not exist, or if the name is taken."""
        name = segment.getName()
        if name == self.root_name or name in self.segments or not self._has(hook_name):
            return False
        self.segments[name], self.hooks[name] = Segment(segment), hook_name
        return True

    def addChain(self, chain: Chain, hook_name: str) -> bool:
        """Attach a chain to the end of a segment; see `addSegment`."""
        for segment in chain.segments:
            if not self.addSegment(segment, hook_name):
                return False
            hook_name = segment.getName()
        return True

    def addTree(self, tree: Tree, hook_name: str) -> bool:
        """Attach the segments of another tree's root to the end of a segment; see `addSegment`."""
        return all(
            self.addSegment(segment, hook_name if tree.hooks[name] == tree.root_name else tree.hooks[name])
            for name, segment in tree.segments.items()
        )

    def getNrOfJoints(self) -> int:
        """Return how many joints move."""
        return sum(segment._moves() for segment in self.segments.values())

    def getNrOfSegments(self) -> int:
        """Return how many segments there are."""
        return len(self.segments)

    def getChain(self, chain_root: str, chain_tip: str) -> Chain:
        """Return the chain from the end of one segment to the end of another, or an empty chain."""
        chain = Chain()
        if not (self._has(chain_root) and self._has(chain_tip)):
            return chain
        up, down = self._way_to_root(chain_root), self._way_to_root(chain_tip)
        while up and down and up[-1] == down[-1]:
            up.pop()
            down.pop()
        for name in up:
            chain.addSegment(_turned_round(self.segments[name]))
        for name in reversed(down):
            chain.addSegment(self.segments[name])
        return chain

    def _has(self, name: str) -> bool:
        return name == self.root_name or name in self.segments

    def _way_to_root(self, name: str) -> list[str]:
        found = []
        while name != self.root_name:
            found.append(name)
            name = self.hooks[name]
        return found

    def __repr__(self) -> str:
        return "\n".join(f"{name} (on {hook})" for name, hook in self.hooks.items())


def _turned_round(segment: Segment) -> Segment:
    """Return a segment that leads from its tip to its root."""
    back, joint = segment.getFrameToTip().Inverse(), segment.getJoint()
    if segment._moves():
        kind = Joint.RotAxis if joint.getType() < Joint.TransAxis else Joint.TransAxis
        axis = back.M * -joint.JointAxis()
        joint = Joint(joint.getName(), back * joint.JointOrigin(), axis, kind, joint.scale, -joint.offset)
    return Segment(segment.getName(), joint, back, segment.getInertia())
