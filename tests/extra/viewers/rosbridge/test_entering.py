"""All input from clients passes the door of the mission, so it can be repeated without them."""

from __future__ import annotations

from itertools import groupby
from pathlib import Path
from typing import Any

import msgpack

from cfepy.mission import Arrival, Mission
from cfepy.writing.console import Console
from rospy_shim.graph.msg_ids import msg_id_of
from tests.extra.ros_host.peers import SERVER, TALKER
from tests.extra.viewers.rosbridge.bridged import Bridged, bridged

NODES = {"TALKER": TALKER, "SERVER": SERVER}
CALLER = """
import rospy
from std_srvs.srv import Trigger
from std_msgs.msg import String
rospy.init_node("caller")
rospy.wait_for_service("/by_client")
print("answer:", rospy.ServiceProxy("/by_client", Trigger)().message)
rospy.spin()
"""


def test_run_with_clients_is_reproduced_without_them(tmp_path: Path) -> None:
    arrivals: list[tuple[int, bytes]] = []
    with bridged(tmp_path, {**NODES, "CALLER": CALLER}) as run:
        door = run.mission.outside
        door.listener = lambda arrival: arrivals.append((door.until_ns, msgpack.packb(list(arrival))))
        _session(run)
        end_ns, lines = door.until_ns, list(run.mission.console.lines)
        digest = run.mission.finish()
    assert any("answer: from outside" in line for line in lines)
    _repeat(tmp_path, arrivals, end_ns, digest, lines)


def _repeat(folder: Path, arrivals: list[tuple[int, bytes]], end_ns: int, digest: Any, lines: list[str]) -> None:
    with Mission(str(folder), console=Console(quiet=True)) as mission:
        for until_ns, here in groupby(arrivals, key=lambda each: each[0]):
            mission.run_until(until_ns)
            for _, packed in here:
                kind, values = msgpack.unpackb(packed, strict_map_key=False)
                mission.outside.repeat(Arrival(kind, tuple(values)))
        mission.run_until(end_ns)
        assert mission.finish() == digest
        assert mission.console.lines == lines


def _session(run: Bridged) -> None:
    client = run.client()
    client.send(op="subscribe", topic="/chatter", type="std_msgs/String")
    assert client.next()["msg"] == {"data": "first"}
    client.send(op="publish", topic="/orders", msg={"data": "one"})
    assert client.next()["msg"] == {"data": "ONE"}
    assert client.call("/switch", True)["success"]
    client.call("/rosapi/set_param", name="/speed", value="3")
    client.send(op="advertise_service", service="/by_client", type="std_srvs/Trigger")
    request = client.next()
    values = {"success": True, "message": "from outside"}
    client.send(op="service_response", service="/by_client", id=request["id"], values=values, result=True)
    run.run_while(lambda: not any("answer:" in line for line in run.mission.console.lines))
    client.close()
    outside = run.mission.ros.outside
    run.run_while(lambda: bool(outside.subscriptions or outside.services))
    assert run.mission.ros.graph.params.find("/speed") == 3


def test_a_refusal_is_repeated(tmp_path: Path) -> None:
    """Two topics with one MsgId: the repetition refuses what the mission has refused."""
    arrivals: list[tuple[int, bytes]] = []
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        door = run.mission.outside
        door.listener = lambda arrival: arrivals.append((door.until_ns, msgpack.packb(list(arrival))))
        names = (f"/topic{number}" for number in range(10**6))
        same = next(name for name in names if msg_id_of(name) == msg_id_of("/chatter"))
        client = run.client()
        client.send(op="subscribe", topic=same, type="std_msgs/String", id="s")
        problem = client.next()
        assert (problem["op"], problem["level"], problem["id"]) == ("status", "error", "s")
        assert "/chatter" in problem["msg"]
        end_ns, lines = door.until_ns, list(run.mission.console.lines)
        digest = run.mission.finish()
        client.close()
    assert arrivals
    _repeat(tmp_path, arrivals, end_ns, digest, lines)


def test_client_that_only_observes_does_not_change_the_trace(tmp_path: Path) -> None:
    """Asking rosapi, hearing a topic, sending nonsense and leaving again changes nothing of the run."""
    digests = []
    for looks in (False, True):
        with bridged(tmp_path, NODES) as run:
            start_ns = run.mission.kernel.now
            if looks:
                client = run.client()
                assert "/talker" in client.call("/rosapi/nodes")["nodes"]
                assert "/chatter" in client.call("/rosapi/topics")["topics"]
                assert client.call("/rosapi/get_param", "/none") == {"value": "null"}
                client.send(op="subscribe", topic="/chatter")
                assert client.next()["msg"] == {"data": "first"}
                client.send(op="nonsense")
                assert client.next()["op"] == "status"
                client.close()
            while run.mission.kernel.now < start_ns + 10**11:
                run.mission.run_until(min(run.mission.kernel.now + 10**9, start_ns + 10**11))
                run.server.exchange()
            digests.append(run.mission.finish())
    assert digests[0] == digests[1]
