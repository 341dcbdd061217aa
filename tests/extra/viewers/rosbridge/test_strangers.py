"""Which clients may connect, and the answers to misbehaving ones; the mission and the other clients continue."""

from __future__ import annotations

import hashlib
import json
import selectors
import socket
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.extra.viewers import websocket_listener as listener_module
from cfepy.extra.viewers.listen import Admission, ListenPlace
from cfepy.extra.viewers.rosbridge import bridge_node
from cfepy.extra.viewers.rosbridge import rosbridge_client as client_module
from cfepy.extra.viewers.rosbridge.rosauth import MacCheck
from cfepy.extra.viewers.rosbridge.server import RosbridgeServer
from cfepy.io import PeerCounts
from cfepy.status import UsageError
from tests.extra.ros_host.peers import TALKER
from tests.extra.viewers.rosbridge.bridged import LOOPBACK, Bridged, bridged

TOKEN = "right-token"
NOW_S = 1_000_000
PROBLEMS: list[tuple[Any, str]] = [
    ("{", "Unable to deserialize message from client: {"),
    ("", "Unable to deserialize message from client: "),
    ("[" * 100_000, "Unable to deserialize message from client: [[["),
    ("1" * 5_000, "Unable to deserialize message from client: 111"),
    ("[]", "a message must be a JSON object, not list"),
    ("3", "a message must be a JSON object, not int"),
    (b"\x05\0\0\0\0", "binary messages (BSON) are not supported"),
    ({}, "Received a message without an op."),
    ({"op": None}, "Unknown operation: None.  Allowed operations: ['call_service', "),
    ({"op": ["subscribe"]}, "Unknown operation: ['subscribe']."),
    ({"op": "fly"}, "Unknown operation: fly."),
    ({"op": "subscribe"}, "subscribe: Expected a topic field but none was found."),
    ({"op": "subscribe", "topic": 3}, "subscribe: Expected field topic to be one of ('str',). Invalid value: 3"),
    ({"op": "subscribe", "topic": "", "type": "std_msgs/String"}, "subscribe: '' is not a legal name"),
    ({"op": "subscribe", "topic": "a b", "type": "std_msgs/String"}, "subscribe: 'a b' is not a legal name"),
    ({"op": "subscribe", "topic": "/x", "type": "String"}, "subscribe: String is not a valid type string"),
    ({"op": "subscribe", "topic": "/x", "type": "no/Such"}, "subscribe: Unable to load the manifest for package no"),
    ({"op": "subscribe", "topic": "/x", "type": "std_msgs/No"}, "subscribe: Unable to import msg class No from"),
    ({"op": "subscribe", "topic": "/x"}, "subscribe: Cannot infer topic type for topic /x as it is not yet adv"),
    ({"op": "subscribe", "topic": "/chatter", "type": "std_msgs/Int8"}, "subscribe: Tried to register topic /chatter"),
    ({"op": "subscribe", "topic": "/chatter", "throttle_rate": "1"}, "subscribe: Expected field throttle_rate to be"),
    ({"op": "subscribe", "topic": "/chatter", "queue_length": True}, "subscribe: Expected field queue_length to be"),
    ({"op": "unsubscribe"}, "unsubscribe: Expected a topic field"),
    ({"op": "advertise", "topic": "/x"}, "advertise: Expected a type field"),
    ({"op": "advertise", "topic": "/chatter", "type": "std_msgs/Int8"}, "advertise: Tried to register topic /chatter"),
    ({"op": "unadvertise"}, "unadvertise: Expected a topic field"),
    ({"op": "publish", "topic": "/x", "msg": {}}, "publish: Cannot infer topic type for topic /x"),
    ({"op": "publish", "topic": "/orders", "msg": {"data": 3}}, "publish: std_msgs/String message requires a string"),
    ({"op": "publish", "topic": "/orders", "msg": {"x": 3}}, "publish: Message type std_msgs/String does not have a"),
    ({"op": "publish", "topic": "/orders", "msg": 3}, "publish: Expected a JSON object for type std_msgs/String but"),
    ({"op": "call_service"}, "call_service: Expected a service field"),
    ({"op": "advertise_service", "service": "/x"}, "advertise_service: Expected a type field"),
    ({"op": "advertise_service", "service": "/x", "type": "no/Such"}, "advertise_service: Unable to load the manifest"),
    (
        {"op": "advertise_service", "service": "/talker/get_loggers", "type": "std_srvs/Empty"},
        "advertise_service: service /talker/get_loggers is already offered by the mission",
    ),
    ({"op": "unadvertise_service", "service": "/x"}, "unadvertise_service: Service /x has not been advertised via"),
    ({"op": "service_response", "service": "/x"}, "service_response: Expected a result field"),
    ({"op": "service_response", "service": "/x", "result": True}, "service_response: Service /x has not been adverti"),
    ({"op": "fragment"}, "fragment: received invalid fragment!"),
    (
        {"op": "fragment", "id": 1, "num": 2, "total": 2, "data": ""},
        "fragment: error while trying to append fragment 2",
    ),
    (
        {"op": "fragment", "id": 1, "num": 0, "total": 10**9, "data": ""},
        "fragment: too many fragments: a message of 1000000000",
    ),
    ({"op": "set_level"}, "set_level: Expected field level to be one of"),
    ({"op": "set_level", "level": "loud"}, "set_level: Expected field level to be one of"),
]


