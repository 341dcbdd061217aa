"""Messages filled in place: the holder of the buffer, its release, its pool memory."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pytest

from cfepy import msg
from cfepy.sb import POLL, MessageBuffer
from cfepy.status import (
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_SB_BAD_ARGUMENT,
    CFE_SB_BUF_ALOC_ERR,
    CFE_SB_BUFFER_INVALID,
    CFE_SB_MSG_TOO_BIG,
    CfeError,
)
from tests.sb.harness import Bench

MID = 0x1882


@pytest.fixture
def bench() -> Iterator[Bench]:
    bench = Bench(sb_buf_memory_bytes=2000, sb_max_msg_size=1000)
    yield bench
    bench.kernel.shutdown()


@pytest.fixture
def pipe(bench: Bench) -> int:
    pipe = bench.do("A", lambda: bench.bus.create_pipe(5, "P"))
    assert isinstance(pipe, int)
    bench.do("A", lambda: bench.bus.subscribe(MID, pipe))
    return pipe


def allocate(bench: Bench, size: int) -> MessageBuffer:
    buffer = bench.do("A", lambda: bench.bus.allocate_message_buffer(size))
    assert isinstance(buffer, MessageBuffer)
    return buffer


def filled(bench: Bench, size: int, count: int = 0) -> MessageBuffer:
    buffer = allocate(bench, size)
    buffer[:] = msg.init(MID, size)
    msg.set_sequence_count(buffer, count)
    return buffer


def status(result: object) -> int:
    assert isinstance(result, CfeError)
    return result.status


def test_buffer_is_sent_like_a_message(bench: Bench, pipe: int) -> None:
    buffer = filled(bench, 12, count=77)
    buffer[8:] = b"four"
    bench.do("A", lambda: bench.bus.transmit_buffer(buffer))
    got = bench.bus.receive_buffer(pipe, POLL)
    assert got is not None
    assert (got[8:], msg.get_sequence_count(got), msg.validate_checksum(got)) == (b"four", 1, True)


def test_buffer_without_origination_is_unchanged(bench: Bench, pipe: int) -> None:
    buffer = filled(bench, 12, count=1234)
    bench.do("A", lambda: bench.bus.transmit_buffer(buffer, is_origination=False))
    assert bench.bus.receive_buffer(pipe, POLL) == bytes(buffer)


def test_buffer_is_sent_up_to_the_size_in_its_header(bench: Bench, pipe: int) -> None:
    buffer = filled(bench, 100)
    msg.set_size(buffer, 20)
    bench.do("A", lambda: bench.bus.transmit_buffer(buffer))
    got = bench.bus.receive_buffer(pipe, POLL)
    assert got is not None
    assert len(got) == msg.get_size(got) == 20


def test_sent_and_released_buffers_are_invalid_for_their_former_owner(bench: Bench, pipe: int) -> None:
    sent, released = filled(bench, 12), filled(bench, 12)
    bench.do("A", lambda: bench.bus.transmit_buffer(sent))
    bench.do("A", lambda: bench.bus.release_message_buffer(released))
    for buffer in (sent, released, MessageBuffer(b"never allocated")):
        for call in (bench.bus.release_message_buffer, bench.bus.transmit_buffer):
            if len(buffer) == 12 or call == bench.bus.release_message_buffer:
                assert status(bench.do("A", lambda: call(buffer))) == CFE_SB_BUFFER_INVALID  # noqa: B023  # called at once
    assert bench.events.ids() == []


def test_too_large_buffer_stays_with_its_owner(bench: Bench, pipe: int) -> None:
    buffer = filled(bench, 1000)
    msg.set_size(buffer, 1016)
    assert status(bench.do("A", lambda: bench.bus.transmit_buffer(buffer))) == CFE_SB_MSG_TOO_BIG
    msg.set_size(buffer, 1000)
    assert bench.do("A", lambda: bench.bus.transmit_buffer(buffer)) is None
    assert bench.bus.receive_buffer(pipe, POLL) is not None


@pytest.mark.parametrize(("size", "msg_id", "event"), [(60, MID, 13), (20, 0, 21), (20, 0x2000, 21)])
def test_buffer_with_an_invalid_header_is_refused(bench: Bench, size: int, msg_id: int, event: int) -> None:
    buffer = filled(bench, 20)
    buffer[:2] = msg_id.to_bytes(2, "big")
    msg.set_size(buffer, size)
    assert status(bench.do("A", lambda: bench.bus.transmit_buffer(buffer))) == CFE_SB_BAD_ARGUMENT
    assert bench.events.ids() == [event]
    assert bench.do("A", lambda: bench.bus.release_message_buffer(buffer)) is None


def test_buffer_that_was_extended_is_not_sent(bench: Bench, pipe: int) -> None:
    buffer = filled(bench, 20)
    buffer.extend(bytes(20))
    msg.set_size(buffer, 40)
    assert status(bench.do("A", lambda: bench.bus.transmit_buffer(buffer))) == CFE_SB_BAD_ARGUMENT
    assert bench.bus.pool_use() == (32 + 84, 1)
    bench.do("A", lambda: bench.bus.release_message_buffer(buffer))
    assert bench.bus.pool_use() == (32, 0)


@pytest.mark.parametrize("size", [1001, -1])
def test_buffer_of_an_invalid_size_is_refused(bench: Bench, size: int) -> None:
    assert status(bench.do("A", lambda: bench.bus.allocate_message_buffer(size))) == CFE_SB_MSG_TOO_BIG
    text = f"Failed, requested size {size} larger than allowed 1000"
    assert bench.log.lines == [f"A CFE_SB_AllocateMessageBuffer: {text}"]


def test_buffers_use_memory_of_the_pool(bench: Bench) -> None:
    first = allocate(bench, 1000)
    assert bench.bus.pool_use() == (1064, 1)
    assert status(bench.do("A", lambda: bench.bus.allocate_message_buffer(1000))) == CFE_SB_BUF_ALOC_ERR
    bench.do("A", lambda: bench.bus.release_message_buffer(first))
    assert bench.bus.pool_use() == (0, 0)
    assert bench.bus.peaks.memory == 1064


def test_messages_share_the_pool_with_buffers(bench: Bench, pipe: int) -> None:
    allocate(bench, 1000)
    packet = bytes(msg.command(MID, 0, bytes(400)))
    results = [bench.do("A", lambda: bench.bus.transmit_msg(packet)) for _ in range(3)]
    assert [result is None for result in results] == [True, False, False]
    assert status(results[1]) == CFE_SB_BUF_ALOC_ERR
    assert bench.events.sent[-1][1] == "Send Err:Request for Buffer Failed. MsgId 0x1882,app A,size 408"
    assert bench.bus.routes[MID].sequence == 1, "what is not sent is not counted"


def test_buffers_are_released_when_their_application_ends(bench: Bench) -> None:
    mine = allocate(bench, 100)
    other = bench.do("B", lambda: bench.bus.allocate_message_buffer(50))
    bench.bus.cleanup_app(bench.apps["A"].app_id)
    assert bench.bus.pool_use() == (114, 1)
    assert status(bench.do("A", lambda: bench.bus.release_message_buffer(mine))) == CFE_SB_BUFFER_INVALID
    assert isinstance(other, MessageBuffer)
    assert bench.do("B", lambda: bench.bus.release_message_buffer(other)) is None


class Pools:
    """The part of ES that lends memory; `left` blocks are available."""

    def __init__(self, left: int) -> None:
        self.left = left
        self.sizes: list[int] = []

    def pool_create_ex_with_alignment(self, size: int, sizes: Sequence[int], use_mutex: bool, *, owner: str) -> int:
        if self.left == 0:
            raise CfeError(CFE_ES_NO_RESOURCE_IDS_AVAILABLE, "no pools")
        assert (owner, use_mutex, sizes[-1]) == ("CFE_SB", False, 1128)
        return 0x140001

    def get_pool_buf(self, pool_id: int, size: int) -> int:
        if self.left == 0:
            raise CfeError(CFE_ES_ERR_MEM_BLOCK_SIZE, "empty")
        self.left -= 1
        self.sizes.append(size)
        return size

    def put_pool_buf(self, pool_id: int, block: int) -> None:
        self.left += 1
        self.sizes.remove(block)


def test_subscriptions_and_buffers_are_blocks_of_the_pool(bench: Bench, pipe: int) -> None:
    bench.bus.ports.es = pools = Pools(2)  # type: ignore[assignment]  # what SB asks of it
    bench.bus.early_init()
    other = bench.do("A", lambda: bench.bus.create_pipe(5, "OTHER"))
    assert isinstance(other, int)
    bench.do("A", lambda: bench.bus.subscribe(MID, other))
    buffer = allocate(bench, 100)
    assert pools.sizes == [32, 164]
    assert status(bench.do("A", lambda: bench.bus.allocate_message_buffer(10))) == CFE_SB_BUF_ALOC_ERR
    bench.do("A", lambda: bench.bus.delete_pipe(other))
    bench.do("A", lambda: bench.bus.release_message_buffer(buffer))
    assert pools.sizes == []


def test_bus_does_not_start_without_its_pool(bench: Bench) -> None:
    bench.bus.ports.es = Pools(0)  # type: ignore[assignment]  # what SB asks of it
    with pytest.raises(CfeError):
        bench.bus.early_init()
    text = "PoolCreate failed for SB Buffers, gave adr 0x0,size 2000,stat=0xc400002b"
    assert bench.log.lines == [f"CFE_SB_InitBuffers: {text}"]


def test_time_stamps(bench: Bench) -> None:
    packet = msg.telemetry(0x0882)
    bench.bus.time_stamp_msg(packet)
    assert msg.get_msg_time(packet) == (1001000, 0x80000000)
    with pytest.raises(CfeError):
        bench.bus.time_stamp_msg(msg.command(MID, 0))
