"""The memory budget of a board: the RAM that each owner uses, by purpose, and the refusal when no RAM is left.

Objects and stacks are not really placed in this RAM. They are accounted for in bytes, as on the board. A board without
limits accounts for them too, so that you can size a mission before it moves to a small board.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.osal import ObjectSizes
from cfepy.psp.profile import BoardProfile
from cfepy.status import CFE_STATUS_EXTERNAL_RESOURCE_FAIL, CfeError


class Claim(NamedTuple):
    """An accounted block of memory."""

    owner: str
    kind: str
    size: int


class OverBudget(CfeError):
    """Exception for a claim that does not fit into the board's RAM.

    Args:
        claim: the refused claim.
        missing: number of missing bytes.
        report: the table of all claims.
    """

    def __init__(self, claim: Claim, missing: int, report: str) -> None:
        super().__init__(
            CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
            f"the board is full: {claim.owner} asks for {claim.size} bytes ({claim.kind}), {missing} are missing; "
            f"choose smaller stacks, pools or queues, or fewer apps\n{report}",
        )
        self.claim = claim
        self.missing = missing


class MemoryBudget:
    """Accounts for memory in the RAM of a board.

    Args:
        profile: the board; a board without RAM regions has no limit.
    """

    def __init__(self, profile: BoardProfile) -> None:
        self.board = profile.name
        self.limit = profile.sram_size or None
        self.used = 0
        self.peak = 0
        self._claims: dict[int, Claim] = {}
        self._last_token = 0

    @property
    def free(self) -> int | None:
        """The free bytes; None if there is no limit."""
        return None if self.limit is None else self.limit - self.used

    def claim(self, owner: str, kind: str, size: int) -> int:
        """Claim `size` bytes.

        Args:
            owner: the application, or "system".
            kind: the purpose: "stack", "queue", "table", ...
            size: bytes.

        Returns:
            A token to release the claim with.

        Raises:
            OverBudget: if the bytes do not fit; the text lists the owners and their shares.
            CfeError: for a negative size.
        """
        if size < 0:
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, f"not enough memory for {owner}: {size} bytes ({kind})")
        claim = Claim(owner, kind, size)
        if self.limit is not None and self.used + size > self.limit:
            raise OverBudget(claim, self.used + size - self.limit, self.report())
        self._last_token += 1
        self._claims[self._last_token] = claim
        self.used += size
        self.peak = max(self.peak, self.used)
        return self._last_token

    def release(self, token: int) -> None:
        """Release a claim; a released token has no effect."""
        claim = self._claims.pop(token, None)
        if claim is not None:
            self.used -= claim.size

    def totals(self) -> dict[tuple[str, str], int]:
        """Return the bytes by (owner, kind), the largest first."""
        sums: dict[tuple[str, str], int] = {}
        for owner, kind, size in self._claims.values():
            sums[owner, kind] = sums.get((owner, kind), 0) + size
        return dict(sorted(sums.items(), key=lambda item: (-item[1], item[0])))

    def sizes(self) -> dict[tuple[str, str], list[int]]:
        """Return the bytes of each claim by (owner, kind)."""
        found: dict[tuple[str, str], list[int]] = {}
        for owner, kind, size in self._claims.values():
            found.setdefault((owner, kind), []).append(size)
        return found

    def by_owner(self) -> dict[str, int]:
        """Return the bytes by owner, the largest first."""
        sums: dict[str, int] = {}
        for claim in self._claims.values():
            sums[claim.owner] = sums.get(claim.owner, 0) + claim.size
        return dict(sorted(sums.items(), key=lambda item: (-item[1], item[0])))

    def report(self) -> str:
        """Return a table of owner, kind and bytes, with the sum and the board's RAM below."""
        rows = [(owner, kind, f"{size:,}") for (owner, kind), size in self.totals().items()]
        rows.append(("used", "", f"{self.used:,}"))
        rows.append((f"RAM of {self.board}", "", "unlimited" if self.limit is None else f"{self.limit:,}"))
        wide = [max(len(row[column]) for row in rows) for column in range(3)]
        return "\n".join(f"  {owner:<{wide[0]}}  {kind:<{wide[1]}}  {size:>{wide[2]}}" for owner, kind, size in rows)


def object_sizes(profile: BoardProfile) -> ObjectSizes:
    """Return the memory that a board's operating system uses for each object."""
    costs = profile.memory_costs
    return ObjectSizes(
        task=costs.task_control_block,
        queue=costs.queue_control_block,
        queue_slot=costs.queue_slot,
        semaphore=costs.semaphore,
        mutex=costs.mutex,
        timer=costs.timer,
    )