@pytest.fixture(scope="module")
def talker(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bridged]:
    with bridged(tmp_path_factory.mktemp("talker"), {"TALKER": TALKER}) as run:
        yield run


def test_problem_of_a_message_is_reported_and_the_connection_stays(talker: Bridged) -> None:
    client = talker.client()
    for sent, said in PROBLEMS:
        named = sent.get("op") in client_ops() if isinstance(sent, dict) and isinstance(sent.get("op"), str) else False
        if isinstance(sent, bytes):
            client.binary(sent)
        else:
            client.text(
                json.dumps({**sent, "id": "x"} if named and "id" not in sent else sent)
                if isinstance(sent, dict)
                else sent
            )
        answer = client.next()
        assert (answer["op"], answer["level"]) == ("status", "error"), sent
        assert answer["msg"].startswith(said), answer
        if named and "id" not in sent:
            assert answer["id"] == "x"
    assert client.call("/rosapi/get_param", "/none") == {"value": "null"}
    client.close()


def client_ops() -> set[str]:
    return {sent["op"] for sent, _ in PROBLEMS if isinstance(sent, dict) and isinstance(sent.get("op"), str)}


def test_statuses_are_sent_from_the_requested_level_on(talker: Bridged) -> None:
    client = talker.client()
    client.send(op="set_level", level="none")
    client.send(op="nonsense")
    client.send(op="set_level", level="info")
    client.send(op="unsubscribe", topic="/chatter")
    client.send(op="subscribe", topic="/orders")
    assert client.next() == {"op": "status", "level": "info", "msg": "Subscribed to /orders"}
    client.close()


BAD_BYTES = {
    "no HTTP": b"\x16\x03\x01\x02\0\x01\0\x01\xfc\x03\x03\r\n" * 10,
    "another method": b"POST / HTTP/1.1\r\nHost: x\r\n\r\n",
    "no upgrade": b"GET / HTTP/1.1\r\nHost: x\r\n\r\n",
    "a long line": b"GET /" + b"x" * 100_000,
    "many headers": b"GET / HTTP/1.1\r\n" + b"a: b\r\n" * 10_000,
}


@pytest.mark.parametrize("data", BAD_BYTES.values(), ids=list(BAD_BYTES))
def test_malformed_request_ends_the_connection(talker: Bridged, data: bytes) -> None:
    stranger = socket.create_connection((LOOPBACK, talker.port))
    stranger.setblocking(False)
    over = _sent_until_over(talker, stranger, data)
    assert over == b"" or over.startswith(b"HTTP/1.1 4")
    stranger.close()
    _still_served(talker)


BAD_FRAMES = {
    "without mask": (b"\x81\x02{}", 1002),
    "reserved bits": (b"\xf1\x80\0\0\0\0", 1002),
    "an unknown opcode": (b"\x83\x80\0\0\0\0", 1002),
    "a rest without beginning": (b"\x80\x80\0\0\0\0", 1002),
    "a long ping": (b"\x89\xfe\x01\0\0\0\0\0" + b"x" * 256, 1002),
    "too large": (b"\x81\xff\0\0\0\x7f\xff\xff\xff\xff\0\0\0\0", 1009),
    "no UTF-8": (b"\x81\x82\0\0\0\0\xff\xff", 1007),
    "endless pieces": (b"\x01\x80\0\0\0\0" + b"\0\x80\0\0\0\0" * 20_000, 1009),
}


@pytest.mark.parametrize(("data", "code"), BAD_FRAMES.values(), ids=list(BAD_FRAMES))
def test_malformed_frame_ends_the_connection(talker: Bridged, data: bytes, code: int) -> None:
    client = talker.client()
    client.socket.setblocking(True)
    client.socket.sendall(data)
    client.socket.setblocking(False)
    assert client.ended() == code
    client.close()
    _still_served(talker)


