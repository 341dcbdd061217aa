"""The Critical Data Store against a dictionary: registering, writing, deleting and resets in any order."""

from __future__ import annotations

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from cfepy.psp.psp import RST_TYPE_POWERON
from cfepy.status import (
    CFE_ES_BUFFER_NOT_IN_POOL,
    CFE_ES_CDS_ALREADY_EXISTS,
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_SUCCESS,
    CfeError,
)
from dev.fuzz.cds_board import ENTRIES, Board

NAMES = [f"APP.{number}" for number in range(ENTRIES + 2)]
SIZES = st.sampled_from((1, 4, 12, 13, 100, 900))


class CdsAgainstModel(RuleBasedStateMachine):
    """`blocks` is the expected content of the store: name to the last written data, or None if its bytes are lost."""

    def __init__(self) -> None:
        super().__init__()
        self.board = Board()
        self.blocks: dict[str, bytes | None] = {}

    def _register(self, name: str, size: int) -> int:
        try:
            return self.board.cds.register(size, name, is_table=False)[1]
        except CfeError as refusal:
            return refusal.status

    @rule(name=st.sampled_from(NAMES), size=SIZES)
    def register(self, name: str, size: int) -> None:
        old = self.blocks.get(name)
        is_same = old is not None and len(old) == size
        is_full = name not in self.blocks and len(self.blocks) == ENTRIES
        status = self._register(name, size)
        if is_same or is_full:
            assert status == (CFE_ES_CDS_ALREADY_EXISTS if is_same else CFE_ES_NO_RESOURCE_IDS_AVAILABLE)
            return
        assert status in (CFE_SUCCESS, CFE_ES_ERR_MEM_BLOCK_SIZE)
        if status == CFE_SUCCESS:
            self.blocks[name] = bytes(size)
        elif name in self.blocks:
            self.blocks[name] = None  # its bytes went first

    @precondition(lambda self: self.blocks)
    @rule(data=st.data())
    def write(self, data: st.DataObject) -> None:
        name = data.draw(st.sampled_from(sorted(self.blocks)))
        handle, old = self.board.cds.named(name).handle, self.blocks[name]
        if old is None:
            with pytest.raises(CfeError, match="BUFFER_NOT_IN_POOL"):
                self.board.cds.write(handle, b"!")
            return
        self.blocks[name] = new = data.draw(st.binary(min_size=len(old), max_size=len(old)))
        self.board.cds.write(handle, new)

    @precondition(lambda self: self.blocks)
    @rule(data=st.data())
    def delete(self, data: st.DataObject) -> None:
        name = data.draw(st.sampled_from(sorted(self.blocks)))
        self.board.cds.delete(name)
        del self.blocks[name]

    @rule()
    def reset_processor(self) -> None:
        self.board.boot()
        assert not self.board.log
        self.blocks = {name: data for name, data in self.blocks.items() if data is not None}

    @rule()
    def power_on(self) -> None:
        self.board.memory[:] = bytes(len(self.board.memory))  # as the PSP does
        self.board.boot(RST_TYPE_POWERON)
        self.blocks.clear()

    @invariant()
    def the_store_is_the_model(self) -> None:
        cds = self.board.cds
        assert {block.name: self._read(block.handle) for block in cds} == self.blocks

    def _read(self, handle: int) -> bytes | None:
        try:
            return self.board.cds.read(handle)
        except CfeError as error:
            if error.status != CFE_ES_BUFFER_NOT_IN_POOL:
                raise
            return None


TestCds = CdsAgainstModel.TestCase
TestCds.settings = settings(max_examples=25, stateful_step_count=40, deadline=None)
