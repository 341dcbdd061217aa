"""Making pipes and subscriptions, and every failure of it, with NASA's status and event."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from cfepy.status import (
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_SB_BAD_ARGUMENT,
    CFE_SB_BUF_ALOC_ERR,
    CFE_SB_MAX_DESTS_MET,
    CFE_SB_MAX_MSGS_MET,
    CFE_SB_MAX_PIPES_MET,
    CFE_SB_PIPE_CR_ERR,
    CfeError,
)
from tests.sb.harness import Bench


@pytest.fixture
def bench() -> Iterator[Bench]:
    bench = Bench(sb_max_pipes=3, sb_max_msg_ids=2, sb_max_dest_per_pkt=2)
    yield bench
    bench.kernel.shutdown()


def status(result: object) -> int:
    assert isinstance(result, CfeError)
    return result.status


@pytest.mark.parametrize(
    ("depth", "name", "code", "event"),
    [
        (0, "P", CFE_SB_BAD_ARGUMENT, 2),
        (51, "P", CFE_SB_BAD_ARGUMENT, 2),
        (5, "", CFE_SB_BAD_ARGUMENT, 2),
        (5, "TAKEN", CFE_SB_PIPE_CR_ERR, 69),
        (5, "N" * 20, CFE_SB_PIPE_CR_ERR, 4),
    ],
)
def test_invalid_pipes_are_refused(bench: Bench, depth: int, name: str, code: int, event: int) -> None:
    bench.do("A", lambda: bench.bus.create_pipe(5, "TAKEN"))
    assert status(bench.do("A", lambda: bench.bus.create_pipe(depth, name))) == code
    assert bench.events.ids() == [event]
    assert bench.bus.counters.create_pipe_error == 1


@pytest.mark.parametrize("name", ["TAKEN", "N" * 20])
def test_refused_name_uses_up_an_id(bench: Bench, name: str) -> None:
    assert bench.do("A", lambda: bench.bus.create_pipe(5, "TAKEN")) == 0x160001
    bench.do("A", lambda: bench.bus.create_pipe(5, name))
    assert bench.do("A", lambda: bench.bus.create_pipe(5, "NEXT")) == 0x160003
    bench.do("A", lambda: bench.bus.create_pipe(0, "BAD"))
    assert bench.do("A", lambda: bench.bus.create_pipe(5, "LAST")) == 0x160005


@pytest.mark.parametrize("pipe", [0, 0x160009, 0x110001])
def test_subscription_of_an_unknown_pipe_sends_two_events(bench: Bench, pipe: int) -> None:
    assert status(bench.do("A", lambda: bench.bus.subscribe(0x1880, pipe))) == CFE_SB_BAD_ARGUMENT
    assert bench.events.sent == [
        (64, f"Pipe Id Error:Bad Argument,Id={pipe},Requestor A"),
        (50, f"Subscribe Err:Invalid Pipe Id,Msg=0x1880,PipeId={pipe},App A"),
    ]
    bench.events.sent.clear()
    assert status(bench.do("A", lambda: bench.bus.unsubscribe(0x1880, pipe))) == CFE_SB_BAD_ARGUMENT
    assert len(bench.events.sent) == 1


def test_the_last_pipe(bench: Bench) -> None:
    for number in range(3):
        assert isinstance(bench.do("A", lambda: bench.bus.create_pipe(5, f"P{number}")), int)  # noqa: B023
    assert status(bench.do("A", lambda: bench.bus.create_pipe(5, "P3"))) == CFE_SB_MAX_PIPES_MET
    assert bench.events.sent[-1] == (3, "CreatePipeErr:Max Pipes(3)In Use.app A")


def test_pipe_ids_and_names(bench: Bench) -> None:
    pipe = bench.do("A", lambda: bench.bus.create_pipe(5, "P"))
    assert pipe == 0x160001
    assert bench.do("A", lambda: bench.bus.get_pipe_name(0x160001)) == "P"
    assert bench.do("A", lambda: bench.bus.get_pipe_id_by_name("P")) == pipe
    assert status(bench.do("A", lambda: bench.bus.get_pipe_id_by_name("Q"))) == CFE_SB_BAD_ARGUMENT


def test_only_the_owner_can_delete_and_subscribe(bench: Bench) -> None:
    pipe = bench.do("A", lambda: bench.bus.create_pipe(5, "P"))
    assert isinstance(pipe, int)
    for call in (
        lambda: bench.bus.delete_pipe(pipe),
        lambda: bench.bus.subscribe(0x801, pipe),
        lambda: bench.bus.unsubscribe(0x801, pipe),
        lambda: bench.bus.set_pipe_opts(pipe, 1),
    ):
        assert status(bench.do("B", call)) == CFE_SB_BAD_ARGUMENT
    assert bench.events.ids() == [54, 51, 53, 56]


def test_a_duplicate_subscription_keeps_its_limit(bench: Bench) -> None:
    pipe = bench.do("A", lambda: bench.bus.create_pipe(5, "P"))
    assert isinstance(pipe, int)
    bench.do("A", lambda: bench.bus.subscribe_ex(0x801, pipe, 0, 3))
    assert bench.do("A", lambda: bench.bus.subscribe_ex(0x801, pipe, 0, 9)) is None
    assert bench.events.ids() == [7]
    assert bench.bus.routes[0x801].destinations[0].limit == 3


def test_limits_of_msg_ids_and_destinations(bench: Bench) -> None:
    pipes = [bench.do("A", lambda: bench.bus.create_pipe(5, f"P{n}")) for n in range(3)]  # noqa: B023
    first, second, third = (pipe for pipe in pipes if isinstance(pipe, int))
    for pipe in (first, second):
        bench.do("A", lambda: bench.bus.subscribe(0x801, pipe))  # noqa: B023
    assert status(bench.do("A", lambda: bench.bus.subscribe(0x801, third))) == CFE_SB_MAX_DESTS_MET
    bench.do("A", lambda: bench.bus.subscribe(0x802, first))
    assert status(bench.do("A", lambda: bench.bus.subscribe(0x803, first))) == CFE_SB_MAX_MSGS_MET
    assert bench.events.ids() == [9, 8]


@pytest.mark.parametrize("msg_id", [0, 0x2000])
def test_msg_ids_out_of_range(bench: Bench, msg_id: int) -> None:
    pipe = bench.do("A", lambda: bench.bus.create_pipe(5, "P"))
    assert isinstance(pipe, int)
    assert status(bench.do("A", lambda: bench.bus.subscribe(msg_id, pipe))) == CFE_SB_BAD_ARGUMENT
    assert bench.events.ids() == [6]


def test_cleanup_removes_all_pipes_and_subscriptions_of_an_app(bench: Bench) -> None:
    pipe = bench.do("A", lambda: bench.bus.create_pipe(5, "P"))
    assert isinstance(pipe, int)
    bench.do("A", lambda: bench.bus.subscribe(0x801, pipe))
    bench.bus.cleanup_app(bench.apps["A"].app_id)
    assert len(bench.bus.pipes) == 0
    assert bench.bus.subscriptions == 0
    assert status(bench.do("A", lambda: bench.bus.receive_buffer(pipe, 0))) == CFE_SB_BAD_ARGUMENT


def test_full_pipe_table_is_reported_before_an_invalid_name(bench: Bench) -> None:
    for number in range(3):
        bench.do("A", lambda: bench.bus.create_pipe(5, f"P{number}"))  # noqa: B023  # called at once
    assert status(bench.do("A", lambda: bench.bus.create_pipe(5, "N" * 20))) == CFE_SB_MAX_PIPES_MET


def test_index_of_a_pipe(bench: Bench) -> None:
    assert bench.bus.pipe_id_to_index(0x160002) == 2
    for bad in (0, 0x110001):
        with pytest.raises(CfeError) as caught:
            bench.bus.pipe_id_to_index(bad)
        assert caught.value.status == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_subscription_without_room_in_the_pool_is_refused() -> None:
    bench = Bench(sb_buf_memory_bytes=40)
    pipe = bench.do("A", lambda: bench.bus.create_pipe(5, "P"))
    assert isinstance(pipe, int)
    assert bench.do("A", lambda: bench.bus.subscribe(0x801, pipe)) is None
    assert status(bench.do("A", lambda: bench.bus.subscribe(0x802, pipe))) == CFE_SB_BUF_ALOC_ERR
    assert bench.events.sent[-1] == (20, "Subscribe Err:Request for Destination Blk failed for Msg 0x802")
    assert bench.bus.counters.subscribe_error == 1
    bench.do("A", lambda: bench.bus.unsubscribe(0x801, pipe))
    assert bench.do("A", lambda: bench.bus.subscribe(0x802, pipe)) is None
    bench.kernel.shutdown()


def test_local_and_global_scope_in_the_event(bench: Bench) -> None:
    pipe = bench.do("A", lambda: bench.bus.create_pipe(5, "P"))
    assert isinstance(pipe, int)
    for call, scope in ((bench.bus.unsubscribe, 0), (bench.bus.unsubscribe_local, 1)):
        assert status(bench.do("A", lambda: call(0, pipe))) == CFE_SB_BAD_ARGUMENT  # noqa: B023  # called at once
        assert bench.events.sent[-1][1] == f"Unsubscribe Err:Bad Arg,MsgId 0x0,PipeId {pipe},app A,scope {scope}"