def _sent_until_over(run: Bridged, stranger: socket.socket, data: bytes) -> bytes:
    """Return the server's answer before it ends the connection."""
    found, rest, is_over = b"", data, False
    while not is_over:
        try:
            rest = rest[stranger.send(rest) :] if rest else rest
            came = stranger.recv(1 << 16)
            found, is_over = found + came, not came
        except BlockingIOError:
            run.step()
        except ConnectionError:
            is_over = True
    return found


def _still_served(run: Bridged) -> None:
    client = run.client()
    client.send(op="subscribe", topic="/chatter")
    assert client.next()["msg"] == {"data": "first"}
    client.close()


def test_client_that_left_before_it_was_accepted_is_ignored(talker: Bridged) -> None:
    for _ in range(20):
        stranger = socket.create_connection((LOOPBACK, talker.port))
        stranger.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # it is reset, not closed
        stranger.close()
    _still_served(talker)


def test_messages_beyond_the_limit_of_an_exchange_are_dropped_and_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bridge_node, "MOST_WAITING", 10)
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        client = run.client()
        client.send(op="subscribe", topic="/chatter")
        client.next()
        client.send(op="publish", topic="/orders", msg={"data": "longer than that"})
        client.send(op="publish", topic="/orders", msg={"data": "ok"})
        assert client.next()["msg"] == {"data": "OK"}
        rows = {(row["name"], row["peer"], row["direction"]): row for row in run.counts.rows()}
        assert rows["/chatter", "rosbridge", "out"]["dropped"] == 1
        client.close()


# -- connections -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("origin", ["https://example.org", "null", "http://localhost.example.org:8000"])
def test_page_of_another_origin_is_refused(talker: Bridged, origin: str) -> None:
    client = talker.client(headers={"Origin": origin})
    assert client.refused is not None
    assert client.refused[0] == 403
    assert f"pages of {origin} are not permitted" in client.refused[1]
    client.close()
    _still_served(talker)


def test_page_of_this_computer_is_accepted(talker: Bridged) -> None:
    client = talker.client(headers={"Origin": "http://localhost:3000"})
    assert client.is_open
    client.close()


@pytest.fixture(scope="module")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bridged]:
    with bridged(tmp_path_factory.mktemp("guarded"), {"TALKER": TALKER}, admission=Admission(TOKEN)) as run:
        yield run


@pytest.mark.parametrize("path", ["/", "/?token=wrong-token", "/?token="])
def test_without_the_token_the_first_op_ends_the_connection(guarded: Bridged, path: str) -> None:
    client = guarded.client(path)
    client.send(op="publish", topic="/orders", msg={"data": "go"})
    assert client.ended() == 1008
    client.close()
    assert "/orders" not in {row["name"] for row in guarded.counts.rows()}


@pytest.mark.parametrize(
    ("path", "headers"),
    [
        (f"/?token={TOKEN}", {}),
        (f"/?x=y&token={TOKEN}", {"Origin": "https://example.org"}),
        ("/", {"Authorization": f"Bearer {TOKEN}"}),
    ],
)
def test_client_with_the_token_is_accepted(guarded: Bridged, path: str, headers: dict[str, str]) -> None:
    client = guarded.client(path, headers)
    assert "/talker" in client.call("/rosapi/nodes")["nodes"]
    client.close()


def _auth(token: str = TOKEN, t: int = NOW_S, end: int = NOW_S + 60, **changed: Any) -> dict[str, Any]:
    op = {"op": "auth", "client": "c", "dest": "d", "rand": "r", "t": t, "level": "admin", "end": end}
    text = f"{token}cdr{t}admin{end}"
    return {**op, "mac": hashlib.sha512(text.encode()).hexdigest(), **changed}


def test_auth_is_checked_as_by_rosauth(guarded: Bridged, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(client_module.time, "time", lambda: NOW_S)
    client = guarded.client()
    client.send(**_auth())
    assert "/talker" in client.call("/rosapi/nodes")["nodes"]
    again = guarded.client()
    again.send(**_auth())
    assert again.ended() == 1008, "what somebody has overheard is of no use"
    for each in (client, again):
        each.close()


@pytest.mark.parametrize(
    "op",
    [
        _auth("wrong-token"),
        _auth(t=NOW_S - 60),
        _auth(end=NOW_S - 1),
        _auth(level="higher"),
        _auth(mac=3),
        _auth(mac="caf\u00e9\ud800"),
        _auth(t="now"),
        {"op": "auth"},
    ],
)
def test_wrong_auth_is_refused(op: dict[str, Any]) -> None:
    assert not MacCheck(TOKEN).admits(op, NOW_S)


def test_auth_is_not_needed_without_a_token(talker: Bridged) -> None:
    client = talker.client()
    client.send(op="auth", mac="", client="", dest="", rand="", t=0, level="", end=0)
    assert client.call("/rosapi/get_param", "/none") == {"value": "null"}
    client.close()


def test_number_of_clients_is_limited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listener_module, "MOST_CLIENTS", 2)
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        clients = [run.client() for _ in range(3)]
        assert [each.is_open for each in clients] == [True, True, False]
        clients[0].close()
        run.run_while(lambda: not run.client().is_open)
        rows = {(row["name"], row["direction"]): row for row in run.counts.rows()}
        assert rows["(connections)", "in"]["why"]
        for each in clients:
            each.close()


