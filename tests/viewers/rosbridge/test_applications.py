"""Clients and cFE applications: packets on topics whose MsgIds the mission file gives."""

from __future__ import annotations

from base64 import b64decode, b64encode
from pathlib import Path

from cfepy.msg import Layout, Telemetry, get_msg_id
from tests.ros_host.test_shown import APP
from tests.viewers.rosbridge.bridged import bridged

FILE = """
topics:
  /packets: {msg_id: 0x0F42, raw: true}
  /words: {msg_id: 0x0F43}
  /es_hk: {msg_id: 0x0800, raw: true}
"""
RAW = "std_msgs/UInt8MultiArray"


def test_packets_both_ways(tmp_path: Path) -> None:
    (tmp_path / "hear.py").write_text(APP)
    with bridged(tmp_path, {}, FILE, lines="CFE_APP, hear, Listener, HEAR, 60, 16384, 0x0, 0;\n") as run:
        client = run.client()
        client.send(op="advertise", topic="/packets", type=RAW)
        packet = Telemetry("A", 0x0F42, Layout("B", [("C", "u16")])).packet(C=0x1234)
        client.send(op="publish", topic="/packets", msg={"data": b64encode(packet).decode()})
        client.send(op="advertise", topic="/words", type="std_msgs/String")
        client.send(op="publish", topic="/words", msg={"data": "hi"})
        lines = run.mission.console.lines
        run.run_while(lambda: not any("heard 0f43 020000006869" in each for each in lines))
        assert any("heard 0f42 3412" in each for each in lines)
        client.send(op="publish", topic="/packets", msg={"data": "AAAA"})  # another MsgId
        told = client.next()
        assert (told["level"], told["msg"]) == ("error", "publish: the Software Bus did not take a message of /packets")
        client.close()
    rows = {row["name"]: row for row in run.counts.rows()}
    assert (rows["/packets"]["messages"], rows["/packets"]["dropped"]) == (2, 1)


def test_telemetry_on_a_raw_topic(tmp_path: Path) -> None:
    with bridged(tmp_path, {}, FILE) as run:
        client = run.client()
        client.send(op="subscribe", topic="/es_hk", type=RAW)
        client.call("/rosapi/nodes")
        run.mission.outside.act("packet", bytes.fromhex("1808c00000010000"))
        data = b64decode(client.next()["msg"]["data"])
        assert get_msg_id(data) == 0x0800
        client.close()
