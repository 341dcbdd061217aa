"""Subscriptions reported to other processors: as they are made, and all at once."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from cfepy.sb import POLL, SbTask
from cfepy.sb import packets as pk
from tests.sb.harness import Bench


@pytest.fixture
def bench() -> Iterator[Bench]:
    bench = Bench()
    yield bench
    bench.kernel.shutdown()


def listener(bench: Bench) -> int:
    pipe = bench.do("NET", lambda: bench.bus.create_pipe(20, "NET"))
    assert isinstance(pipe, int)
    for msg_id in (pk.ONESUB_TLM_MID, pk.ALLSUBS_TLM_MID):
        bench.do("NET", lambda: bench.bus.subscribe_local(msg_id, pipe, 20))  # noqa: B023  # called at once
    return pipe


def subscriber(bench: Bench) -> int:
    pipe = bench.do("A", lambda: bench.bus.create_pipe(5, "P"))
    assert isinstance(pipe, int)
    return pipe


def test_each_subscription_is_reported_while_reports_are_on(bench: Bench) -> None:
    net, pipe, task = listener(bench), subscriber(bench), SbTask(bench.bus)
    bench.do("A", lambda: bench.bus.subscribe(0x801, pipe))
    task.process(pk.ENABLE_SUB_REPORTING.packet())
    bench.do("A", lambda: bench.bus.subscribe_ex(0x802, pipe, 0x0203, 4))
    bench.do("A", lambda: bench.bus.subscribe_local(0x803, pipe, 4))
    task.process(pk.DISABLE_SUB_REPORTING.packet())
    bench.do("A", lambda: bench.bus.subscribe(0x804, pipe))
    got = bench.bus.receive_buffer(net, POLL)
    assert got is not None
    expected = {"SubType": 0, "MsgId": 0x802, "Qos": {"Priority": 3, "Reliability": 2}, "Pipe": pipe}
    assert pk.ONESUB_TLM.read(got) == expected
    assert bench.bus.receive_buffer(net, POLL) is None
    assert (22, f"Sending Subscription Report Msg=0x802,Pipe={pipe},Stat=0x0") in bench.events.sent
    assert bench.bus.counters.command == 0, "these requests are not counted"


def test_duplicate_subscription_is_reported_again(bench: Bench) -> None:
    net, pipe = listener(bench), subscriber(bench)
    bench.bus.reporting = True
    for _ in range(2):
        bench.do("A", lambda: bench.bus.subscribe(0x801, pipe))
    assert [bench.bus.receive_buffer(net, POLL) is not None for _ in range(3)] == [True, True, False]


def test_failed_report_is_mentioned_in_the_event() -> None:
    bench = Bench(sb_max_msg_size=31)
    pipe = subscriber(bench)
    bench.bus.reporting = True
    assert bench.do("A", lambda: bench.bus.subscribe(0x801, pipe)) is None
    assert bench.events.sent[-1] == (22, f"Sending Subscription Report Msg=0x801,Pipe={pipe},Stat=0xca000007")
    bench.kernel.shutdown()


@pytest.mark.parametrize(("count", "packets"), [(0, []), (3, [3]), (20, [20]), (45, [20, 20, 5])])
def test_all_subscriptions_are_reported_in_packets(bench: Bench, count: int, packets: list[int]) -> None:
    net, pipe, task = listener(bench), subscriber(bench), SbTask(bench.bus)
    for number in range(count):
        bench.do("A", lambda: bench.bus.subscribe(0x1800 + number, pipe))  # noqa: B023  # called at once
    task.process(pk.SEND_PREV_SUBS.packet())
    got = [pk.ALLSUBS_TLM.read(bench.bus.receive_buffer(net, POLL) or b"") for _ in packets]
    assert [one["Entries"] for one in got] == packets
    assert [one["PktSegment"] for one in got] == list(range(1, len(packets) + 1))
    told = [entry["MsgId"] for one in got for entry in one["Entry"] if entry["MsgId"]]
    assert told == [0x1800 + number for number in range(count)]
    last = {0: None, 3: "Partial Sub Pkt 1 Sent,Entries=3,Stat=0x0", 20: "Full Sub Pkt 1 Sent,Entries=20,Stat=0x0"}
    text = last.get(count, "Partial Sub Pkt 3 Sent,Entries=5,Stat=0x0")
    assert text is None or bench.events.sent[-1][1] == text
