"""Clients of rosbridge publish, hear, call and serve."""

from __future__ import annotations

from pathlib import Path

from tests.ros_host.peers import SERVER, TALKER
from tests.viewers.rosbridge.bridged import bridged


def test_messages_both_ways(tmp_path: Path) -> None:
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        client = run.client()
        client.send(op="subscribe", topic="/chatter", type="std_msgs/String")
        assert client.next() == {"op": "publish", "topic": "/chatter", "msg": {"data": "first"}}
        client.send(op="advertise", topic="/orders", type="std_msgs/String")
        client.send(op="publish", topic="/orders", msg={"data": "one"})
        assert client.next()["msg"] == {"data": "ONE"}
        client.close()


def test_a_service_of_the_mission(tmp_path: Path) -> None:
    with bridged(tmp_path, {"SERVER": SERVER}) as run:
        client = run.client()
        assert client.call("/switch", data=True) == {"success": True, "message": "by /rosbridge_websocket"}
        print(client.call("/switch", False))
        print(client.call("/rosapi/topics"))
        print(client.call("/rosapi/nodes"))
        print(client.call("/rosapi/services"))
        print(client.call("/rosapi/message_details", "std_msgs/Header"))
        print(client.call("/nothing"))
        client.close()
