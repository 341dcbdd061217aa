"""Transmitting and receiving, one behaviour a test; numbers and texts are those of cFE v7.0.0."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import pytest

from cfepy.msg import command, get_msg_time, get_sequence_count, set_segmentation_flag, validate_checksum
from cfepy.sb import PEND_FOREVER, POLL
from cfepy.status import (
    CFE_SB_BAD_ARGUMENT,
    CFE_SB_BUF_ALOC_ERR,
    CFE_SB_MSG_TOO_BIG,
    CFE_SB_PIPE_RD_ERR,
    CfeError,
)
from tests.sb.harness import Bench, packet

MID = 0x0881


@pytest.fixture(params=["thread", "greenlet"])
def bench(request: pytest.FixtureRequest) -> Iterator[Bench]:
    bench = Bench(request.param)
    yield bench
    bench.kernel.shutdown()


def subscriber(bench: Bench, name: str, depth: int = 10, limit: int = 4, msg_id: int = MID) -> int:
    pipe = bench.do(name, lambda: bench.bus.create_pipe(depth, f"{name}_PIPE"))
    assert isinstance(pipe, int)
    bench.do(name, lambda: bench.bus.subscribe_ex(msg_id, pipe, 0, limit))
    return pipe


def drain(bench: Bench, pipe: int) -> list[bytes]:
    got = []
    while (one := bench.bus.receive_buffer(pipe, POLL)) is not None:
        got.append(one)
    return got


def test_pipe_is_first_in_first_out(bench: Bench) -> None:
    pipe = subscriber(bench, "A")
    for number in range(4):
        bench.bus.transmit_msg(packet(MID, bytes([number])))
    assert [one[16] for one in drain(bench, pipe)] == [0, 1, 2, 3]


def test_newest_subscriber_gets_the_message_first(bench: Bench) -> None:
    order: list[str] = []

    def receiver(name: str) -> None:
        pipe = bench.bus.create_pipe(4, name)
        bench.bus.subscribe(MID, pipe)
        bench.bus.receive_buffer(pipe, PEND_FOREVER)
        order.append(name)

    for name in ("OLD", "MIDDLE", "NEW"):
        bench.spawn(name, lambda name=name: receiver(name))  # type: ignore[misc]
    bench.kernel.run(0)
    bench.do("SENDER", lambda: bench.bus.transmit_msg(packet(MID)))
    assert order == ["NEW", "MIDDLE", "OLD"]


def test_origination_sets_sequence_count_and_time(bench: Bench) -> None:
    pipe = subscriber(bench, "A")
    for _ in range(2):
        bench.bus.transmit_msg(packet(MID, b"x"))
    first, second = drain(bench, pipe)
    assert (get_sequence_count(first), get_sequence_count(second)) == (1, 2)
    assert get_msg_time(second) == (1001000, 0x80000000)


def test_origination_sets_the_checksum_of_a_command(bench: Bench) -> None:
    pipe = subscriber(bench, "A", msg_id=0x1882)
    bench.bus.transmit_msg(command(0x1882, 3, b"payload"))
    (got,) = drain(bench, pipe)
    assert validate_checksum(got)
    assert got[8:] == b"payload"


def test_segmentation_flags_are_kept(bench: Bench) -> None:
    pipe = subscriber(bench, "A")
    part = bytearray(packet(MID, b"part"))
    set_segmentation_flag(part, 1)
    bench.bus.transmit_msg(part)
    (got,) = drain(bench, pipe)
    assert got[2] >> 6 == part[2] >> 6 != 3


def test_forwarded_packets_are_unchanged(bench: Bench) -> None:
    pipe = subscriber(bench, "A", msg_id=0x1882)
    foreign = bytes(command(0x1882, 1))[:7] + b"\x55"
    bench.bus.transmit_msg(foreign, is_origination=False)
    assert drain(bench, pipe) == [foreign]


def test_sender_may_reuse_its_buffer(bench: Bench) -> None:
    pipe = subscriber(bench, "A")
    buffer = bytearray(packet(MID, b"one"))
    bench.bus.transmit_msg(buffer)
    buffer[16:] = b"two"
    assert drain(bench, pipe)[0][16:] == b"one"


def test_message_limit(bench: Bench) -> None:
    pipe = subscriber(bench, "A", limit=2)
    for _ in range(3):
        bench.do("SENDER", lambda: bench.bus.transmit_msg(packet(MID)))
    assert len(drain(bench, pipe)) == 2
    assert bench.events.sent[-1] == (17, "Msg Limit Err,MsgId 0x881,pipe A_PIPE,sender SENDER")
    assert (bench.bus.counters.msg_limit_error, bench.bus.counters.msg_send_error) == (1, 1)


def test_read_message_of_an_older_subscription_frees_the_limit_of_the_newer(bench: Bench) -> None:
    """As on NASA's cFE 7.0.0, the limit counts by MsgId and pipe, for all subscriptions together."""
    pipe = subscriber(bench, "A", limit=1)
    bench.bus.transmit_msg(packet(MID, b"old"))
    bench.do("A", lambda: (bench.bus.unsubscribe(MID, pipe), bench.bus.subscribe_ex(MID, pipe, msg_limit=1)))
    bench.bus.transmit_msg(packet(MID, b"one"))
    bench.bus.transmit_msg(packet(MID, b"too many"))
    assert bench.bus.receive_buffer(pipe, 0)[16:] == b"old"
    bench.bus.transmit_msg(packet(MID, b"two"))
    assert bench.bus.counters.msg_limit_error == 1
    bench.bus.transmit_msg(packet(MID, b"too many"))
    assert [each[16:] for each in drain(bench, pipe)] == [b"one", b"two"]
    assert bench.bus.routes[MID].totals() == (3, 0, 2, 0)
    bench.bus.transmit_msg(packet(MID, b"last"))
    bench.bus.transmit_msg(packet(MID, b"too many"))
    assert [each[16:] for each in drain(bench, pipe)] == [b"last"]


