"""Subscriptions of every kind, and how many there can be (sb_subscription_test.c).

The limit of MsgIds is a segment that NASA leaves out of a run, since routes are never freed; here each test has a
mission of its own.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.app import Cfe
from cfepy.ids import UNDEFINED
from cfepy.mission import Mission
from cfepy.sb.bus import DEFAULT_QOS
from cfepy.status import CFE_SB_BAD_ARGUMENT, CFE_SB_MAX_DESTS_MET, CFE_SB_MAX_MSGS_MET, CFE_SUCCESS
from tests.functional.harness import CMD_MID, TLM_MID, status_of

NO_MSG_ID = 0
Subscribe = Callable[[int, int], None]


def two_pipes(cfe: Cfe) -> tuple[int, int]:
    return cfe.sb.create_pipe(3, "TestPipe1"), cfe.sb.create_pipe(3, "TestPipe2")


def come_and_go(cfe: Cfe, subscribe: Subscribe, unsubscribe: Subscribe) -> None:
    """Subscribe both pipes to both MsgIds, twice each, and unsubscribe; and try invalid subscriptions."""
    first, second = two_pipes(cfe)
    every = [(CMD_MID, first), (TLM_MID, second), (TLM_MID, first), (CMD_MID, second)]
    for call in (subscribe, unsubscribe):
        assert status_of(call, NO_MSG_ID, first) == CFE_SB_BAD_ARGUMENT
        assert status_of(call, CMD_MID, UNDEFINED) == CFE_SB_BAD_ARGUMENT
        assert [status_of(call, *each) for each in every + every] == [CFE_SUCCESS] * 8
        is_subscribed = call == subscribe
        assert [pipe_gets(cfe, *each) for each in every] == [is_subscribed] * 4
    for pipe in (first, second):
        cfe.sb.delete_pipe(pipe)


def pipe_gets(cfe: Cfe, msg_id: int, pipe: int) -> bool:
    """Return whether a message that is sent now comes into a pipe."""
    while cfe.sb.receive_buffer(pipe, 0) is not None:
        pass
    cfe.sb.transmit_msg(cfe.msg.init(msg_id, 16))
    return cfe.sb.receive_buffer(pipe, 0) is not None


def test_sb_subscribe_unsubscribe(cfe: Cfe) -> None:
    come_and_go(cfe, cfe.sb.subscribe, cfe.sb.unsubscribe)


def test_sb_subscribe_local_unsubscribe_local(cfe: Cfe) -> None:
    come_and_go(cfe, lambda msg_id, pipe: cfe.sb.subscribe_local(msg_id, pipe, 2), cfe.sb.unsubscribe_local)


def test_sb_subscribe_ex(cfe: Cfe) -> None:
    come_and_go(cfe, lambda msg_id, pipe: cfe.sb.subscribe_ex(msg_id, pipe, DEFAULT_QOS, 2), cfe.sb.unsubscribe)


def test_sb_max_subscriptions(cfe: Cfe, mission: Mission) -> None:
    sb, subscribed = cfe.sb, 0
    pipe = sb.create_pipe(2, "TestPipe")
    while (status := status_of(sb.subscribe, 1 + subscribed, pipe)) == CFE_SUCCESS:
        subscribed += 1
    assert status == CFE_SB_MAX_MSGS_MET
    assert 0 < subscribed <= mission.config.sb_max_msg_ids
    sb.delete_pipe(pipe)
    again = sb.create_pipe(2, "TestPipe")
    assert status_of(sb.subscribe, 1 + subscribed, again) == CFE_SB_MAX_MSGS_MET, "routes stay"


def test_sb_max_destinations(cfe: Cfe, mission: Mission) -> None:
    sb, most = cfe.sb, mission.config.sb_max_dest_per_pkt
    *pipes, last = [sb.create_pipe(2, f"TestPipe{number}") for number in range(most + 1)]
    assert {status_of(sb.subscribe, CMD_MID, pipe) for pipe in pipes} == {CFE_SUCCESS}
    assert status_of(sb.subscribe, CMD_MID, last) == CFE_SB_MAX_DESTS_MET
    assert status_of(sb.subscribe_ex, CMD_MID, last, DEFAULT_QOS, 2) == CFE_SB_MAX_DESTS_MET
    assert status_of(sb.subscribe_local, CMD_MID, last, 2) == CFE_SB_MAX_DESTS_MET
    sb.delete_pipe(pipes.pop())
    assert status_of(sb.subscribe, CMD_MID, last) == CFE_SUCCESS, "a deleted pipe has no subscriptions"
