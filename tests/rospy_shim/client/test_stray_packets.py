"""Packets of the ground on the MsgIds of ROS: of any length, and without a call or message."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from cfepy.status import CfeError
from rospy_shim.client.service import MOST_BEGUN, REQUEST_LEAD, Pieces
from tests.extra.ros_host.peers import CALLER, SERVER, SET_BOOL, TALKER, joined, text

LENGTHS = (7, 8, 9, 11, 12, 15, 16, 17, 20, 21, 40)
FLAGS = (0xC0, 0x40, 0x00, 0x80)


def test_stray_packets_on_msg_ids_of_ros_end_no_node(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER, "SERVER": SERVER}) as run:
        uri = run.master("lookupService", "/switch")
        wire = run.connected(uri, {"service": "/switch", "persistent": "1", **SET_BOOL})
        wire.header()
        wire.frames.has_status = True
        wire.socket.sendall(b"\x01\0\0\0\x01")
        assert wire.frame()[0] == 1
        nodes = dict(run.mission.ros.graph.nodes)
        ros_ids = [each for each in run.mission.cfe.sb.routes if each & 0x0FFF >= 0x08FC]
        assert len(ros_ids) > 5
        for msg_id in ros_ids:
            for length in LENGTHS:
                for flags in FLAGS:
                    head = msg_id.to_bytes(2, "big") + bytes([flags, 0]) + (length - 7).to_bytes(2, "big")
                    with suppress(CfeError):
                        run.mission.outside.act("packet", head + bytes(length - 6))
            run.mission.run_until(run.mission.kernel.now + 1_000_000)
        assert run.mission.ros.graph.nodes == nodes
        wire.socket.sendall(b"\x01\0\0\0\x01")
        assert wire.frame() == b"\1\1" + text(f"by {CALLER}")
        wire.socket.close()
        assert not run.heard("died of an exception")


def test_incomplete_long_request_is_forgotten() -> None:
    pieces = Pieces(REQUEST_LEAD)
    first = bytes([0x18, 0, 0x40, 0]) + bytes(20)
    for number in range(3 * MOST_BEGUN):
        assert pieces.add(number, first) is None
    assert len(pieces._parts) == MOST_BEGUN
