"""A mission that serves a ROS master: external programs find its nodes, subscribe to and call them, and vice versa.

The test itself speaks ROS's protocols for the programs, so ROS need not be installed.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.ros_host.tcpros import frame, pack_header
from cfepy.io import Listening, listening_socket
from tests.extra.ros_host.peers import CALLER, SERVER, SET_BOOL, STRING, TALKER, OutsideSpeaker, Wire, joined, text

CALLING = """
import rospy
from std_srvs.srv import SetBool
rospy.init_node("calling")
rospy.wait_for_service("/outside/switch")
switch = rospy.ServiceProxy("/outside/switch", SetBool)
print(switch(True).message)
try:
    switch(False)
except rospy.ServiceException as error:
    print(error)
rospy.spin()
"""
NOBODY = "http://127.0.0.1:1/"


def test_master_reports_nodes_of_the_mission(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        assert run.told == [f"ROS master at {run.host.world.uri}: export ROS_MASTER_URI={run.host.world.uri}"]
        publishers, subscribers, services = run.master("getSystemState")
        assert ["/chatter", ["/talker"]] in publishers
        assert ["/orders", ["/talker"]] in subscribers
        assert ["/talker/get_loggers", ["/talker"]] in services
        assert ["/chatter", "std_msgs/String"] in run.master("getPublishedTopics", "")
        uri = run.master("lookupNode", "/talker")
        assert run.ask(uri, "getName", CALLER)[2] == "/talker"
        assert run.ask(uri, "getUri", CALLER)[2] == uri
        assert run.ask(uri, "getMasterUri", CALLER)[2] == run.host.world.uri
        assert ["/chatter", "std_msgs/String"] in run.ask(uri, "getPublications", CALLER)[2]


def test_external_subscriber_receives_latched_and_later_messages(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        wire = run.subscribed("/chatter")
        header = wire.header()
        assert header == {  # the fields of rospy's publishers, which bags keep
            "callerid": "/talker",
            "latching": "1",
            "message_definition": "string data\n",
            "topic": "/chatter",
            **STRING,
        }
        assert wire.frame() == text("first")
        run.mission.outside.act("publish", "/orders", text("go on"))
        assert wire.frame() == text("GO ON")
        info = run.ask(run.master("lookupNode", "/talker"), "getBusInfo", CALLER)[2]
        assert [each[1:5] for each in info if each[1] == CALLER] == [[CALLER, "o", "TCPROS", "/chatter"]]
        wire.socket.close()
        run.run_while(lambda: bool(run.mission.ros.outside.subscriptions))
    (row,) = run.host.counts.rows()
    assert (row["peer"], row["direction"], row["messages"], row["ended"]) == (CALLER, "out", 2, 1)


def test_other_type_is_refused_and_counted(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        wire = run.subscribed("/chatter", {"type": "std_msgs/String", "md5sum": "0" * 32})
        assert "md5sums do not match" in wire.header()["error"]
        wire.ended()
        wire.socket.close()
        assert run.mission.ros.outside.subscriptions == {}
    (row,) = run.host.counts.rows()
    assert row["refused"] == 1
    assert "md5sums do not match" in row["why"]


def test_bytes_other_than_tcpros_end_only_their_connection(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        wire = run.subscribed("/chatter")
        stranger = run.connected(run.host.service_uri("/talker"), {})
        stranger.socket.sendall(b"GET / HTTP/1.1\r\n\r\n")
        assert "Missing required 'topic' field" in stranger.header()["error"]
        stranger.ended()
        stranger.socket.close()
        wire.header()
        assert wire.frame() == text("first")
        wire.socket.close()


def test_mission_receives_from_an_external_publisher(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        speaker = OutsideSpeaker(run, "/orders")
        assert speaker.connect()["callerid"] == "/talker"
        speaker.send(text("one"))
        speaker.send(text("two"))
        outside = run.mission.ros.outside
        run.run_while(lambda: not outside.links or next(iter(outside.links.values())).seq < 2)
        chatter = run.mission.ros.graph.nodes["/talker"].links["/chatter"]
        run.run_while(lambda: chatter.latch is None or chatter.latch.data != "TWO")
        speaker.close()
        run.run_while(lambda: bool(outside.links))
    rows = {row["name"]: row for row in run.host.counts.rows()}
    assert (rows["/orders"]["messages"], rows["/orders"]["peer"]) == (2, CALLER)
    assert rows["/orders"]["ended"] == 1


def test_service_of_the_mission_is_called_from_outside(tmp_path: Path) -> None:
    with joined(tmp_path, {"SERVER": SERVER}) as run:
        uri = run.master("lookupService", "/switch")
        assert uri.startswith("rosrpc://127.0.0.1:")
        probe = run.connected(uri, {"service": "/switch", "md5sum": "*", "probe": "1"})
        assert probe.header()["type"] == "std_srvs/SetBool"
        probe.ended()
        probe.socket.close()
        wire = run.connected(uri, {"service": "/switch", "persistent": "1", **SET_BOOL})
        assert wire.header()["md5sum"] == SET_BOOL["md5sum"]
        wire.frames.has_status = True
        wire.socket.sendall(b"\x01\x00\x00\x00\x01" + b"\x01\x00\x00\x00\x00")
        assert wire.frame() == b"\x01" + b"\x01" + text(f"by {CALLER}")
        assert wire.frame() == b"\x00error processing request: off is not possible"
        wire.socket.close()


SHORT_REQUEST = b"\x00service cannot process request: "


def test_short_request_gets_an_error_and_the_next_request_an_answer(tmp_path: Path) -> None:
    with joined(tmp_path, {"SERVER": SERVER}) as run:
        uri = run.master("lookupService", "/switch")
        wire = run.connected(uri, {"service": "/switch", "persistent": "1", **SET_BOOL})
        wire.header()
        wire.frames.has_status = True
        wire.socket.sendall(frame(b"") + frame(b"\x01"))
        assert wire.frame().startswith(SHORT_REQUEST)
        assert wire.frame() == b"\x01" + b"\x01" + text(f"by {CALLER}")
        wire.socket.close()
        logging = run.connected(uri, {"service": "/server/set_logger_level", "md5sum": "*"})
        logging.header()
        logging.frames.has_status = True
        logging.socket.sendall(frame(b"\xff\xff\xff\xffrosout"))
        assert logging.frame().startswith(SHORT_REQUEST)
        logging.socket.close()


SHORT_ANSWERS = {"no bytes": b"", "no text": b"\x01\x01"}


@pytest.mark.parametrize("body", SHORT_ANSWERS.values(), ids=list(SHORT_ANSWERS))
def test_unreadable_answer_is_a_service_exception(tmp_path: Path, body: bytes) -> None:
    calling = CALLING.replace("print(switch(True).message)", "switch = rospy.ServiceProxy('/outside/switch', SetBool)")
    with joined(tmp_path, {"CALLING": calling}) as run:
        wires: list[Wire] = []
        opened = Listening(
            run.host.selector, listening_socket("127.0.0.1"), lambda socket: wires.append(Wire(run, socket))
        )
        run.master("registerService", "/outside/switch", f"rosrpc://127.0.0.1:{opened.port}", NOBODY)
        answer = pack_header({"callerid": CALLER, "service": "/outside/switch", **SET_BOOL})
        for _ in range(2):
            run.run_while(lambda: not wires)
            wire = wires.pop()
            if wire.header().get("probe") == "1":
                wire.socket.sendall(answer)
                continue
            wire.socket.sendall(answer + b"\x01" + frame(body))
        run.run_while(lambda: not run.heard("receive_once[/outside/switch]: DeserializationError"))
        opened.close()


def test_mission_calls_an_external_service(tmp_path: Path) -> None:
    with joined(tmp_path, {"CALLING": CALLING}) as run:
        wires: list[Wire] = []
        opened = Listening(
            run.host.selector, listening_socket("127.0.0.1"), lambda socket: wires.append(Wire(run, socket))
        )
        uri = f"rosrpc://127.0.0.1:{opened.port}"
        run.master("registerService", "/outside/switch", uri, NOBODY)
        answer = pack_header({"callerid": CALLER, "service": "/outside/switch", **SET_BOOL})
        run.run_while(lambda: not wires)
        assert wires[0].header()["probe"] == "1"
        wires.pop().socket.sendall(answer)
        run.run_while(lambda: not wires)
        first = wires.pop()
        assert first.header()["callerid"] == "/calling"
        first.socket.sendall(answer)
        assert first.frame() == b"\x01"
        body = b"\x01" + text("well done")
        first.socket.sendall(b"\x01" + frame(body))
        run.run_while(lambda: not run.heard("well done"))
        run.run_while(lambda: not wires)
        wires.pop().socket.close()  # dies in the middle of the second call
        run.run_while(lambda: not run.heard("transport error completing service call"))
        opened.close()


def test_parameters_are_one_tree(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        run.master("setParam", "/speed", {"most": 3, "name": "fast"})
        assert run.mission.ros.graph.params.find("/speed/most") == 3
        assert run.master("getParam", "/speed/name") == "fast"
        run.master("deleteParam", "/speed")
        assert run.master("hasParam", "/speed") is False


def test_registrations_are_removed_as_by_rospy(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        run.master("registerPublisher", "/a", "std_msgs/String", NOBODY)
        calls = [
            {"methodName": "unregisterPublisher", "params": [CALLER, "/a", NOBODY]},
            {"methodName": "nonsense", "params": [CALLER]},
        ]
        answers = run.ask(run.host.world.uri, "system.multicall", calls)
        assert answers[0][0][0] == 1
        assert "nonsense" in answers[1]["faultString"]
        assert not [each for each in run.master("getSystemState")[0] if each[0] == "/a"]


def test_node_of_the_mission_is_shut_down_from_outside(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        uri = run.master("lookupNode", "/talker")
        assert run.ask(uri, "shutdown", CALLER, "enough")[0] == 1
        run.run_while(lambda: not run.mission.ros.all_finished())
        code, _, _ = run.ask(run.host.world.uri, "lookupNode", CALLER, "/talker")
        assert code == -1
