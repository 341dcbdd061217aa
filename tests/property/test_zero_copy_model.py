"""Zero-copy buffers against a model: which task may send or release which buffer, and the free pool memory."""

from __future__ import annotations

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from cfepy import msg
from cfepy.sb import POLL, MessageBuffer
from cfepy.sb.buffers import BUFFER_BYTES, DESTINATION_BYTES
from cfepy.status import CFE_SB_BUF_ALOC_ERR, CFE_SB_BUFFER_INVALID, CfeError
from tests.sb.harness import Bench

MID, DEPTH, POOL = 0x1882, 3, 1500
APPS = st.sampled_from(("A", "B"))


class BuffersAgainstModel(RuleBasedStateMachine):
    """`held` are the buffers in use, with their owners; `gone` are those that were sent or released."""

    def __init__(self) -> None:
        super().__init__()
        self.bench = Bench(sb_buf_memory_bytes=POOL, sb_max_msg_size=1000)
        self.bus = self.bench.bus
        self.held: list[tuple[str, MessageBuffer]] = []
        self.gone: list[MessageBuffer] = []
        self.waiting: list[bytes] = []
        self.bench.do("READER", lambda: self.bus.subscribe_ex(MID, self._pipe(), msg_limit=9))

    def teardown(self) -> None:
        self.bench.kernel.shutdown()

    def _pipe(self) -> int:
        self.pipe = self.bus.create_pipe(DEPTH, "READER")
        return self.pipe

    @property
    def used(self) -> int:
        taken = [*self.waiting, *(buffer for _, buffer in self.held)]
        return DESTINATION_BYTES + sum(len(one) + BUFFER_BYTES for one in taken)

    @rule(app=APPS, size=st.integers(8, 700))
    def allocate(self, app: str, size: int) -> None:
        got = self.bench.do(app, lambda: self.bus.allocate_message_buffer(size))
        if self.used + size + BUFFER_BYTES > POOL:
            assert isinstance(got, CfeError)
            assert got.status == CFE_SB_BUF_ALOC_ERR
            return
        assert isinstance(got, MessageBuffer)
        assert bytes(got) == bytes(size)
        got[:] = msg.init(MID, size)
        self.held.append((app, got))

    @precondition(lambda self: self.held)
    @rule(data=st.data(), app=APPS, sends=st.booleans())
    def give_away(self, data: st.DataObject, app: str, sends: bool) -> None:
        _, buffer = self.held.pop(data.draw(st.integers(0, len(self.held) - 1)))
        function = self.bus.transmit_buffer if sends else self.bus.release_message_buffer
        assert self.bench.do(app, lambda: function(buffer)) is None
        self.gone.append(buffer)
        if sends and len(self.waiting) < DEPTH:
            self.waiting.append(bytes(buffer))

    @precondition(lambda self: self.gone)
    @rule(data=st.data(), sends=st.booleans())
    def give_away_twice(self, data: st.DataObject, sends: bool) -> None:
        buffer = data.draw(st.sampled_from(self.gone))
        function = self.bus.transmit_buffer if sends else self.bus.release_message_buffer
        refusal = self.bench.do("A", lambda: function(buffer))
        assert isinstance(refusal, CfeError)
        assert refusal.status == CFE_SB_BUFFER_INVALID

    @rule()
    def read(self) -> None:
        got = self.bus.receive_buffer(self.pipe, POLL)
        assert (None if got is None else len(got)) == (len(self.waiting.pop(0)) if self.waiting else None)

    @rule(app=APPS)
    def end_of_an_app(self, app: str) -> None:
        if app in self.bench.apps:
            self.bus.cleanup_app(self.bench.apps[app].app_id)
            self.gone += [buffer for owner, buffer in self.held if owner == app]
            self.held = [each for each in self.held if each[0] != app]

    @invariant()
    def the_pool_knows(self) -> None:
        assert self.bus.pool_use() == (self.used, len(self.waiting) + len(self.held))


TestBuffers = BuffersAgainstModel.TestCase
TestBuffers.settings = settings(max_examples=20, stateful_step_count=30, deadline=None)
