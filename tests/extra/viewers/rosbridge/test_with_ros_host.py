"""Clients of rosbridge and external ROS nodes are one graph if a run has both."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.extra.ros_host import RosHost, ServedMaster
from cfepy.extra.ros_host.tcpros import frame, pack_header
from cfepy.extra.viewers.listen import Admission, ListenPlace
from cfepy.extra.viewers.rosbridge import RosbridgeServer
from cfepy.io import HostNetwork, Listening, PeerCounts, listening_socket
from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.extra.ros_host.peers import CALLER, SERVER, SET_BOOL, Joined, OutsideSpeaker, Wire, text
from tests.extra.viewers.rosbridge.bridged import Bridged


class Both(Joined, Bridged):
    """A run that ROS nodes and clients reach."""

    def __init__(self, mission: Mission, network: HostNetwork, host: RosHost, server: RosbridgeServer) -> None:
        Joined.__init__(self, mission, network, host, [])
        self.port = server.place.port
        self.server = server


@pytest.fixture
def both(tmp_path: Path) -> Iterator[Both]:
    (tmp_path / "mission.yaml").write_text("name: both\n", encoding="utf-8")
    (tmp_path / "startup.scr").write_text(
        "CFE_APP, server.py, __main__, SERVER, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8"
    )
    (tmp_path / "server.py").write_text(SERVER, encoding="utf-8")
    server = RosbridgeServer(ListenPlace("127.0.0.1", 0), Admission(), PeerCounts())
    with (
        Mission(str(tmp_path), console=Console(quiet=True), attachments=[server]) as mission,
        HostNetwork(mission) as network,
        RosHost(mission, lambda host: ServedMaster(host, 0), {}) as host,
    ):
        network.join(host)
        network.join(server)
        run = Both(mission, network, host, server)
        run.run_while(lambda: mission.booted is None)
        yield run
    server.close()


def test_clients_and_external_nodes_exchange_messages_and_calls(both: Both) -> None:
    client = both.client()
    client.send(op="subscribe", topic="/orders", type="std_msgs/String")
    mouth = OutsideSpeaker(both, "/orders")
    mouth.connect()
    mouth.send(text("from a node"))
    assert client.next() == {"op": "publish", "topic": "/orders", "msg": {"data": "from a node"}}
    assert client.call("/rosapi/publishers", "/orders") == {"publishers": [CALLER]}

    client.send(op="advertise", topic="/replies", type="std_msgs/String")
    client.call("/rosapi/nodes")
    ear = both.subscribed("/replies")
    assert ear.header()["callerid"] == "/rosbridge_websocket"
    client.send(op="publish", topic="/replies", msg={"data": "from a page"})
    assert ear.frame() == text("from a page")

    client.send(op="advertise_service", service="/mine", type="std_srvs/SetBool")
    client.call("/rosapi/nodes")
    caller = both.connected(both.master("lookupService", "/mine"), {"service": "/mine", **SET_BOOL})
    assert caller.header()["callerid"] == "/rosbridge_websocket"
    caller.frames.has_status = True
    caller.socket.sendall(b"\x01\0\0\0\x01")
    request = client.next()
    assert request["args"] == {"data": True}
    values = {"success": True, "message": "page"}
    client.send(op="service_response", service="/mine", id=request["id"], values=values, result=True)
    assert caller.frame() == b"\x01\x01" + text("page")
    client.send(op="advertise", topic="/kept", type="std_msgs/String", latch=True)
    client.send(op="publish", topic="/kept", msg={"data": "latched"}, latch=True)
    client.call("/rosapi/nodes")
    late = both.subscribed("/kept")
    late.header()
    assert late.frame() == text("latched")
    late.socket.close()
    mouth.close()
    for each in (ear, caller):
        each.socket.close()
    client.close()


def test_malformed_messages_of_external_nodes_end_nothing(both: Both) -> None:
    """A short request to a service that a client offers, a short message, and a short answer."""
    client = both.client()
    client.send(op="advertise_service", service="/mine", type="std_srvs/SetBool")
    client.send(op="subscribe", topic="/orders", type="std_msgs/String")
    client.call("/rosapi/nodes")
    caller = both.connected(both.master("lookupService", "/mine"), {"service": "/mine", "persistent": "1", **SET_BOOL})
    caller.header()
    caller.frames.has_status = True
    caller.socket.sendall(frame(b""))
    assert caller.frame().startswith(b"\0service cannot process request: ")
    mouth = OutsideSpeaker(both, "/orders")
    mouth.connect()
    for payload in (b"", b"\1"):
        mouth.send(payload)
    mouth.send(text("whole"))
    assert client.next()["msg"] == {"data": "whole"}

    wires: list[Wire] = []
    opened = Listening(both.host.selector, listening_socket("127.0.0.1"), lambda each: wires.append(Wire(both, each)))
    both.master("registerService", "/far", f"rosrpc://127.0.0.1:{opened.port}", "http://127.0.0.1:1/")
    header = pack_header({"callerid": CALLER, "service": "/far", **SET_BOOL})
    both.run_while(lambda: not wires)
    wires.pop().socket.sendall(header)
    both.run_while(lambda: "/far" not in both.mission.ros.graph.services)
    client.send(op="call_service", service="/far", id="short", args=[True])
    both.run_while(lambda: not wires)
    wires[0].socket.sendall(header + b"\1" + frame(b"\1"))
    answer = client.next()
    assert (answer["id"], answer["result"]) == ("short", False)
    assert "cannot be read" in answer["values"]
    client.send(op="service_response", service="/mine", id="nobody", result=True)
    assert client.next()["level"] == "error"
    opened.close()
    mouth.close()
    for each in (caller, wires[0]):
        each.socket.close()
    client.close()
