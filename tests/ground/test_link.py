"""The ground link: packets between pieces of a run in both directions, as part of the run."""

from __future__ import annotations

import pytest

from apps.ci_lab import packets as ci_lab
from apps.to_lab import packets as to_lab
from cfepy.ground.link import GroundLink
from cfepy.mission import Mission
from cfepy.msg import command
from cfepy.osal.network import Datagram, Place
from cfepy.writing.console import Console

ENABLE = to_lab.OUTPUT_ENABLE.packet(dest_IP="10.0.0.7")
PROCESSOR_RESET = bytes(command(0x1806, 2, b"\1\0"))


def mission(tasks: str = "thread") -> Mission:
    return Mission("lab", tasks=tasks, console=Console(quiet=True))


def test_up_and_down() -> None:
    with mission() as flight, GroundLink(flight) as ground:
        flight.run_for(2)
        assert ground.send(ENABLE)
        flight.run_for(1.5)
        flight.run_for(1)
        down = ground.received()
        times = [time_ns for time_ns, _ in down]
        assert times == sorted(times)
        assert 2_000_000_000 < times[0] <= times[-1] <= flight.kernel.now
        assert all(len(packet) == 7 + int.from_bytes(packet[4:6], "big") for _, packet in down)
        assert ground.received() == []
        assert ground.received(port=1) == []


def test_packet_is_lost_before_the_boot_and_at_an_unused_port() -> None:
    with mission() as flight, GroundLink(flight) as ground:
        assert not ground.send(ENABLE)
        flight.run_for(2)
        assert not ground.send(ENABLE, port=1233)


def test_full_socket_drops_packets() -> None:
    with mission() as flight, GroundLink(flight) as ground:
        flight.run_for(2)
        taken = [ground.send(bytes(700)) for _ in range(300)]
        assert taken.count(True) == 212_992 // (700 + 768)
        assert taken == sorted(taken, reverse=True)


def test_callback_gets_each_datagram_at_once() -> None:
    seen: list[Datagram] = []
    with mission() as flight, GroundLink(flight, seen.append) as ground:
        flight.run_for(2)
        ground.send(ENABLE, source=Place("127.0.0.1", 4000))
        flight.run_for(2)
        assert {datagram.target for datagram in seen} == {("10.0.0.7", 1235)}
        assert ground.received() == []


def test_link_survives_a_reset() -> None:
    with mission() as flight, GroundLink(flight) as ground:
        flight.run_for(2)
        ground.send(PROCESSOR_RESET)
        flight.run_for(3)
        assert len(flight.record.resets) == 1
        assert ground.send(ENABLE)
        flight.run_for(3)
        assert ground.received()


@pytest.mark.parametrize("step", [0.5, 0.25])
def test_same_input_at_the_same_times_gives_the_same_run(step: float) -> None:
    runs = []
    for tasks in ("thread", "greenlet"):
        with mission(tasks) as flight, GroundLink(flight) as ground:
            flight.run_for(2)
            for packet in (ENABLE, ci_lab.NOOP.packet(), to_lab.SEND_DATA_TYPES.packet()):
                ground.send(packet)
                flight.run_for(step)
            flight.run_for(2)
            runs.append((flight.trace.digest(), ground.received()))
    assert runs[0] == runs[1]
