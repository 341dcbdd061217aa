"""`python roslibpy_client.py URL`: a roslibpy program uses the robot of these tests, and prints its results as JSON.

It is a separate process, because roslibpy's reactor can be started only once in a process.
"""

from __future__ import annotations

import json
import queue
import sys
from typing import Any

import roslibpy
from roslibpy.ros1 import actionlib

PATIENCE_S = 30


def main(url: str) -> None:
    """Do it."""
    client = roslibpy.Ros(url)
    client.run(PATIENCE_S)
    found: dict[str, Any] = {}
    servers = roslibpy.Service(client, "/rosapi/action_servers", "rosapi/GetActionServers")
    while "/fibonacci" not in servers.call(roslibpy.ServiceRequest(), timeout=PATIENCE_S)["action_servers"]:
        pass  # the robot has not started yet
    found["is there"] = "/robot" in client.get_nodes()
    found["type"] = client.get_topic_type("/chatter")
    found["types"] = client.get_topics_for_type("std_msgs/Float64MultiArray")
    found["services"] = client.get_services_for_type("std_srvs/SetBool")
    found["fields"] = client.get_message_details("std_msgs/Header")["typedefs"][0]["fieldnames"]
    found["speed"] = client.get_param("/speed")
    client.set_param("/made", {"a": [1, 2.5, "x"]})
    found["made"] = client.get_param("/made")
    client.delete_param("/made")
    found["deleted"] = client.get_param("/made")
    found["chatter"] = _chatter(client)
    found["octets"] = _next(roslibpy.Topic(client, "/octets", "std_msgs/UInt8MultiArray"))["data"]
    found["numbers"] = _next(roslibpy.Topic(client, "/numbers", "std_msgs/Float64MultiArray"))["data"]
    switch = roslibpy.Service(client, "/switch", "std_srvs/SetBool")
    found["switch"] = dict(switch.call(roslibpy.ServiceRequest({"data": True}), timeout=PATIENCE_S))
    try:
        switch.call(roslibpy.ServiceRequest({"data": False}), timeout=PATIENCE_S)
    except Exception as error:  # its class is another one in each version
        found["off"] = str(error)
    found["told"] = _serve(client)
    found["fibonacci"], found["feedback"] = _act(client)
    client.terminate()
    print(json.dumps(found))


def _next(topic: roslibpy.Topic) -> Any:
    came: queue.Queue[Any] = queue.Queue()
    topic.subscribe(came.put)
    found = came.get(timeout=PATIENCE_S)
    topic.unsubscribe()
    return found


def _chatter(client: roslibpy.Ros) -> list[str]:
    came: queue.Queue[Any] = queue.Queue()
    chatter = roslibpy.Topic(client, "/chatter", "std_msgs/String")
    chatter.subscribe(came.put)
    found = [came.get(timeout=PATIENCE_S)["data"]]
    orders = roslibpy.Topic(client, "/orders", "std_msgs/String")
    orders.advertise()
    for each in ("one", "two"):
        orders.publish(roslibpy.Message({"data": each}))
        found.append(came.get(timeout=PATIENCE_S)["data"])
    orders.unadvertise()
    chatter.unsubscribe()
    return found


def _serve(client: roslibpy.Ros) -> str:
    def answer(request: Any, response: Any) -> bool:
        response["success"] = True
        response["message"] = "hello"
        return True

    service = roslibpy.Service(client, "/by_client", "std_srvs/Trigger")
    service.advertise(answer)
    came: queue.Queue[Any] = queue.Queue()
    told = roslibpy.Topic(client, "/told", "std_msgs/String")
    told.subscribe(came.put)
    ask = roslibpy.Topic(client, "/ask", "std_msgs/String")
    ask.publish(roslibpy.Message({"data": "now"}))
    found: str = came.get(timeout=PATIENCE_S)["data"]
    service.unadvertise()
    return found


def _act(client: roslibpy.Ros) -> tuple[list[int], int]:
    actions = actionlib.ActionClient(client, "/fibonacci", "actionlib_tutorials/FibonacciAction")
    goal = actionlib.Goal(actions, roslibpy.Message({"order": 5}))
    feedback: list[Any] = []
    goal.on("feedback", feedback.append)
    goal.send()
    result: Any = goal.wait(PATIENCE_S)
    actions.dispose()
    return result["sequence"], len(feedback)


if __name__ == "__main__":
    main(sys.argv[1])