def test_overflow_of_a_pipe_does_not_affect_others(bench: Bench) -> None:
    small = subscriber(bench, "SMALL", depth=1, limit=9)
    large = subscriber(bench, "LARGE", depth=9, limit=9)
    for _ in range(3):
        bench.do("SENDER", lambda: bench.bus.transmit_msg(packet(MID)))
    assert (len(drain(bench, small)), len(drain(bench, large))) == (1, 3)
    assert bench.events.sent[-1] == (25, "Pipe Overflow,MsgId 0x881,pipe SMALL_PIPE,sender SENDER")
    assert bench.bus.counters.pipe_overflow_error == 2
    assert bench.bus.routes[MID].totals() == (4, 0, 0, 2)


def test_pipe_that_keeps_the_newest_counts_dropped_messages(bench: Bench) -> None:
    pipe = subscriber(bench, "A", depth=2, limit=4)
    found = bench.bus.find_pipe(pipe)
    assert found is not None
    found.keeps_newest = True
    for number in range(9):  # more than the message limit: dropped ones do not count for it
        bench.do("SENDER", lambda number=number: bench.bus.transmit_msg(packet(MID, bytes([number]))))
    assert bench.bus.routes[MID].totals() == (0, 2, 0, 7)
    assert [each[16:] for each in drain(bench, pipe)] == [b"\7", b"\10"]


def test_message_without_a_subscriber_is_an_event_and_not_an_error(bench: Bench) -> None:
    bench.do("SENDER", lambda: bench.bus.transmit_msg(packet(MID)))
    assert bench.events.sent == [(14, "No subscribers for MsgId 0x881,sender SENDER")]
    assert bench.bus.counters.no_subscribers == 1


def test_route_that_lost_its_subscribers_causes_no_event(bench: Bench) -> None:
    pipe = subscriber(bench, "A")
    bench.do("A", lambda: bench.bus.unsubscribe(MID, pipe))
    bench.do("SENDER", lambda: bench.bus.transmit_msg(packet(MID)))
    assert bench.events.ids() == []
    assert bench.bus.routes[MID].sequence == 1


@pytest.mark.parametrize(
    ("what", "status", "event"),
    [
        (b"", CFE_SB_BAD_ARGUMENT, 13),
        (packet(MID, bytes(32768)), CFE_SB_MSG_TOO_BIG, 15),
        (b"\x00\x00" + bytes(14), CFE_SB_BAD_ARGUMENT, 21),
        (b"\x20\x00" + bytes(14), CFE_SB_BAD_ARGUMENT, 21),
    ],
)
def test_invalid_message_is_refused(bench: Bench, what: bytes, status: int, event: int) -> None:
    error = bench.do("SENDER", lambda: bench.bus.transmit_msg(what))
    assert isinstance(error, CfeError)
    assert error.status == status
    assert bench.events.ids() == [event]


def test_exhausted_buffer_pool_is_an_error() -> None:
    bench = Bench(sb_buf_memory_bytes=2000)
    pipe = subscriber(bench, "A", depth=50, limit=50)
    results = [bench.do("SENDER", lambda: bench.bus.transmit_msg(packet(MID, bytes(400)))) for _ in range(6)]
    errors = [one for one in results if one is not None]
    assert [isinstance(one, CfeError) and one.status for one in errors] == [CFE_SB_BUF_ALOC_ERR] * 2
    assert len(drain(bench, pipe)) == 4
    assert bench.do("SENDER", lambda: bench.bus.transmit_msg(packet(MID, bytes(400)))) is None
    bench.kernel.shutdown()


