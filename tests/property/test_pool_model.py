"""Memory pools against a model: blocks never overlap, keep what was written, and all come back."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from cfepy.es.pools import DESCRIPTOR, MemPool, PoolBlock
from cfepy.status import CFE_ES_ERR_MEM_BLOCK_SIZE, CfeError

SIZE = 4096


class PoolAgainstModel(RuleBasedStateMachine):
    """`held` are the blocks that were given out, each with a number that all its bytes have."""

    def __init__(self) -> None:
        super().__init__()
        self.pool = MemPool("P", SIZE)
        self.held: list[tuple[PoolBlock, int]] = []
        self.count = 0
        self.refusals: set[int] = set()

    @rule(size=st.integers(1, 1500))
    def get(self, size: int) -> None:
        self.count += 1
        try:
            block = self.pool.get(size)
        except CfeError as refusal:
            self.refusals.add(refusal.status)
            return
        assert bytes(block.memory) == bytes(size)
        assert self.pool.size_of(block) == size
        block.memory[:] = bytes([self.count % 255 + 1]) * size
        self.held.append((block, self.count % 255 + 1))

    @precondition(lambda self: self.held)
    @rule(data=st.data())
    def put(self, data: st.DataObject) -> None:
        block, _ = self.held.pop(data.draw(st.integers(0, len(self.held) - 1)))
        assert self.pool.put(block) == len(block.memory)

    @invariant()
    def nobody_wrote_into_a_block_of_another(self) -> None:
        for block, number in self.held:
            assert bytes(block.memory) == bytes([number]) * len(block.memory)

    @invariant()
    def the_books_are_right(self) -> None:
        spans = sorted((block.offset, block.offset + len(block.memory)) for block, _ in self.held)
        assert all(end + DESCRIPTOR.size <= start for (_, end), (start, _) in pairwise(spans))
        assert self.pool.statistics()["CheckErrCtr"] == 0
        assert self.refusals <= {CFE_ES_ERR_MEM_BLOCK_SIZE}


TestPool = PoolAgainstModel.TestCase
TestPool.settings = settings(max_examples=25, stateful_step_count=40, deadline=None)
