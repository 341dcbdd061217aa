"""Solvers for chains: forward kinematics, the Jacobian, and inverse kinematics by Newton's method.

A solver returns 0, or a negative error number of `SolverI`, as in KDL. NumPy is imported when the pseudo inverse is
computed.
"""

from __future__ import annotations

from typing import Any

from ._chain import Chain
from ._frame import Frame
from ._functions import diff
from ._joint_arrays import Jacobian, JntArray
from ._twist import Twist


class SolverI:
    """Base class of all solvers, with the result of the last call."""

    _E_NOERROR = 0
    _E_NO_CONVERGE = -1
    _E_UNDEFINED = -2
    _E_NOT_UP_TO_DATE = -3
    _E_SIZE_MISMATCH = -4
    _E_MAX_ITERATIONS_EXCEEDED = -5
    _E_OUT_OF_RANGE = -6

    def __init__(self, chain: Chain) -> None:
        self.chain = chain
        self.error = self._E_NOERROR

    def getError(self) -> int:
        """Outcome of the last call."""
        return self.error

    def strError(self, error: int) -> str:
        """Return the text of an error number."""
        return _WORDS.get(error, "UNKNOWN ERROR")

    def updateInternalDataStructures(self) -> None:
        """Accept a change of the chain. These solvers read the chain in each call."""

    def _done(self, error: int) -> int:
        self.error = error
        return error

    def _fits(self, joints: JntArray) -> bool:
        return joints.rows() == self.chain.getNrOfJoints()


_WORDS = {
    SolverI._E_NOERROR: "No error",
    SolverI._E_NO_CONVERGE: "Failed to converge",
    SolverI._E_UNDEFINED: "Undefined value",
    SolverI._E_NOT_UP_TO_DATE: "Internal data structures not up to date with Chain",
    SolverI._E_SIZE_MISMATCH: "The size of the input does not match the internal state",
    SolverI._E_MAX_ITERATIONS_EXCEEDED: "The maximum number of iterations is exceeded",
    SolverI._E_OUT_OF_RANGE: "The requested index is out of range",
}


class ChainFkSolverPos_recursive(SolverI):
    """Where the end of a chain is."""

    def JntToCart(self, q_in: JntArray, p_out: Any, segmentNr: int = -1) -> int:
        """Compute the forward kinematics.

        Args:
            q_in: positions of the joints, in rad or m.
            p_out: a Frame to set, or a list of Frames to set, one for each segment.
            segmentNr: how many segments count; a negative number means all.
        """
        count = self.chain.getNrOfSegments() if segmentNr < 0 else segmentNr
        if not self._fits(q_in):
            return self._done(self._E_SIZE_MISMATCH)
        if count > self.chain.getNrOfSegments():
            return self._done(self._E_OUT_OF_RANGE)
        frames = _frames(self.chain, q_in, count)
        if isinstance(p_out, list):
            p_out[:] = frames
        else:
            last = frames[-1] if frames else Frame()
            p_out.M, p_out.p = last.M, last.p
        return self._done(self._E_NOERROR)


class ChainJntToJacSolver(SolverI):
    """How the end of a chain moves with each joint."""

    def __init__(self, chain: Chain) -> None:
        super().__init__(chain)
        self._locked: list[bool] = [False] * chain.getNrOfJoints()

    def setLockedJoints(self, locked_joints: list[bool]) -> int:
        """Leave joints out, by a flag for each."""
        if len(locked_joints) != self.chain.getNrOfJoints():
            return self._done(self._E_SIZE_MISMATCH)
        self._locked = list(locked_joints)
        return self._done(self._E_NOERROR)

    def JntToJac(self, q_in: JntArray, jac: Jacobian, seg_nr: int = -1) -> int:
        """Compute the Jacobian at the end of the chain, in the axes of its base.

        Args:
            q_in: positions of the joints, in rad or m.
            jac: the Jacobian to set, with a column for each joint.
            seg_nr: how many segments count; a negative number means all.
        """
        count = self.chain.getNrOfSegments() if seg_nr < 0 else seg_nr
        if not self._fits(q_in) or jac.columns() != q_in.rows():
            return self._done(self._E_SIZE_MISMATCH)
        if count > self.chain.getNrOfSegments():
            return self._done(self._E_OUT_OF_RANGE)
        frames = [Frame(), *_frames(self.chain, q_in, count)]
        jac.twists = [Twist() for _ in q_in.q]
        joint = 0
        for before, after, segment in zip(frames, frames[1:], self.chain.segments, strict=False):
            if not segment._moves():
                continue
            if not self._locked[joint]:
                twist = before.M * segment.twist(q_in[joint], 1.0)
                jac.twists[joint] = twist.RefPoint(frames[-1].p - after.p)
            joint += 1
        return self._done(self._E_NOERROR)


