"""Notifications of a Software Bus listener about each packet object."""

from __future__ import annotations

import random
from collections import Counter

import pytest

from cfepy.faults.failing_calls import Puts, refusing
from cfepy.rtos import CpuCosts
from cfepy.sb import SoftwareBus
from cfepy.sb.packet_listener import listened
from cfepy.sb.pipe import Pipe
from cfepy.status import OS_QUEUE_FULL
from tests.sb.harness import Bench, packet

MID = 0x0881


class Notes:
    """A listener that records its notifications, and checks that they are consistent."""

    def __init__(self) -> None:
        self.told: list[tuple[str, int, str]] = []
        self.numbers: dict[int, int] = {}
        self.kept: list[bytes] = []  # so that no id is given twice
        self.held: Counter[tuple[int, str]] = Counter()
        self.open: set[int] = set()

    def _note(self, what: str, packet: bytes, pipe: str = "") -> int:
        number = self.numbers[id(packet)]
        self.told.append((what, number, pipe))
        return number

    def made(self, packet: bytes) -> None:
        assert id(packet) not in self.numbers
        self.kept.append(packet)
        self.numbers[id(packet)] = len(self.kept)
        self.open.add(self._note("made", packet))

    def put(self, packet: bytes, pipe: Pipe) -> None:
        number = self._note("put", packet, pipe.name)
        assert number in self.open
        self.held[number, pipe.name] += 1

    def dropped(self, packet: bytes, pipe: Pipe) -> None:
        number = self._note("dropped", packet, pipe.name)
        if not self.held[number, pipe.name]:
            assert number in self.open
        else:
            self.held[number, pipe.name] -= 1

    def sent(self, packet: bytes) -> None:
        self.open.remove(self._note("sent", packet))

    def taken(self, packet: bytes, pipe: Pipe) -> None:
        number = self._note("taken", packet, pipe.name)
        self.held[number, pipe.name] -= 1
        assert self.held[number, pipe.name] == 0

    def pipe_gone(self, pipe: Pipe, packets: list[bytes]) -> None:
        self.told.append(("gone", len(packets), pipe.name))
        for each in packets:
            self.held[self.numbers[id(each)], pipe.name] -= 1
        assert not [key for key, count in self.held.items() if key[1] == pipe.name and count]


def bench_of(notes: Notes, context: str = "thread") -> Bench:
    return Bench(context, listened(SoftwareBus, notes))


@pytest.mark.parametrize("context", ["thread", "greenlet"])
def test_urgent_receiver_runs_after_the_notification(context: str) -> None:
    notes = Notes()
    bench = bench_of(notes, context)
    bus = bench.bus
    got: list[bytes] = []

    def receive(pipe_name: str) -> None:
        pipe = bus.create_pipe(4, pipe_name)
        bus.subscribe(MID, pipe)
        message = bus.receive_buffer(pipe)
        assert message is not None
        got.append(message)

    bench.spawn("SLOW", lambda: receive("S"), 150)
    bench.spawn("URGENT", lambda: receive("U"), 50)
    bench.kernel.run(0)
    buffers = []

    def send() -> None:
        buffer = bus.allocate_message_buffer(16)
        buffer[:] = packet(MID)
        bus.transmit_buffer(buffer)
        buffers.append(buffer)

    bench.do("SENDER", send)
    assert got[0] is got[1] is notes.kept[0]
    assert notes.told == [
        ("made", 1, ""),
        ("put", 1, "S"),
        ("put", 1, "U"),
        ("taken", 1, "U"),
        ("sent", 1, ""),
        ("taken", 1, "S"),
    ]


def test_refused_and_displaced_packets_are_dropped() -> None:
    notes = Notes()
    bench = bench_of(notes)
    bus = bench.bus

    def run() -> None:
        full, limited, newest = (bus.create_pipe(depth, name) for depth, name in ((1, "FULL"), (9, "LIM"), (1, "NEW")))
        bus.subscribe_ex(MID, full, msg_limit=9)
        bus.subscribe_ex(MID, limited, msg_limit=1)
        bus.subscribe_ex(MID, newest, msg_limit=9)
        kept = bus.find_pipe(newest)
        assert kept is not None
        kept.keeps_newest = True
        bus.transmit_msg(packet(MID))
        bus.transmit_msg(packet(MID))

    bench.do("APP", run)
    second = [each for each in notes.told if each not in (("made", 1, ""), ("sent", 1, ""), ("put", 1, "FULL"))]
    assert ("dropped", 1, "NEW") in second  # it makes room ...
    assert second.index(("dropped", 1, "NEW")) < second.index(("put", 2, "NEW"))  # ... for this one
    assert {("dropped", 2, "FULL"), ("dropped", 2, "LIM")} <= set(second)
    assert second.index(("dropped", 2, "FULL")) < second.index(("sent", 2, ""))
    assert notes.open == set()


