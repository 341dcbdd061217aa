"""Packets of cFE applications as ROS topics, and topics that become packets, as the mission file defines."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.ros_host import RosHost, ServedMaster
from cfepy.extra.ros_host.tcpros import frame
from cfepy.ground import dictionary_of
from cfepy.ground.shown_packets import PacketSerializer, type_of
from cfepy.io.host_network import HostNetwork
from cfepy.mission import Mission
from cfepy.msg import Layout, Telemetry, command
from cfepy.pilot.mission_check import check_mission
from cfepy.status import UsageError
from cfepy.writing.console import Console
from rospy_shim.types.msgs import from_full_text
from tests.extra.ros_host.peers import OutsideSpeaker, joined, text

SEND_ES_HK = 0x1808
RAW = {"type": "std_msgs/UInt8MultiArray", "md5sum": "82373f1612381bb6ee473b5cd6f5d89c"}
FILE = """
topics:
  /packets: {msg_id: 0x0F42, raw: true}
  /words: {msg_id: 0x0F43}
ros_bridge:
  publish:
    /cfs/es_hk: CFE_ES_HK_TLM
    /cfs/es_hk_raw: {packet: 0x0800, raw: true}
  subscribe: [/packets, /words]
"""
APP = '''
def Listener(cfe):
    """Tells the console of packets 0x0F42 and 0x0F43."""
    pipe = cfe.sb.create_pipe(10, "HEAR")
    cfe.sb.subscribe(0x0F42, pipe)
    cfe.sb.subscribe(0x0F43, pipe)
    while True:
        packet = cfe.sb.receive_buffer(pipe)
        cfe.es.write_to_sys_log(f"heard {packet[:2].hex()} {packet[16:].hex()}")
'''
LISTENER = "CFE_APP, hear, Listener, HEAR, 60, 16384, 0x0, 0;\n"


def test_telemetry_is_published_with_its_own_type(tmp_path: Path) -> None:
    with joined(tmp_path, {}, mission_file=FILE) as run:
        types = dict(run.master("getPublishedTopics", "/cfs"))
        assert types == {"/cfs/es_hk": "cfe_tlm/CFE_ES_HK_TLM", "/cfs/es_hk_raw": RAW["type"]}
        decoded = run.subscribed("/cfs/es_hk", {"type": "*", "md5sum": "*"})
        raw = run.subscribed("/cfs/es_hk_raw", RAW)
        header = decoded.header()
        assert header["callerid"] == raw.header()["callerid"] == "/cfe"
        run.mission.outside.act("packet", command(SEND_ES_HK, 0))
        packet = raw.frame()[12:]
        kind = from_full_text(header["type"], header["message_definition"]).message_class(header["type"])
        assert kind._md5sum == header["md5sum"]
        message = kind().deserialize(decoded.frame())
        values = dictionary_of(run.mission.spec).decode(packet).values
        assert message.SysLogSize == values["SysLogSize"] > 0
        assert list(message.PerfFilterMask) == values["PerfFilterMask"]
        assert message.header.seq == (packet[2] << 8 | packet[3]) & 0x3FFF
        seconds = int.from_bytes(packet[6:10], "big")
        assert message.header.stamp.secs == seconds + 315_532_800
        for wire in (decoded, raw):
            wire.socket.close()
        run.run_while(lambda: bool(run.mission.ros.outside._shown))


def test_topics_are_subscribed_for_applications(tmp_path: Path) -> None:
    (tmp_path / "hear.py").write_text(APP, encoding="utf-8")
    with joined(tmp_path, {}, LISTENER, FILE) as run:
        packets = OutsideSpeaker(run, "/packets", RAW)
        assert packets.connect()["callerid"] == "/cfe"
        for msg_id in (0x0F44, 0x0F42):  # the first is another packet than the topic carries
            packet = Telemetry("A", msg_id, Layout("B", [("C", "u16")])).packet(C=0x1234)
            packets.send(bytes(8) + frame(packet))
        run.run_while(lambda: not run.heard("heard 0f42 3412"))
        words = OutsideSpeaker(run, "/words")
        words.connect()
        words.send(text("hi"))
        run.run_while(lambda: not run.heard("heard 0f43 020000006869"))
        packets.close()
        words.close()
    rows = {row["name"]: row for row in run.host.counts.rows()}
    assert (rows["/packets"]["messages"], rows["/packets"]["dropped"]) == (2, 1)


def test_mission_publishes_its_time_on_clock(tmp_path: Path) -> None:
    """/clock has the mission's time, at the requested rate. Its own nodes do not wait for it."""
    node = "import rospy\nrospy.init_node('n')\nrospy.sleep(0.01)\nprint(f'at {rospy.get_time():.2f}')\nrospy.spin()\n"
    file = "params: {use_sim_time: true}\nros_bridge: {clock: 50}\n"
    with joined(tmp_path, {"N": node}, mission_file=file) as run:
        wire = run.subscribed("/clock", {"type": "rosgraph_msgs/Clock", "md5sum": "a9c97c1d230cfc112e270351a944ee47"})
        assert wire.header()["callerid"] == "/cfe"
        epoch_ns = run.mission.processor.machine.epoch_ns
        run.run_while(lambda: not run.heard("at 3165"))
        times = [wire.frame() for _ in range(5)]
        at_ns = [int.from_bytes(each[:4], "little") * 10**9 + int.from_bytes(each[4:], "little") for each in times]
        assert all(epoch_ns < each <= epoch_ns + run.mission.kernel.now for each in at_ns)
        ticks = [(each - epoch_ns) // 20_000_000 for each in at_ns]
        assert ticks == sorted(set(ticks))
        wire.socket.close()


@pytest.mark.parametrize("telemetry", dictionary_of(None).telemetry.values(), ids=lambda each: each.name)
def test_every_packet_is_a_message(telemetry: Telemetry) -> None:
    if not isinstance(telemetry, Telemetry):
        return
    made = type_of(telemetry.name, telemetry.payload)
    kind = from_full_text(made.name, made.definition).message_class(made.name)
    data = PacketSerializer(telemetry.payload).message(telemetry.packet())
    message = kind().deserialize(data)
    assert [name for name in kind.__slots__ if name != "header"] == list(telemetry.payload.fields)
    assert PacketSerializer(telemetry.payload).message(telemetry.packet()[:15]) is None
    assert message.header.frame_id == ""


def test_texts_structs_and_arrays() -> None:
    inner = Layout("Inner", [("Id", "u8"), ("Value", "i32"), ("Names", "char[2][4]")])
    layout = Layout("Outer", [("Flag", "bool"), ("Grid", "u16[2][3]"), ("Items", (inner, 2)), ("Name", "char[6]")])
    values = {
        "Flag": True,
        "Grid": [[1, 2, 3], [4, 5, 6]],
        "Items": [{"Id": 7, "Value": -8, "Names": ["ab", "abcd"]}, {"Id": 9, "Value": 10, "Names": ["", "x"]}],
        "Name": "outer",
    }
    made = type_of("OUTER TLM", layout)
    assert made.definition.startswith(
        "std_msgs/Header header\nbool Flag\nuint16[6] Grid\ncfe_tlm/OUTER_TLM_Items[2] Items\nstring Name\n"
    )
    kind = from_full_text(made.name, made.definition).message_class(made.name)
    data = PacketSerializer(layout).message(Telemetry("OUTER", 0x0880, layout).packet(values))
    message = kind().deserialize(data)
    assert (message.Flag, list(message.Grid), message.Name) == (True, [1, 2, 3, 4, 5, 6], "outer")
    assert [(each.Id, each.Value, each.Names) for each in message.Items] == [
        (7, -8, ["ab", "abcd"]),
        (9, 10, ["", "x"]),
    ]


def test_mistakes_in_the_section_are_reported_with_their_line(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text("!\n", encoding="utf-8")
    (tmp_path / "mission.yaml").write_text(
        "ros_bridge:\n  publish:\n    b: CFE_ES_HK_TLM\n    /c: {raw: true}\n  subscribe: [d]\n", encoding="utf-8"
    )
    told = check_mission(str(tmp_path))
    assert len(told) == 3
    for line, part in ((3, 'must begin with "/"'), (4, "missing packet"), (5, 'must begin with "/"')):
        assert any(each.line == line and part in each.text for each in told), told
    (tmp_path / "mission.yaml").write_text(
        "ros_bridge:\n  publish:\n    /a: CFE_ES_HKK_TLM\n    /b: 0x0800\n  subscribe: [/d]\n", encoding="utf-8"
    )
    told = check_mission(str(tmp_path))
    assert len(told) == 2
    for line, part in ((3, "CFE_ES_HKK_TLM"), (5, "/d requires a fixed MsgId")):
        assert any(each.line == line and part in each.text for each in told), told


def test_unknown_packet_is_refused_before_the_run(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text("!\n", encoding="utf-8")
    (tmp_path / "mission.yaml").write_text("ros_bridge: {publish: {/a: CFE_ES_HKK_TLM, /b: X}}\n", encoding="utf-8")
    with (
        Mission(str(tmp_path), console=Console(quiet=True)) as mission,
        HostNetwork(mission),
        pytest.raises(UsageError, match="CFE_ES_HKK_TLM") as caught,
    ):
        RosHost(mission, lambda host: ServedMaster(host, 0), {})
    told = [(each.file, each.field) for each in caught.value.each]
    assert told == [(str(tmp_path / "mission.yaml"), f"ros_bridge.publish./{name}") for name in "ab"]
