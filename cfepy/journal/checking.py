"""Comparing the records of a replay with the checkpoints of its journal.

May import cfepy.mission and its neighbours in cfepy.journal.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from hashlib import blake2b

from cfepy.attachment import Attachment
from cfepy.journal.journal import Checkpoint, End
from cfepy.mission.mission import Mission
from cfepy.trace import UNSENT, Trace

Describe = Callable[[Sequence[bytes], int], list[str]]
"""Makes lines of text of records that begin at a virtual time in ns."""


@dataclass(frozen=True, slots=True)
class Difference:
    """Where a replay parts from its journal.

    Attributes:
        after: until there the records agree.
        before: there they do not agree any more; its numbers are those of the journal.
        lines: what the replay did between the two, as text.
    """

    after: Checkpoint
    before: Checkpoint
    lines: tuple[str, ...]


class Checker(Attachment):
    """Compares while the replay goes on.

    Args:
        checkpoints: of the journal.
        end: of the journal; None when the replay does not go that far.
        describe: makes text of what differs.

    Attributes:
        agreed: how far the records are known to agree.
        difference: where they part; None as long as they do not.
    """

    def __init__(self, checkpoints: Sequence[Checkpoint], end: End | None, describe: Describe) -> None:
        self.agreed = Checkpoint(0, 0, "")
        self.difference: Difference | None = None
        self._end = end
        self._describe = describe
        self._coming = list(reversed(checkpoints))
        self._hash = blake2b(digest_size=16)
        self._count = 0
        self._since: list[bytes] = []
        self._finished = False
        self._trace: Trace

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""
        self._trace = mission.trace
        self._trace.also(self._take)

    def end_early(self) -> None:
        """The replay does not go to the end of the journal after all."""
        self._end = None

    def conclude(self) -> None:
        """See `Attachment.conclude`: how the nodes shut down is the run's own only at the run's own end."""
        if self._end is None:
            self._trace.flush()
            self._finished = True

    def finish(self) -> None:
        """See `Attachment.finish`: two runs may agree at all checkpoints, and yet not end alike."""
        self._finished = True
        end = self._end
        if end is not None and self.difference is None and self._hash.hexdigest() != end.trace:
            self._part(Checkpoint(end.now_ns, end.records, end.trace))

    def _take(self, records: list[bytes]) -> None:
        is_over = not self._coming and self._end is None  # the replay goes on where the journal has ended
        if self._finished or is_over or self.difference is not None:
            return
        rest = [record for record in records if record and record[:1] != UNSENT]
        while self._coming and self.difference is None:
            missing = self._coming[-1].records - self._count
            if missing > len(rest):
                break
            self._add(rest[:missing])
            del rest[:missing]
            self._compare(self._coming.pop())
        self._add(rest)

    def _add(self, records: list[bytes]) -> None:
        self._hash.update(b"".join(records))
        self._count += len(records)
        self._since += records

    def _compare(self, recorded: Checkpoint) -> None:
        if self._hash.hexdigest() == recorded.digest:
            self.agreed = recorded
            self._since.clear()
        else:
            self._part(recorded)

    def _part(self, recorded: Checkpoint) -> None:
        lines = self._describe(self._since, self.agreed.now_ns)
        self.difference = Difference(self.agreed, recorded, tuple(lines))
        self._since.clear()