def test_client_without_a_request_is_disconnected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        stranger = socket.create_connection((LOOPBACK, run.port))
        stranger.setblocking(False)
        stranger.sendall(b"GET / HTTP/1.1\r\n")
        for _ in range(20):
            run.step()
        monkeypatch.setattr(listener_module, "HANDSHAKE_S", 0.0)
        assert _sent_until_over(run, stranger, b"") == b""
        stranger.close()


# -- too much, and too slow --------------------------------------------------------------------------------------------


def test_a_message_waits_until_the_mission_has_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    full = [True]
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        node = run.server._node
        monkeypatch.setattr(node, "has_room", lambda topic, payload: not full[0])
        monkeypatch.setattr(client_module, "MOST_PATIENCE_S", 1e9)
        client = run.client()
        client.send(op="subscribe", topic="/chatter")
        client.next()
        for number in range(3):
            client.send(op="publish", topic="/orders", msg={"data": f"m{number}"})
        client.send(op="call_service", service="/rosapi/get_time", id="last")
        for _ in range(20):
            run.step()
        assert not client.look(), "what comes behind it waits, too"
        full[0] = False
        found = [client.next() for _ in range(4)]
        assert [each["msg"]["data"] for each in found if each["op"] == "publish"] == ["M0", "M1", "M2"]
        full[0] = True
        monkeypatch.setattr(client_module, "MOST_PATIENCE_S", 0.0)
        client.send(op="publish", topic="/orders", msg={"data": "late"})
        assert client.next()["msg"] == {"data": "LATE"}, "after its patience it enters, or is lost and counted"
        client.close()


def test_flood_does_not_delay_the_run(talker: Bridged, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listener_module, "MOST_MESSAGES", 10)
    client = talker.client()
    for _ in range(100):
        client.text("nonsense")
    steps = []
    while len(client.look()) < 100:
        before = _received(talker)
        talker.server.exchange()
        steps.append(_received(talker) - before)
    assert max(steps) == 10
    client.close()


def _received(run: Bridged) -> int:
    return next(
        row["messages"] for row in run.counts.rows() if (row["name"], row["direction"]) == ("(connections)", "in")
    )


@pytest.mark.slow
def test_slow_client_loses_only_its_own_messages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from cfepy.io import peer_socket

    monkeypatch.setattr(peer_socket, "MOST_WAITING", 3)
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        slow, quick = run.client(), run.client()
        for each in (slow, quick):
            each.send(op="subscribe", topic="/chatter")
        quick.next()
        for number in range(150):  # 15 MB: more than sockets hold
            quick.send(op="publish", topic="/orders", msg={"data": f"{number}:" + "x" * 100_000})
            assert quick.next()["msg"]["data"].startswith(f"{number}:")
        slow.close()
        run.run_while(lambda: len(run.server._listener.clients) > 1)
        rows = {(row["name"], row["direction"]): row for row in run.counts.rows()}
        assert rows["(connections)", "out"]["dropped"] > 0
        assert rows["/orders", "in"]["dropped"] == 0
        quick.close()


@pytest.mark.slow
def test_burst_is_delayed_without_loss(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Far more than a pipe holds, at once."""
    monkeypatch.setattr(client_module, "MOST_PATIENCE_S", 1e9)
    count = 2_000
    with bridged(tmp_path, {"TALKER": TALKER}) as run:
        client = run.client()
        client.send(op="subscribe", topic="/chatter")
        client.next()
        for number in range(count):
            client.send(op="publish", topic="/orders", msg={"data": f"m{number}"})
        assert [client.next()["msg"]["data"] for _ in range(count)] == [f"M{number}" for number in range(count)]
        rows = {(row["name"], row["direction"]): row for row in run.counts.rows()}
        assert (rows["/orders", "in"]["messages"], rows["/orders", "in"]["dropped"]) == (count, 0)
        client.close()


def test_system_without_epoll_and_kqueue_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listener_module, "DefaultSelector", selectors.SelectSelector)
    with pytest.raises(UsageError, match="--rosbridge: requires epoll or kqueue"):
        RosbridgeServer(ListenPlace(LOOPBACK, 0), Admission(), PeerCounts())