class ChainIkSolverVel_pinv(SolverI):
    """Joint velocities for a twist, by the pseudo inverse.

    Args:
        chain: the chain.
        eps: singular values below count as 0.
        maxiter: not used: NumPy's decomposition does not need it.
    """

    def __init__(self, chain: Chain, eps: float = 0.00001, maxiter: int = 150) -> None:
        super().__init__(chain)
        self._eps = eps
        self._jacobian = ChainJntToJacSolver(chain)

    def CartToJnt(self, q_in: JntArray, v_in: Twist, qdot_out: JntArray) -> int:
        """Return the least velocities that come nearest to a twist at the chain's end.

        Args:
            q_in: positions of the joints.
            v_in: the twist, in the axes of the base.
            qdot_out: it is set.
        """
        import numpy as np

        jac = Jacobian(self.chain.getNrOfJoints())
        error = self._jacobian.JntToJac(q_in, jac)
        if error != self._E_NOERROR or qdot_out.rows() != q_in.rows():
            return self._done(error or self._E_SIZE_MISMATCH)
        matrix = np.array([[twist[row] for twist in jac.twists] for row in range(6)])
        left, sizes, right = np.linalg.svd(matrix, full_matrices=False)
        inverse = np.array([1.0 / size if size >= self._eps else 0.0 for size in sizes])
        qdot_out.q = [float(value) for value in right.T @ (inverse * (left.T @ [v_in[at] for at in range(6)]))]
        return self._done(self._E_NOERROR)


class ChainIkSolverPos_NR(SolverI):
    """Joint positions for a frame, by Newton's method.

    Args:
        chain: the chain.
        fksolver: its forward kinematics.
        iksolver: its inverse velocities.
        maxiter: most steps.
        eps: how near the frame must come, in m and rad.
    """

    def __init__(self, chain: Chain, fksolver: Any, iksolver: Any, maxiter: int = 100, eps: float = 1e-6) -> None:
        super().__init__(chain)
        self._forward, self._velocity, self._steps, self._eps = fksolver, iksolver, maxiter, eps

    def CartToJnt(self, q_init: JntArray, p_in: Frame, q_out: JntArray) -> int:
        """Inverse kinematics.

        Args:
            q_init: where the search begins.
            p_in: where the chain's end is to be.
            q_out: it is set.
        """
        if not self._fits(q_init) or not self._fits(q_out):
            return self._done(self._E_SIZE_MISMATCH)
        q_out.q = list(q_init.q)
        reached, step = Frame(), JntArray(q_init.rows())
        for _ in range(self._steps):
            self._forward.JntToCart(q_out, reached)
            missing = diff(reached, p_in)
            self._velocity.CartToJnt(q_out, missing, step)
            if missing._equals(Twist(), self._eps):
                return self._done(self._E_NOERROR)
            q_out.q = self._limited([one + other for one, other in zip(q_out.q, step.q, strict=True)])
        return self._done(self._E_MAX_ITERATIONS_EXCEEDED)

    def _limited(self, positions: list[float]) -> list[float]:
        return positions


class ChainIkSolverPos_NR_JL(ChainIkSolverPos_NR):
    """As ChainIkSolverPos_NR, with joints that stay between limits.

    Args:
        chain: the chain.
        q_min: lowest positions.
        q_max: highest positions.
        fksolver: its forward kinematics.
        iksolver: its inverse velocities.
        maxiter: most steps.
        eps: how near the frame must come, in m and rad.
    """

    def __init__(
        self,
        chain: Chain,
        q_min: JntArray,
        q_max: JntArray,
        fksolver: Any,
        iksolver: Any,
        maxiter: int = 100,
        eps: float = 1e-6,
    ) -> None:
        super().__init__(chain, fksolver, iksolver, maxiter, eps)
        self._low, self._high = JntArray(q_min), JntArray(q_max)

    def _limited(self, positions: list[float]) -> list[float]:
        limits = zip(positions, self._low.q, self._high.q, strict=True)
        return [min(max(value, low), high) for value, low, high in limits]


def _frames(chain: Chain, q: JntArray, count: int) -> list[Frame]:
    """Return where the tips of the first segments are."""
    found: list[Frame] = []
    joint, here = 0, Frame()
    for segment in chain.segments[:count]:
        position = q[joint] if segment._moves() else 0.0
        joint += segment._moves()
        here = here * segment.pose(position)
        found.append(here)
    return found
