"""Observing the Software Bus changes nothing and misses nothing."""

from __future__ import annotations

from pathlib import Path

from cfepy.mission import Mission
from cfepy.mission.packet_watch import PacketWatch, Seen
from cfepy.msg import get_sequence_count, validate_checksum
from cfepy.sb import Outlet
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

APP = """
    def Main(cfe):
        cfe.evs.register()
        pipe = cfe.sb.create_pipe(10, "OWN")
        cfe.sb.subscribe(0x0890, pipe)
        while cfe.es.run_loop(1):
            cfe.sb.transmit_msg(cfe.msg.telemetry(0x0890, bytes(4)))  # to itself
            cfe.sb.transmit_msg(cfe.msg.telemetry(0x0891, bytes(4)))  # to nobody
            cfe.sb.transmit_msg(cfe.msg.command(0x1892, 1, b"x"))
            cfe.sb.receive_buffer(pipe, 0)
            cfe.os.task_delay(100)
"""
STARTUP = "CFE_APP, own, Main, OWN, 50, 8192, 0, 0;\n!\n"


def fly(folder: Path, seen: list[Seen] | None) -> str:
    mission = write_mission(folder, STARTUP, own=APP)
    options = {} if seen is None else {"attachments": [PacketWatch(seen.append)]}
    with Mission(mission, console=Console(quiet=True), **options) as flight:  # type: ignore[arg-type]
        flight.run_for(2)
        return flight.trace.digest()


def test_watched_run_has_the_same_trace(tmp_path: Path) -> None:
    assert fly(tmp_path, []) == fly(tmp_path, None)


def test_watched_packets_equal_received_ones_in_header_and_checksum(tmp_path: Path) -> None:
    seen: list[Seen] = []
    fly(tmp_path, seen)
    own = [each for each in seen if each.sender == "OWN" and each.msg_id == 0x0890]
    assert [get_sequence_count(each.packet) for each in own] == list(range(1, len(own) + 1))
    assert len({each.packet[6:12] for each in own}) == len(own)  # every one has its time
    assert [each.at_ns for each in own] == sorted(each.at_ns for each in own)
    command = next(each for each in seen if each.msg_id == 0x1892)
    assert validate_checksum(command.packet)


def test_watched_packets_have_the_same_bytes(tmp_path: Path) -> None:
    seen: list[Seen] = []
    got: list[bytes] = []
    watch = PacketWatch(seen.append, lambda msg_id: msg_id in (0x0890, 0x1892))
    with Mission(write_mission(tmp_path, STARTUP, own=APP), console=Console(quiet=True), attachments=[watch]) as flight:
        flight.run_for(1)
        seen.clear()
        for msg_id in (0x0890, 0x1892):
            Outlet(flight.cfe.sb, msg_id, "ear", got.append)
        flight.run_for(2)
    assert len(got) > 10
    assert [each.packet for each in seen] == got


def test_packets_without_a_subscriber_are_seen(tmp_path: Path) -> None:
    seen: list[Seen] = []
    fly(tmp_path, seen)
    assert len([each for each in seen if each.msg_id == 0x0891]) == len(
        [each for each in seen if each.msg_id == 0x0890]
    )