def test_receive_with_a_timeout_waits_one_ms_less_as_cfe_rounds(bench: Bench) -> None:
    times: list[int] = []

    def receiver() -> None:
        pipe = bench.bus.create_pipe(1, "P")
        for timeout in (POLL, 20, 1, 2):
            assert bench.bus.receive_buffer(pipe, timeout) is None
            times.append(bench.kernel.now)

    bench.spawn("A", receiver)
    bench.kernel.run(10**9)
    assert times == [0, 19_000_000, 19_000_000, 20_000_000]


def test_invalid_receives_are_refused(bench: Bench) -> None:
    pipe = subscriber(bench, "A")
    for bad_pipe, timeout in ((pipe + 1, POLL), (pipe, -2)):
        error = bench.do("A", lambda: bench.bus.receive_buffer(bad_pipe, timeout))  # noqa: B023  # called at once
        assert isinstance(error, CfeError)
        assert error.status == CFE_SB_BAD_ARGUMENT
    assert bench.events.ids() == [19, 18]
    assert bench.events.sent[-1][1] == "Rcv Err:Bad Input Arg:BufPtr 0x0,pipe [n/a],t/o -2,app A"
    assert bench.bus.counters.msg_receive_error == 2


@pytest.mark.parametrize("safe", [False, True])
def test_reader_of_a_deleted_pipe_waits_on_or_gets_an_error_in_a_safe_mission(safe: bool) -> None:
    bench = Bench(safe=safe)
    pipe = subscriber(bench, "A")
    ended: list[object] = []

    def reader(timeout_ms: int) -> None:
        try:
            ended.append((bench.bus.receive_buffer(pipe, timeout_ms), bench.kernel.now))
        except CfeError as error:
            ended.append(error.status)

    for timeout_ms in (PEND_FOREVER, 51):
        bench.spawn("A", partial(reader, timeout_ms))
    bench.kernel.run(0)
    bench.do("A", lambda: bench.bus.delete_pipe(pipe))
    bench.kernel.run(10**9)
    assert ended == ([CFE_SB_PIPE_RD_ERR] * 2 if safe else [(None, 50_000_000)])
    bench.kernel.shutdown()


def test_pipe_deleted_during_a_transmission_is_a_write_error(bench: Bench) -> None:
    doomed = subscriber(bench, "DOOMED")

    def deleter() -> None:
        pipe = bench.bus.create_pipe(1, "FIRST")
        bench.bus.subscribe(MID, pipe)
        bench.bus.receive_buffer(pipe, PEND_FOREVER)
        bench.bus.cleanup_app(bench.apps["DOOMED"].app_id)

    bench.spawn("DELETER", deleter, priority=10)
    bench.kernel.run(0)
    assert bench.do("SENDER", lambda: bench.bus.transmit_msg(packet(MID))) is None
    assert bench.events.sent[-1] == (26, "Pipe Write Err,MsgId 0x881,pipe DOOMED_PIPE,sender SENDER,stat -16")
    assert (bench.bus.counters.internal_error, bench.bus.counters.pipe_overflow_error) == (1, 0)
    assert isinstance(bench.do("A", lambda: bench.bus.receive_buffer(doomed, POLL)), CfeError)


def test_a_message_for_a_waiting_reader_counts_for_the_peak(bench: Bench) -> None:
    pipe = subscriber(bench, "A")
    bench.spawn("A", lambda: bench.bus.receive_buffer(pipe, PEND_FOREVER))
    bench.kernel.run(0)
    bench.bus.transmit_msg(packet(MID))
    assert bench.bus.pipes.get(pipe).peak == 1


def test_send_errors_exclude_message_limits(bench: Bench) -> None:
    limited, small = subscriber(bench, "LIMITED", limit=1), subscriber(bench, "SMALL", depth=1, limit=9)
    for _ in range(3):
        bench.bus.transmit_msg(packet(MID))
    assert [bench.bus.pipes.get(pipe).send_errors for pipe in (limited, small)] == [2, 0]
    assert [bench.bus.pipes.get(pipe).dropped for pipe in (limited, small)] == [2, 2]


def test_own_messages_are_ignored_on_request(bench: Bench) -> None:
    pipe = subscriber(bench, "A")
    bench.do("A", lambda: bench.bus.set_pipe_opts(pipe, 1))
    bench.do("A", lambda: bench.bus.transmit_msg(packet(MID, b"mine")))
    bench.do("B", lambda: bench.bus.transmit_msg(packet(MID, b"yours")))
    assert [one[16:] for one in drain(bench, pipe)] == [b"yours"]
