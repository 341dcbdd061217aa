"""Requirements of the Software Bus that applications see: pipes, subscriptions, sending, receiving (cSB4301-4343)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy import msg
from cfepy.evs import packets as evs_packets
from cfepy.msg import command, telemetry
from cfepy.ports import ERROR, INFORMATION
from cfepy.sb import PEND_FOREVER, PIPEOPTS_IGNOREMINE, POLL
from cfepy.sb import packets as pk
from cfepy.status import (
    CFE_SB_BAD_ARGUMENT,
    CFE_SB_BUFFER_INVALID,
    CFE_SB_MAX_DESTS_MET,
    CFE_SB_MAX_PIPES_MET,
    CFE_SB_MSG_TOO_BIG,
    CfeError,
)
from tests.requirements.covers import covers
from tests.requirements.flight import Flight
from tests.requirements.test_sb import drain, pipe, subscribe, transmit

TLM, CMD = 0x0FD1, 0x1FD1
Fly = Callable[..., Flight]


@pytest.fixture
def flight(fly: Fly) -> Flight:
    return fly(pk.HK_TLM_MID, pk.ONESUB_TLM_MID)


def refusal(flight: Flight, call: Callable[[], object], app: str = "PROBE") -> int:
    """Return the status with which a call fails."""
    flight.packets.clear()
    with pytest.raises(CfeError) as caught:
        flight.call(call, app)
    return caught.value.status


def events(flight: Flight) -> list[tuple[int, int, str]]:
    return [(event.event_id, event.event_type, event.text) for event in flight.events()]


def count(flight: Flight, name: str) -> int:
    value: int = flight.ask(pk.SEND_HK, pk.HK_TLM)[name]
    return value


# -- pipes -------------------------------------------------------------------------------------------------------------


def test_cSB4301_pipes_have_the_requested_depth_and_name(flight: Flight) -> None:
    sb = flight.cfe.sb
    one = pipe(flight, 3)
    assert flight.call(lambda: sb.get_pipe_name(one)) == "PROBE_PIPE"
    subscribe(flight, TLM, one)
    for _ in range(4):
        transmit(flight, TLM)
    assert len(drain(flight, one)) == 3
    assert refusal(flight, lambda: sb.create_pipe(51, "DEEP")) == CFE_SB_BAD_ARGUMENT
    flight.call(lambda: [sb.create_pipe(1, f"P{number}") for number in range(64 - len(sb.pipes))])
    assert refusal(flight, lambda: sb.create_pipe(1, "LAST")) == CFE_SB_MAX_PIPES_MET


def test_cSB4302_a_deleted_pipe_is_on_no_route(flight: Flight) -> None:
    sb = flight.cfe.sb
    one, two = pipe(flight), pipe(flight, name="TWO")
    for each in (one, two):
        subscribe(flight, TLM, each)
        subscribe(flight, CMD, each)
    assert refusal(flight, lambda: sb.delete_pipe(one), "MUTE") == CFE_SB_BAD_ARGUMENT
    flight.call(lambda: sb.delete_pipe(one))
    for msg_id in (TLM, CMD):
        assert [each.pipe.name for each in sb.routing.get_dest_list_head_ptr(sb.routing.get_route_id(msg_id))] == [
            "TWO"
        ]
    assert refusal(flight, lambda: sb.receive_buffer(one, POLL)) == CFE_SB_BAD_ARGUMENT
    assert refusal(flight, lambda: sb.delete_pipe(one)) == CFE_SB_BAD_ARGUMENT


@covers("cSB4329", "cSB4330")
def test_cSB4329_pipe_options(flight: Flight) -> None:
    sb, one = flight.cfe.sb, pipe(flight)
    subscribe(flight, TLM, one)
    assert flight.call(lambda: sb.get_pipe_opts(one)) == 0
    flight.call(lambda: sb.set_pipe_opts(one, PIPEOPTS_IGNOREMINE))
    assert flight.call(lambda: sb.get_pipe_opts(one), "MUTE") == PIPEOPTS_IGNOREMINE
    transmit(flight, TLM, b"mine")
    flight.call(lambda: sb.transmit_msg(telemetry(TLM, b"another's")), "MUTE")
    assert [packet[16:] for packet in drain(flight, one)] == [b"another's"]
    assert refusal(flight, lambda: sb.set_pipe_opts(one, 0), "MUTE") == CFE_SB_BAD_ARGUMENT
    assert refusal(flight, lambda: sb.get_pipe_opts(0)) == CFE_SB_BAD_ARGUMENT
    assert count(flight, "PipeOptsErrorCounter") == 2


@covers("cSB4338", "cSB4339")
def test_cSB4338_names_and_ids_of_pipes(flight: Flight) -> None:
    sb, one = flight.cfe.sb, pipe(flight)
    assert flight.call(lambda: sb.get_pipe_name(one)) == "PROBE_PIPE"
    assert flight.call(lambda: sb.get_pipe_id_by_name("PROBE_PIPE")) == one
    assert refusal(flight, lambda: sb.get_pipe_name(0)) == CFE_SB_BAD_ARGUMENT
    assert refusal(flight, lambda: sb.get_pipe_id_by_name("NONE")) == CFE_SB_BAD_ARGUMENT
    assert count(flight, "GetPipeIdByNameErrorCounter") == 1


# -- subscriptions -----------------------------------------------------------------------------------------------------


@covers("cSB4303", "cSB4332")
def test_cSB4303_a_route_by_msg_id_pipe_limit_and_quality(flight: Flight) -> None:
    one, usual = pipe(flight, 20), pipe(flight, 20, "USUAL")
    flight.send(pk.ENABLE_SUB_REPORTING)
    flight.call(lambda: flight.cfe.sb.subscribe_ex(TLM, one, 0x0201, 2))
    flight.call(lambda: flight.cfe.sb.subscribe(TLM, usual))
    qualities = [(each["Qos"]["Priority"], each["Qos"]["Reliability"]) for each in flight.all(pk.ONESUB_TLM)]
    assert qualities == [(1, 2), (0, 0)]
    for _ in range(6):
        transmit(flight, TLM)
    assert (len(drain(flight, one)), len(drain(flight, usual))) == (2, 4)
    flight.call(lambda: [flight.cfe.sb.create_pipe(1, f"P{number}") for number in range(15)])
    for number in range(14):
        subscribe(flight, TLM, flight.cfe.sb.get_pipe_id_by_name(f"P{number}"))
    last = flight.cfe.sb.get_pipe_id_by_name("P14")
    assert refusal(flight, lambda: flight.cfe.sb.subscribe(TLM, last)) == CFE_SB_MAX_DESTS_MET


@covers("cSB4303.1")
def test_cSB4303_1_a_duplicate_is_an_event_and_not_an_error(flight: Flight) -> None:
    one = pipe(flight)
    subscribe(flight, TLM, one, 1)
    flight.packets.clear()
    subscribe(flight, TLM, one, 3)
    text = f"Duplicate Subscription,MsgId 0x{TLM:x} on PROBE_PIPE pipe,app PROBE.caller"
    assert events(flight) == [(7, INFORMATION, text)]
    assert count(flight, "DuplicateSubscriptionsCounter") == 1
    for _ in range(2):
        transmit(flight, TLM)
    assert len(drain(flight, one)) == 1, "one route, with the limit of the first subscription"


@covers("cSB4304", "cSB4333")
def test_cSB4304_unsubscribing(flight: Flight) -> None:
    sb, one, other = flight.cfe.sb, pipe(flight), pipe(flight, name="OTHER")
    subscribe(flight, TLM, other)
    for unsubscribe in (sb.unsubscribe, sb.unsubscribe_local):
        subscribe(flight, TLM, one)
        flight.call(lambda: unsubscribe(TLM, one))  # noqa: B023  # called at once
        transmit(flight, TLM)
        assert (len(drain(flight, one)), len(drain(flight, other))) == (0, 1)
        flight.packets.clear()
        flight.call(lambda: unsubscribe(TLM, one))  # noqa: B023  # called at once
        text = f"Unsubscribe Err:No subs for Msg 0x{TLM:x} on PROBE_PIPE,app PROBE.caller"
        assert events(flight) == [(12, INFORMATION, text)]


def test_cSB4331_a_local_subscription(flight: Flight) -> None:
    one = pipe(flight)
    flight.send(pk.ENABLE_SUB_REPORTING)
    flight.call(lambda: flight.cfe.sb.subscribe_local(TLM, one, 1))
    subscribe(flight, CMD, one)
    assert [each["MsgId"] for each in flight.all(pk.ONESUB_TLM)] == [CMD], "nobody else is told of the local one"
    for _ in range(2):
        transmit(flight, TLM)
    assert len(drain(flight, one)) == 1


# -- sending -----------------------------------------------------------------------------------------------------------


def test_cSB4305_a_message_reaches_all_subscribers(flight: Flight) -> None:
    mine = [pipe(flight, name=name) for name in ("ONE", "TWO")]
    theirs = flight.call(lambda: flight.cfe.sb.create_pipe(5, "THREE"), "MUTE")
    for each in mine:
        subscribe(flight, TLM, each)
    flight.call(lambda: flight.cfe.sb.subscribe(TLM, theirs), "MUTE")
    transmit(flight, TLM, b"all")
    got = [drain(flight, each) for each in (*mine, theirs)]
    assert got[0] == got[1] == got[2]
    assert [packet[16:] for packet in got[0]] == [b"all"]


@covers("cSB4305.1", "cSB4305.3", "cSB4305.4")
def test_cSB4305_1_limits_affect_only_their_own_pipe(flight: Flight) -> None:
    limited, small = pipe(flight, 9, "LIMITED"), pipe(flight, 2, "SMALL")
    first, middle, last = (pipe(flight, 9, name) for name in ("FIRST", "MIDDLE", "LAST"))
    for each, limit in ((first, 9), (limited, 1), (middle, 9), (small, 9), (last, 9)):
        subscribe(flight, TLM, each, limit)
    for _ in range(2):
        transmit(flight, TLM)
    flight.packets.clear()
    transmit(flight, TLM)
    assert set(events(flight)) == {
        (17, ERROR, f"Msg Limit Err,MsgId 0x{TLM:x},pipe LIMITED,sender PROBE.caller"),
        (25, ERROR, f"Pipe Overflow,MsgId 0x{TLM:x},pipe SMALL,sender PROBE.caller"),
    }
    assert [len(drain(flight, each)) for each in (first, limited, middle, small, last)] == [3, 1, 3, 2, 3]
    assert (count(flight, "MsgLimitErrorCounter"), count(flight, "PipeOverflowErrorCounter")) == (2, 1)


@covers("cSB4305.5")
def test_cSB4305_5_no_subscribers(flight: Flight) -> None:
    before = count(flight, "NoSubscribersCounter")
    flight.send(evs_packets.RESET_ALL_FILTERS, AppName="CFE_SB")
    flight.packets.clear()
    transmit(flight, TLM)
    assert events(flight) == [(14, INFORMATION, f"No subscribers for MsgId 0x{TLM:x},sender PROBE.caller")]
    assert count(flight, "NoSubscribersCounter") == before + 1


@covers("cSB4305.6")
def test_cSB4305_6_too_large(flight: Flight) -> None:
    large, one = telemetry(TLM, bytes(32753)), pipe(flight)
    subscribe(flight, TLM, one)
    transmit(flight, TLM, bytes(32752))
    assert [len(packet) for packet in drain(flight, one)] == [32768]
    assert refusal(flight, lambda: flight.cfe.sb.transmit_msg(large)) == CFE_SB_MSG_TOO_BIG
    text = f"Send Err:Msg Too Big MsgId=0x{TLM:x},app=PROBE.caller,size=32769,MaxSz=32768"
    assert events(flight) == [(15, ERROR, text)]
    assert count(flight, "MsgSendErrorCounter") == 1
    assert drain(flight, one) == []


def test_cSB4334_a_message_is_forwarded_unchanged(flight: Flight) -> None:
    one, two = pipe(flight), pipe(flight, name="TWO")
    for each in (one, two):
        subscribe(flight, CMD, each)
    foreign = command(CMD, 3, b"from elsewhere")
    msg.set_sequence_count(foreign, 77)
    foreign[7] ^= 0xFF
    flight.call(lambda: flight.cfe.sb.transmit_msg(foreign, is_origination=False))
    assert drain(flight, one) == drain(flight, two) == [foreign]


# -- receiving ---------------------------------------------------------------------------------------------------------


@covers("cSB4306", "cSB4307", "cSB4308")
def test_cSB4306_receiving_with_and_without_waiting(flight: Flight) -> None:
    sb, kernel = flight.cfe.sb, flight.mission.kernel
    one = pipe(flight)
    subscribe(flight, TLM, one)
    assert flight.call(lambda: sb.receive_buffer(one, POLL)) is None
    times: list[int] = []
    got: list[bytes | None] = []

    def reader() -> None:
        for timeout in (30, 10_000, PEND_FOREVER):
            got.append(sb.receive_buffer(one, timeout))
            times.append(kernel.now)

    begun = kernel.now
    kernel.spawn("reader", reader, 90)
    for _ in range(2):
        flight.run_for(1)
        transmit(flight, TLM)
    assert [each is None for each in got] == [True, False, False]
    assert times[0] - begun == 29_000_000  # cFE rounds the rest of an absolute time down
    assert [round((each - begun) / 1e9, 1) for each in times[1:]] == [1.0, 2.0]
    transmit(flight, TLM, b"a")
    transmit(flight, TLM, b"b")
    assert [packet[16:] for packet in drain(flight, one)] == [b"a", b"b"]


# -- zero copy ---------------------------------------------------------------------------------------------------------


@covers("cSB4340", "cSB4342", "cSB4343")
def test_cSB4340_messages_are_filled_in_place(flight: Flight) -> None:
    sb, one, two = flight.cfe.sb, pipe(flight), pipe(flight, name="TWO")
    for each in (one, two):
        subscribe(flight, CMD, each)
    for origination, expected in ((True, 1), (True, 2), (False, 1234)):
        buffer = flight.call(lambda: sb.allocate_message_buffer(12))
        buffer[:] = msg.command(CMD, 5, b"data")
        msg.set_sequence_count(buffer, 1234)
        flight.call(lambda: sb.transmit_buffer(buffer, origination))  # noqa: B023  # called at once
        (packet,) = got = drain(flight, one)
        assert drain(flight, two) == got
        assert (msg.get_sequence_count(packet), packet[8:]) == (expected, b"data")
        assert refusal(flight, lambda: sb.transmit_buffer(buffer)) == CFE_SB_BUFFER_INVALID  # noqa: B023


def test_cSB4341_buffers_are_released(flight: Flight) -> None:
    sb = flight.cfe.sb
    before = sb.pool_use()
    buffer = flight.call(lambda: sb.allocate_message_buffer(100))
    assert sb.pool_use() == (before[0] + 164, before[1] + 1)
    flight.call(lambda: sb.release_message_buffer(buffer))
    assert sb.pool_use() == before
    assert refusal(flight, lambda: sb.release_message_buffer(buffer)) == CFE_SB_BUFFER_INVALID


def test_cSB4323_time_stamp(flight: Flight) -> None:
    packet = telemetry(TLM)
    flight.call(lambda: flight.cfe.sb.time_stamp_msg(packet))
    seconds, subseconds = flight.cfe.time.get_time()
    stamped = msg.get_msg_time(packet)
    assert 0 <= (seconds << 32 | subseconds) - (stamped[0] << 32 | stamped[1]) < 1 << 30, "less than 250 ms ago"
