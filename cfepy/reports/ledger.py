"""A ledger of a run: who uses how much of a board, on that board with as much RAM as is asked for."""

from __future__ import annotations

from cfepy.attachment import Attachment
from cfepy.mission import Mission, Processor


class Ledger(Attachment):
    """Lets a mission have what it asks for, and takes down what that is.

    Attributes:
        claims: bytes by owner, what for and size of each, when most was in use.
        peak: bytes that were in use then.
        sb_pool: bytes of the Software Bus's pool that were in use at most.
    """

    def __init__(self) -> None:
        self.claims: dict[tuple[str, str], list[int]] = {}
        self.peak = 0
        self.sb_pool = 0
        self._mission: Mission

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""
        self._mission = mission

    def power_up(self, processor: Processor) -> None:
        """See `Attachment.power_up`: from now on nothing is refused."""
        memory = processor.memory
        claim = memory.claim
        memory.limit = None

        def noting(owner: str, kind: str, size: int) -> int:
            token = claim(owner, kind, size)
            if memory.used > self.peak:
                self.peak, self.claims = memory.used, memory.sizes()
            return token

        memory.claim = noting  # type: ignore[method-assign]  # of this budget only

    def conclude(self) -> None:
        """See `Attachment.conclude`."""
        self.sb_pool = max(self.sb_pool, self._mission.cfe.sb.peaks.memory)