def test_packets_of_a_deleted_pipe_are_released() -> None:
    notes = Notes()
    bench = bench_of(notes)
    bus = bench.bus

    def run() -> None:
        pipe = bus.create_pipe(4, "P")
        bus.subscribe(MID, pipe)
        bus.transmit_msg(packet(MID))
        bus.transmit_msg(packet(MID))
        assert bus.receive_buffer(pipe) is notes.kept[0]
        bus.delete_pipe(pipe)
        bus.transmit_msg(packet(MID))

    bench.do("APP", run)
    assert notes.told[-3:] == [("gone", 1, "P"), ("made", 3, ""), ("sent", 3, "")]
    assert not +notes.held


def test_unsent_packets_cause_no_notification() -> None:
    notes = Notes()
    bench = bench_of(notes)

    def run() -> None:
        bench.bus.transmit_msg(packet(MID))  # which has no subscriber
        pipe = bench.bus.create_pipe(4, "P")
        bench.bus.subscribe(MID, pipe)
        bench.bus.transmit_msg(b"short")

    bench.do("APP", run)
    assert notes.told == []


class FullQueue:
    """A fault: puts into pipe P find its queue full."""

    def put_status(self, caller: str, pipe: str) -> int | None:
        return OS_QUEUE_FULL if pipe == "P" else None


def test_puts_refused_by_a_fault_are_drops() -> None:
    notes = Notes()
    puts = Puts()
    puts.begin([FullQueue()])  # type: ignore[list-item]  # all that is asked of it
    bench = Bench(bus=refusing(listened(SoftwareBus, notes), puts))

    def run() -> None:
        for name in "PQ":
            bench.bus.subscribe(MID, bench.bus.create_pipe(4, name))
        bench.bus.transmit_msg(packet(MID))

    bench.do("APP", run)
    assert notes.told == [("made", 1, ""), ("put", 1, "Q"), ("dropped", 1, "P"), ("sent", 1, "")]


def wander(bench: Bench, seed: int) -> str:
    """Run tasks that send, receive, subscribe and delete at random. Returns the digest of the run."""
    bus, dice = bench.bus, random.Random(seed)
    bench.bus.costs = CpuCosts(call_ns=700)

    def live(name: str) -> None:
        pipes: list[int] = []
        for _ in range(60):
            step = dice.randrange(9)
            if step < 4:
                bus.transmit_msg(packet(MID + dice.randrange(3), bytes(dice.randrange(5))))
            elif step < 6 and pipes:
                bus.receive_buffer(dice.choice(pipes), dice.choice((0, 0, 3)))
            elif step == 6 and len(pipes) < 2:
                pipes.append(bus.create_pipe(dice.randrange(1, 4), f"{name}{dice.random():.9f}"))
                pipe = bus.find_pipe(pipes[-1])
                assert pipe is not None
                pipe.keeps_newest = dice.random() < 0.5
            elif step == 7 and pipes:
                bus.subscribe_ex(MID + dice.randrange(3), dice.choice(pipes), msg_limit=dice.randrange(1, 4))
            elif step == 8 and pipes and dice.random() < 0.3:
                bus.delete_pipe(pipes.pop())
            else:
                bench.kernel.delay(dice.randrange(2000))
        for pipe_id in pipes:
            bus.delete_pipe(pipe_id)

    for number in range(4):
        bench.spawn(f"T{number}", lambda number=number: live(f"T{number}"), 100 + number % 3)  # type: ignore[misc]
    bench.kernel.run(10**10)
    assert bench.kernel.trace is not None
    return bench.kernel.trace.digest()


@pytest.mark.parametrize("seed", range(20))
def test_each_put_packet_leaves_once(seed: int) -> None:
    notes = Notes()
    digest = wander(bench_of(notes), seed)
    assert len(notes.kept) > 20
    assert not +notes.held
    assert not notes.open
    assert digest == wander(Bench(), seed)  # and nothing in the run is changed
