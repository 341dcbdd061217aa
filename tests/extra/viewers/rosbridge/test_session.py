"""Clients of rosbridge publish, subscribe, call and serve."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.extra.ros_host.peers import SERVER, TALKER
from tests.extra.viewers.rosbridge.bridged import bridged

CALLER = """
import rospy
from std_srvs.srv import Trigger
from std_msgs.msg import String
rospy.init_node("caller")
told = rospy.Publisher("/told", String, queue_size=10, latch=True)
def call(message):
    try:
        told.publish("answer: " + rospy.ServiceProxy(message.data, Trigger)().message)
    except rospy.ServiceException as error:
        told.publish("error: %s" % error)
rospy.Subscriber("/ask", String, call)
rospy.spin()
"""
TRIGGER = "std_srvs/Trigger"


def test_messages_both_ways(tmp_path: Path) -> None:
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        client = run.client()
        client.send(op="subscribe", topic="/chatter", type="std_msgs/String")
        assert client.next() == {"op": "publish", "topic": "/chatter", "msg": {"data": "first"}}
        client.send(op="advertise", topic="/orders", type="std_msgs/String")
        client.send(op="publish", topic="/orders", msg={"data": "one"})
        assert client.next()["msg"] == {"data": "ONE"}
        other = run.client()
        other.send(op="subscribe", topic="chatter")
        assert other.next() == {"op": "publish", "topic": "chatter", "msg": {"data": "ONE"}}
        other.send(op="subscribe", topic="/orders", compression="cbor-raw")
        client.send(op="publish", topic="/orders", msg={"data": "two"})
        assert isinstance(other.next(), bytes), "clients hear each other"
        assert other.next()["msg"] == {"data": "TWO"}
        assert client.next()["msg"] == {"data": "TWO"}
        for each in (client, other):
            each.close()
        run.run_while(lambda: bool(run.mission.ros.outside.subscriptions))
        rows = {(row["name"], row["direction"]): row["messages"] for row in run.counts.rows()}
        assert (rows["/orders", "in"], rows["/orders", "out"], rows["/chatter", "out"]) == (2, 1, 5)


def test_publisher_outlives_its_client_for_a_while(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from cfepy.extra.viewers.rosbridge import bridge_node

    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        client = run.client()
        client.send(op="advertise", topic="/orders", type="std_msgs/String")
        assert client.call("/rosapi/publishers", "/orders") == {"publishers": ["/rosbridge_websocket"]}
        client.send(op="unadvertise", topic="/orders")
        assert client.call("/rosapi/publishers", "/orders") == {"publishers": ["/rosbridge_websocket"]}
        monkeypatch.setattr(bridge_node, "UNREGISTER_S", 0.0)
        client.send(op="advertise", topic="/orders", type="std_msgs/String")
        client.close()
        outside = run.mission.ros.outside
        run.run_while(lambda: bool(outside.links))
        assert "/orders" not in run.mission.ros.switchboard.master.registry.publishers()


def test_a_service_of_a_client(tmp_path: Path) -> None:
    with bridged(tmp_path, {"CALLER": CALLER}) as run:
        asker, server = run.client(), run.client()
        asker.send(op="subscribe", topic="/told", type="std_msgs/String")
        server.send(op="advertise_service", service="/mine", type=TRIGGER)
        assert server.call("/rosapi/service_node", "/mine") == {"node": "/rosbridge_websocket"}
        asker.send(op="publish", topic="/ask", msg={"data": "/mine"})
        request = server.next()
        assert (request["op"], request["service"], request["args"]) == ("call_service", "/mine", {})
        answer = {"op": "service_response", "service": "/mine", "id": request["id"], "result": True}
        server.send(**answer, values={"success": True, "message": "here"})
        assert asker.next()["msg"] == {"data": "answer: here"}
        server.send(**answer, values={"success": True, "message": "twice"})
        assert "unexpected answer" in server.next()["msg"]

        asker.send(op="publish", topic="/ask", msg={"data": "/mine"})
        server.send(**{**answer, "id": server.next()["id"]}, values={"success": "yes"})
        assert "requires a bool" in server.next()["msg"]
        assert "requires a bool" in asker.next()["msg"]["data"]

        asker.send(op="call_service", service="/mine", id="between clients")
        server.send(**{**answer, "id": server.next()["id"]}, values={"success": False})
        assert asker.next()["values"] == {"success": False, "message": ""}

        asker.send(op="publish", topic="/ask", msg={"data": "/mine"})
        server.next()
        server.close()
        assert "the service has ended" in asker.next()["msg"]["data"]
        assert asker.call("/mine")["values"] == "Service /mine does not exist"
        asker.close()


def test_disconnected_caller_is_forgotten(tmp_path: Path) -> None:
    with bridged(tmp_path, {"CALLER": CALLER}) as run:
        asker, server = run.client(), run.client()
        server.send(op="advertise_service", service="/mine", type=TRIGGER)
        server.call("/rosapi/nodes")
        asker.send(op="call_service", service="/mine")
        request = server.next()
        asker.close()
        run.run_while(lambda: len(run.server._listener.clients) > 1)
        values = {"success": True, "message": "too late"}
        server.send(op="service_response", service="/mine", id=request["id"], values=values, result=True)
        assert server.call("/rosapi/get_param", "/none") == {"value": "null"}
        server.close()


def test_long_messages_in_pieces(tmp_path: Path) -> None:
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        client = run.client()
        client.send(op="subscribe", topic="/chatter", fragment_size=40)
        found = [client.next() for _ in range(2)]
        assert [each["num"] for each in found] == [0, 1]
        assert "".join(each["data"] for each in found).endswith('{"data": "first"}}')
        client.close()


def test_reset_of_the_processor_keeps_clients_connected(tmp_path: Path) -> None:
    with bridged(tmp_path, {"TALKER": TALKER, "SERVER": SERVER}) as run:
        client = run.client()
        client.send(op="subscribe", topic="/chatter")
        client.next()
        client.send(op="advertise", topic="/orders", type="std_msgs/String")
        client.send(op="advertise_service", service="/mine", type=TRIGGER)
        assert client.call("/switch", True)["success"]
        former = run.mission.processor
        run.mission.cfe.psp.restart(1)
        run.run_while(lambda: run.mission.processor is former or run.mission.processor.booted is None)
        assert client.next()["msg"] == {"data": "first"}, "of the node that was started again"
        client.send(op="publish", topic="/orders", msg={"data": "again"})
        assert client.next()["msg"] == {"data": "AGAIN"}
        client.send(op="call_service", service="/mine", id="own")
        request = client.next()
        client.send(op="service_response", service="/mine", id=request["id"], values={"success": True}, result=True)
        assert client.next()["result"] is True
        client.close()
