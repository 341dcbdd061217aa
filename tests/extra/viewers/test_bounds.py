"""Limits of viewers' servers: for all clients together, and for one message."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.extra.viewers import bounded_json, websocket_listener
from cfepy.extra.viewers.foxglove.protocol import FrameError, ops_of
from cfepy.extra.viewers.rosbridge import rosbridge_client as client_module
from rospy_shim.graph import outside as outside_module
from tests.extra.ros_host.peers import TALKER
from tests.extra.viewers.foxglove.runs import TALKER as SHOWN_TALKER
from tests.extra.viewers.foxglove.runs import shown, spec_of
from tests.extra.viewers.rosbridge.bridged import LOOPBACK, Bridged, bridged


@pytest.fixture
def run(tmp_path: Path) -> Iterator[Bridged]:
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        yield run


def test_idle_connection_is_closed_when_places_are_needed(run: Bridged, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(websocket_listener, "MOST_CLIENTS", 4)
    left = [socket.create_connection((LOOPBACK, run.port)) for _ in range(20)]
    left[0].sendall(b"GET / HTTP/1.1\r\n")
    for _ in range(30):
        run.step()
    client = run.client()
    assert client.is_open
    assert client.call("/rosapi/get_param", "/none") == {"value": "null"}
    for each in left:
        each.close()
    client.close()


def test_idle_client_is_closed_before_an_active_one(run: Bridged, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(websocket_listener, "MOST_CLIENTS", 2)
    hears, idle = run.client(), run.client()
    hears.send(op="subscribe", topic="/chatter")
    hears.next()
    late = run.client()
    assert not late.is_open
    monkeypatch.setattr(websocket_listener, "IDLE_S", -1.0)
    new = run.client()
    assert new.is_open
    assert idle.ended() == 1013
    new.send(op="publish", topic="/orders", msg={"data": "on"})
    assert hears.next()["msg"] == {"data": "ON"}
    for each in (hears, idle, late, new):
        each.close()


def test_silent_clients_are_closed_when_places_are_few(run: Bridged, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(websocket_listener, "SILENCE_S", 0.0)
    monkeypatch.setattr(websocket_listener, "MOST_CLIENTS", 4)
    alive, other = run.client(), run.client()
    for _ in range(30):
        run.step()
        alive.look()
    monkeypatch.setattr(websocket_listener, "MOST_CLIENTS", 2)
    assert other.ended() == 1001
    other.close()
    alive.close()


def test_unfinished_messages_of_all_clients_are_bounded(run: Bridged, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run.server._listener._room, "_most", 1_000_000)
    good, bad = run.client(), [run.client() for _ in range(6)]
    good.send(op="fragment", id="1", num=0, total=2, data="x" * 1_000)
    for each in bad:
        head = b"\x81\xff" + (30 << 20).to_bytes(8, "big") + bytes(4)
        data = head + b"x" * 300_000
        while data:
            try:
                data = data[each.socket.send(data) :]
            except BlockingIOError:
                run.step()
            except ConnectionError:
                break
        run.step()
    for _ in range(20):
        run.step()
    assert run.server._listener._room.size <= 1_000_000
    assert len(run.server._listener.clients) < 7
    assert good.call("/rosapi/get_param", "/none") == {"value": "null"}
    for each in (good, *bad):
        each.close()


@pytest.mark.parametrize("data", ["", "x" * 10])
def test_pieces_without_an_end_count_as_unfinished(run: Bridged, monkeypatch: pytest.MonkeyPatch, data: str) -> None:
    client = run.client()
    for number in range(100):
        client.send(op="fragment", id="1", num=number, total=1_000, data=data)
    client.call("/rosapi/get_param", "/none")
    assert run.server._listener._room.size >= 100 * 150
    client.close()
    run.run_while(lambda: bool(run.server._listener._room.size))


EXCESSIVE_TEXTS = {
    "lists": "[" + "[]," * 250_000 + "[]]",
    "objects": '{"op":"x","a":[' + "{}," * 250_000 + "{}]}",
    "numbers": "[" + "1," * 2_000_001 + "1]",
    "deep": "[" * 100_000 + "]" * 100_000,
    "a long number": "9" * 10_000,
    "no JSON": "{",
}


@pytest.mark.parametrize("text", EXCESSIVE_TEXTS.values(), ids=list(EXCESSIVE_TEXTS))
def test_excessive_json_is_refused(run: Bridged, text: str) -> None:
    for each in (text, text.encode()):
        with pytest.raises(ValueError, match=r"more than|too deeply|Exceeds|Expecting"):
            bounded_json.loads(each)
    with pytest.raises(FrameError):
        ops_of(text)


TRICKS: dict[str, list[dict[str, Any]]] = {
    "an id that is a list": [{"op": "call_service", "service": "/rosapi/nodes", "id": [[[]]]}],
    "a long id": [{"op": "subscribe", "topic": "/chatter", "id": "x" * 2_000}],
    "a long name": [{"op": "advertise", "topic": "/" + "a" * 1_000_000, "type": "std_msgs/String"}],
    "a value that is no text": [{"op": "call_service", "service": "/rosapi/set_param", "args": ["/a", '"\\ud800"']}],
    "a control character": [{"op": "call_service", "service": "/rosapi/set_param", "args": ["/a", '"\\u0000"']}],
    "a deep value": [{"op": "call_service", "service": "/rosapi/set_param", "args": ["/a", "[" * 300 + "]" * 300]}],
    "a huge number": [{"op": "call_service", "service": "/rosapi/set_param", "args": ["/a", "9" * 4_000]}],
    "a deep name": [{"op": "call_service", "service": "/rosapi/set_param", "args": ["/a" * 400, "1"]}],
}


@pytest.mark.parametrize("ops", TRICKS.values(), ids=list(TRICKS))
def test_malicious_message_is_answered_with_an_error(run: Bridged, ops: list[dict[str, Any]]) -> None:
    client = run.client()
    for op in ops:
        client.send(**op)
        answer = client.next()
        assert answer.get("level") == "error" or answer.get("result") is False, answer
    assert client.call("/rosapi/get_param", "/a") == {"value": "null"}
    client.close()


def test_ids_and_spellings_of_a_topic_are_bounded(run: Bridged, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(client_module, "MOST_IDS", 5)
    monkeypatch.setattr(client_module, "MOST_SERVICES", 5)
    client = run.client()
    for number in range(7):
        client.send(op="advertise", topic="/new", type="std_msgs/String", id=str(number))
        client.send(op="subscribe", topic="/new2", type="std_msgs/String", id=str(number))
        client.send(op="subscribe", topic="/" * number + "/new3", type="std_msgs/String")
        client.send(op="advertise_service", service=f"/s{number}", type="std_srvs/SetBool")
    client.send(op="call_service", service="/rosapi/get_time")
    said = []
    while (answer := client.next())["op"] != "service_response":
        said.append(answer["msg"].partition(": ")[2])
    assert said.count("a client can advertise a topic under at most 5 ids") == 2
    assert said.count("a client can subscribe to a topic under at most 5 ids") == 2
    assert said.count("a client can offer at most 5 services") == 2
    client.close()


def test_names_from_outside_are_bounded(run: Bridged, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(outside_module, "ROS_NAMES", 3)
    client = run.client()
    for number in range(5):
        client.send(op="advertise", topic=f"/n{number}", type="std_msgs/String")
        client.send(op="unadvertise", topic=f"/n{number}")
    for _ in range(2):
        assert "the limit" in client.next()["msg"]
    client.close()


def test_expired_turn_leaves_the_remaining_messages_for_the_next(run: Bridged) -> None:
    turn, client = run.server._listener._turn, run.client()
    seconds, turn._seconds = turn._seconds, 0.0
    for _ in range(5):
        client.send(op="call_service", service="/rosapi/get_time")
    for _ in range(10):
        run.step()
    assert not client.look()
    turn._seconds = seconds
    assert [client.next()["op"] for _ in range(5)] == ["service_response"] * 5
    client.close()


ROWS = {
    "channels": {"op": "advertise", "channels": [{}] * 101},
    "parameters": {"op": "setParameters", "parameters": [{}] * 1_001},
    "subscriptions": {"op": "subscribe", "subscriptions": [{}] * 10_001},
    "names": {"op": "getParameters", "parameterNames": ["a" * 1_001]},
    "watched": {"op": "subscribeParameterUpdates", "parameterNames": ["a"] * 10_001},
    "numbers": {"op": "unsubscribe", "subscriptionIds": [1] * 100_000},
    "a topic": {
        "op": "advertise",
        "channels": [{"id": 1, "topic": "/" + "a" * 1_001, "schemaName": "std_msgs/String", "encoding": "ros1"}],
    },
}


@pytest.mark.parametrize("message", ROWS.values(), ids=list(ROWS))
def test_rows_of_a_message_are_bounded(message: dict[str, Any]) -> None:
    with pytest.raises(FrameError, match=r"the limit is|more than 1,000 characters"):
        ops_of(json.dumps(message))


COMMANDS = [
    b"[]",
    b"{",
    b'{"App": 3}',
    b'{"Application": [[]]}',
    b'{"Application": {"a": null}}',
    b"null",
    b"9" * 9_000,
]


def test_invalid_command_is_dropped_and_the_viewer_stays_connected(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {"talker": SHOWN_TALKER})) as run, run.client() as client:
        client.advertise(1, "/cfe/CFE_ES_STOP_APP", "x", "json")
        for each in COMMANDS:
            client.publish(1, each)
        client.wait_for(lambda: len(client.told("status")) >= len(COMMANDS))
        client.publish(2, b"")
        client.wait_for(lambda: len(client.told("status")) >= len(COMMANDS))
        assert run.viewer._server.viewers
