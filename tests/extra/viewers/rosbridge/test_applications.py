"""Clients and cFE applications: packets on topics whose MsgIds the mission file gives."""

from __future__ import annotations

from base64 import b64decode, b64encode
from pathlib import Path

from cfepy.ground import dictionary_of
from cfepy.msg import Layout, Telemetry, get_msg_id
from tests.extra.ros_host.test_shown import APP
from tests.extra.viewers.rosbridge.bridged import bridged

FILE = """
topics:
  /packets: {msg_id: 0x0F42, raw: true}
  /words: {msg_id: 0x0F43}
  /es_hk: {msg_id: 0x0800, raw: true}
"""
RAW = "std_msgs/UInt8MultiArray"


def test_packets_both_ways(tmp_path: Path) -> None:
    (tmp_path / "hear.py").write_text(APP, encoding="utf-8")
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


SHOWN = """
topics:
  /packets: {msg_id: 0x0F42, raw: true}
ros_bridge:
  publish:
    /cfs/es_hk: CFE_ES_HK_TLM
    /cfs/es_hk_raw: {packet: 0x0800, raw: true}
  subscribe: [/packets]
"""
TYPE = "cfe_tlm/CFE_ES_HK_TLM"


def test_packets_of_the_ros_bridge_section_are_topics(tmp_path: Path) -> None:
    """They are topics of the node /cfe, with the types for external nodes. The mission itself does not have them."""
    with bridged(tmp_path, {}, SHOWN) as run:
        client = run.client()
        assert client.call("/rosapi/topics") == {"topics": ["/cfs/es_hk", "/cfs/es_hk_raw"], "types": [TYPE, RAW]}
        assert client.call("/rosapi/topics_for_type", type=TYPE) == {"topics": ["/cfs/es_hk"]}
        assert client.call("/rosapi/publishers", topic="/cfs/es_hk") == {"publishers": ["/cfe"]}
        assert client.call("/rosapi/node_details", node="/cfe")["publishing"] == ["/cfs/es_hk", "/cfs/es_hk_raw"]
        assert "/cfe" in client.call("/rosapi/nodes")["nodes"]
        details = client.call("/rosapi/message_details", type=TYPE)["typedefs"]
        assert [each["type"] for each in details][:1] == [TYPE]
        client.send(op="subscribe", topic="/cfs/es_hk", type=TYPE)
        client.send(op="subscribe", topic="/cfs/es_hk_raw")
        client.call("/rosapi/nodes")
        run.mission.outside.act("packet", bytes.fromhex("1806c00000010000"))  # NOOP
        run.mission.outside.act("packet", bytes.fromhex("1808c00000010000"))
        heard = {each["topic"]: each["msg"] for each in (client.next(), client.next())}
        packet = b64decode(heard["/cfs/es_hk_raw"]["data"])
        values = dictionary_of(run.mission.spec).decode(packet).values
        assert heard["/cfs/es_hk"]["CommandCounter"] == values["CommandCounter"] == 1
        assert heard["/cfs/es_hk"]["CFECoreChecksum"] == values["CFECoreChecksum"] > 0
        client.send(op="unsubscribe", topic="/cfs/es_hk")
        client.send(op="unsubscribe", topic="/cfs/es_hk_raw")
        client.call("/rosapi/nodes")
        run.mission.outside.act("packet", bytes.fromhex("1808c00000010000"))
        assert "/cfe" in client.call("/rosapi/nodes")["nodes"]  # and no message before that
        assert run.mission.ros is None
        client.close()


def test_packet_too_short_for_its_type_is_counted(tmp_path: Path) -> None:
    with bridged(tmp_path, {}, SHOWN) as run:
        client = run.client()
        client.send(op="subscribe", topic="/cfs/es_hk", type=TYPE)
        client.call("/rosapi/nodes")
        run.mission.outside.act("packet", bytes(Telemetry("A", 0x0800).packet()) + bytes(4))
        run.run_while(lambda: not any(row["name"] == "/cfs/es_hk" and row["dropped"] for row in run.counts.rows()))
        client.close()
    (row,) = (row for row in run.counts.rows() if row["name"] == "/cfs/es_hk" and row["dropped"])
    assert (row["dropped"], row["why"]) == (1, "a packet is shorter than its layout")
