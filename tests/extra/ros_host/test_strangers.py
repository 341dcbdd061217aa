"""Unwanted clients of a mission with a ROS master: pages in browsers, and clients that send too much."""

from __future__ import annotations

import socket
import struct
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any
from xmlrpc.client import Fault, dumps, loads

import pytest

from cfepy.extra.ros_host import errands as errands_module
from cfepy.extra.ros_host.errands import Errands, RosError, ask
from cfepy.extra.ros_host.rpc_body import RpcError, read_body
from cfepy.extra.ros_host.tcpros import pack_header
from cfepy.io import OwnNames, own_names, peer_places
from cfepy.reading import input_limits
from cfepy.status import UsageError
from tests.extra.ros_host.peers import CALLER, SERVER, SET_BOOL, TALKER, Joined, OutsideSpeaker, joined, text

NOBODY = "http://127.0.0.1:1/"


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Joined]:
    with joined(tmp_path_factory.mktemp("strangers"), {"TALKER": TALKER, "SERVER": SERVER}) as run:
        run.run_while(lambda: "/switch" not in run.mission.ros.graph.services)
        run.host.see()
        yield run


def port_of(uri: str) -> int:
    return int(uri.rstrip("/").rpartition(":")[2])


def opened(run: Joined, uri: str = "") -> socket.socket:
    stranger = socket.create_connection(("127.0.0.1", port_of(uri or run.host.world.uri)))
    stranger.setblocking(False)
    return stranger


def exchanged(run: Joined, data: bytes, uri: str = "", ends: bool = True) -> bytes:
    """Return the answer until the connection ends, or until it is complete."""
    stranger, found, is_over = opened(run, uri), b"", False
    while not is_over and b"413 Content" not in found and (ends or b"</methodResponse>" not in found):
        try:
            data = data[stranger.send(data) :] if data else data
            came = stranger.recv(1 << 16)
            found, is_over = found + came, not came
        except BlockingIOError:
            run.host.exchange()
        except ConnectionError:
            is_over = True
    stranger.close()
    return found


def request(method: str, *arguments: Any, without: str = "", **fields: str) -> bytes:
    body = dumps(arguments, method).encode()
    known = {"Host": "127.0.0.1", "Content-Type": "text/xml", "Content-Length": str(len(body)), "Connection": "close"}
    known |= {name.replace("_", "-"): value for name, value in fields.items()}
    known.pop(without, None)
    return "\r\n".join(["POST /RPC2 HTTP/1.1", *map(": ".join, known.items()), "", ""]).encode() + body


def is_served(run: Joined) -> bool:
    return loads(exchanged(run, request("getPid", "/x")).partition(b"\r\n\r\n")[2])[0][0][0] == 1


PAGES = {
    "a page of another site": {"Origin": "https://evil.example", "Content_Type": "text/plain"},
    "a page with the right type": {"Origin": "https://evil.example"},
    "a page of this computer": {"Origin": "http://localhost:3000"},
    "a page of this very server": {"Origin": "http://127.0.0.1:11311"},
    "a file": {"Origin": "null"},
    "an extension": {"Origin": "chrome-extension://abcdefghijklmnop"},
    "an empty origin": {"Origin": ""},
    "a fetch without an origin": {"Sec_Fetch_Site": "cross-site"},
    "another name for this address": {"Host": "evil.example:11311"},
    "another name that ends like one": {"Host": "localhost.evil.example"},
    "another name that begins like one": {"Host": "127.0.0.1.nip.io:11311"},
    "an address that is none": {"Host": "127.0.0.999"},
    "an address of another computer": {"Host": "192.0.2.7:11311"},
    "a user": {"Host": "localhost@evil.example"},
    "no host": {"without": "Host"},
    "an empty host": {"Host": ""},
    "a form": {"Content_Type": "application/x-www-form-urlencoded"},
    "a form with files": {"Content_Type": "multipart/form-data; boundary=x"},
    "plain text": {"Content_Type": "text/plain;charset=UTF-8"},
    "another type": {"Content_Type": "text/xmlish"},
    "no type": {"without": "Content-Type"},
}


@pytest.mark.parametrize("fields", PAGES.values(), ids=list(PAGES))
def test_requests_of_web_pages_are_refused_by_master_and_nodes(run: Joined, fields: dict[str, str]) -> None:
    node = run.host.node_uri("/talker")
    for uri in (run.host.world.uri, node):
        found = exchanged(run, request("setParam", "/page", "/pwned", 1, **fields), uri)
        assert found.startswith(b"HTTP/1.1 4"), found
    assert run.mission.ros.graph.params.find("/pwned") is type(run.mission.ros.graph.params).MISSING
    assert is_served(run)


@pytest.mark.parametrize(
    "fields",
    [
        {},
        {"Host": "localhost:11311"},
        {"Host": "LOCALHOST."},
        {"Host": "127.0.1.1:11311"},
        {"Host": "[::1]:11311"},
        {"Host": socket.gethostname()},
        {"Content_Type": "text/xml; charset=utf-8"},
        {"Content_Type": "Text/XML"},
    ],
    ids=str,
)
def test_clients_of_ros_are_served(run: Joined, fields: dict[str, str]) -> None:
    assert b"200 OK" in exchanged(run, request("getPid", "/x", **fields))


def test_own_names_include_names_of_ros_and_of_the_computer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    hosts = tmp_path / "hosts"
    hosts.write_text(
        "127.0.0.1 localhost\n0.0.0.0 ads.example  # none\n127.0.1.1 robot.lab.example robot arm\n", encoding="utf-8"
    )
    monkeypatch.setattr(own_names, "HOSTS", hosts)
    monkeypatch.setattr(own_names.socket, "gethostname", lambda: "robot")
    names = OwnNames(["Base.Lab.example", "10.0.0.5"])
    for good in ("robot", "ROBOT:11311", "robot.local", "robot.lab.example", "arm", "base.lab.example:1", "10.0.0.5"):
        assert names.has(good, "192.0.2.1"), good
    assert names.has("192.0.2.1:11311", "192.0.2.1")
    for bad in (
        "ads.example",
        "local",
        "robot.evil.example",
        "10.0.0.6",
        "",
        ":11311",
        "a b",
        "robot/x",
        "127.0.0.256",
    ):
        assert not names.has(bad, "192.0.2.1"), bad
    monkeypatch.setattr(own_names, "HOSTS", tmp_path / "none")
    assert not OwnNames().has("arm", "")


BODY = dumps(("/x",), "getPid").encode()
HEAD = "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/xml\r\n"
BAD_REQUESTS = {
    "no HTTP": b"\x16\x03\x01\x02\0\x01\0\x01\xfc\x03\x03\r\n\r\n",
    "one word": b"GARBAGE\r\n\r\n",
    "an older version": b"POST / HTTP/0.9\r\n\r\n",
    "another method": b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n",
    "a question of a browser": b"OPTIONS / HTTP/1.1\r\nHost: localhost\r\nOrigin: https://x.example\r\n\r\n",
    "a long head": b"POST / HTTP/1.1\r\n" + b"a: b\r\n" * 5_000,
    "a head without an end": b"x" * 100_000,
    "no length": f"{HEAD}\r\n".encode() + BODY,
    "a negative length": f"{HEAD}Content-Length: -1\r\n\r\n".encode(),
    "a long length": f"{HEAD}Content-Length: {'9' * 5000}\r\n\r\n".encode(),
    "a large body": f"{HEAD}Content-Length: {input_limits.RPC_BYTES + 1}\r\n\r\n".encode(),
    "two lengths": f"{HEAD}Content-Length: 1\r\nContent-Length: {len(BODY)}\r\n\r\n".encode() + BODY,
    "chunks": f"{HEAD}Transfer-Encoding: chunked\r\nContent-Length: {len(BODY)}\r\n\r\n".encode() + BODY,
    "two hosts": b"POST / HTTP/1.1\r\nHost: evil.example\r\nHost: localhost\r\n\r\n",
}


@pytest.mark.parametrize("data", BAD_REQUESTS.values(), ids=list(BAD_REQUESTS))
def test_malformed_request_is_refused_before_its_body_is_read(run: Joined, data: bytes) -> None:
    found = exchanged(run, data)
    assert found == b"" or found.startswith((b"HTTP/1.1 4", b"HTTP/1.1 501")), found[:100]
    assert is_served(run)


def nested(count: int, end: str = "<i4>1</i4>") -> str:
    value = "<array><data><value>" * count + end + "</value></data></array>" * count
    return f"<methodCall><methodName>setParam</methodName><params>{TWO}<param><value>{value}</value></param></params>"


TWO = "<param><value>/x</value></param><param><value>/deep</value></param>"
LAUGHS = "<!DOCTYPE m [" + "".join(f'<!ENTITY a{n} "{f"&a{n - 1};" * 10 if n else "ha" * 100}">' for n in range(10))
BAD_BODIES = {
    "nothing": b"",
    "no XML": b"\0\1\2",
    "cut off": BODY[:-5],
    "other XML": b"<a><b/></a>",
    "no number": b"<methodCall><methodName>a</methodName><params><param><value><i4>x</i4></value></param></params>"
    b"</methodCall>",
    "a large number": b"<methodCall><methodName>a</methodName><params><param><value><i4>" + b"9" * 9_000 + b"</i4>"
    b"</value></param></params></methodCall>",
    "no base 64": b"<methodCall><methodName>a</methodName><params><param><value><base64>\xc3\xa4</base64></value>"
    b"</param></params></methodCall>",
    "deep": f"{nested(5_000)}</methodCall>".encode(),
    "deep enough to be a trap": f"{nested(200)}</methodCall>".encode(),
    "many values": b"<methodCall><methodName>a</methodName><params>"
    + b"<param><value/></param>" * 110_000
    + b"</params></methodCall>",
    "entities": f"{LAUGHS}]><methodCall><methodName>&a9;</methodName></methodCall>".encode(),
    "a document type in UTF-16": '<!DOCTYPE m SYSTEM "/etc/passwd"><m/>'.encode("utf-16"),
    "another file": b'<!DOCTYPE m SYSTEM "file:///etc/passwd"><m/>',
}


@pytest.mark.parametrize("body", BAD_BODIES.values(), ids=list(BAD_BODIES))
def test_malformed_xml_rpc_body_is_a_fault(run: Joined, body: bytes) -> None:
    with pytest.raises(RpcError):
        read_body(body)
    head = f"{HEAD}Connection: close\r\nContent-Length: {len(body)}\r\n\r\n".encode()
    assert b"<fault>" in exchanged(run, head + body)
    assert is_served(run)


@pytest.mark.parametrize("body", [dumps((1,), methodresponse=True).encode(), b"<methodCall><params/></methodCall>"])
def test_a_request_without_a_method_is_a_fault(run: Joined, body: bytes) -> None:
    head = f"{HEAD}Connection: close\r\nContent-Length: {len(body)}\r\n\r\n".encode()
    assert b"the method is missing" in exchanged(run, head + body)


def test_values_of_usual_depth_and_number_are_read() -> None:
    value = [{"a": [1, 2.5, True, "x", b"y"]}] * 1_000
    assert read_body(dumps(("/x", value), "setParam").encode()) == (("/x", value), "setParam")
    assert read_body(f"{nested(100)}</methodCall>".encode())[1] == "setParam"


@pytest.mark.slow
def test_many_calls_at_once_are_bounded(run: Joined) -> None:
    one = {"methodName": "getPid", "params": ["/x"]}
    assert len(run.ask(run.host.world.uri, "system.multicall", [one] * 1_000)) == 1_000
    assert "1,001 calls" in str(run.ask(run.host.world.uri, "system.multicall", [one] * 1_001))
    assert "more than" in str(run.ask(run.host.world.uri, "system.multicall", [one] * 30_000))
    for wrong in (1, "text", {}, [1], [{}], [{"methodName": 1}], [{"methodName": "getPid", "params": 3}]):
        answer = run.ask(run.host.world.uri, "system.multicall", wrong)
        assert "fault" in str(answer).lower(), wrong


def test_an_answer_to_many_calls_is_bounded(run: Joined) -> None:
    run.master("setParam", "/large", "x" * 100_000)
    calls = [{"methodName": "getParam", "params": ["/x", "/large"]}] * 1_000
    assert "make fewer calls" in str(run.ask(run.host.world.uri, "system.multicall", calls))
    run.master("deleteParam", "/large")


def test_names_and_registrations_are_bounded(run: Joined, monkeypatch: pytest.MonkeyPatch) -> None:
    uri, long = run.host.world.uri, "/" + "a" * 1_000
    for method, arguments in {
        "registerPublisher": (long, "std_msgs/String", NOBODY),
        "registerSubscriber": ("/a", f"std_msgs/{long}", NOBODY),
        "registerService": ("/a", f"rosrpc://{long}", NOBODY),
        "subscribeParam": (f"http://{long}", "/a"),
        "setParam": (long, 1),
        "deleteParam": (long,),
    }.items():
        code, why, _ = run.ask(uri, method, CALLER, *arguments)
        assert code == -1, method
        assert "more than 1,000 characters" in why
    assert run.ask(uri, "registerPublisher", long, "/a", "std_msgs/String", NOBODY)[0] == -1
    before = len(run.host.world._entered)
    monkeypatch.setattr("cfepy.extra.ros_host.served_master.ROS_REGISTRATIONS", before + 3)
    codes = [run.ask(uri, "registerSubscriber", CALLER, f"/t{n}", "*", NOBODY)[0] for n in range(5)]
    assert codes == [1, 1, 1, -1, -1]
    for n in range(3):
        run.master("unregisterSubscriber", f"t{n}/", NOBODY)  # another spelling of the same name
    assert len(run.host.world._entered) == before


def test_requests_wait_for_their_turn(run: Joined) -> None:
    """While the turn is over, requests stay in their connections. The next turn answers them all."""
    turn, stranger = run.host.bounds.turn, opened(run)
    seconds, turn._seconds = turn._seconds, 0.0
    try:
        stranger.setblocking(True)
        stranger.sendall(request("getPid", "/x", Connection="keep-alive") * 3)
        stranger.setblocking(False)
        for _ in range(20):
            run.host.exchange()
        with pytest.raises(BlockingIOError):
            stranger.recv(100)
    finally:
        turn._seconds = seconds
    found = b""
    while found.count(b"</methodResponse>") < 3:
        run.host.exchange()
        with suppress(BlockingIOError):
            found += stranger.recv(1 << 16)
    stranger.close()


def test_idle_connections_are_closed_when_places_are_needed(run: Joined, monkeypatch: pytest.MonkeyPatch) -> None:
    places = run.host.bounds.places
    monkeypatch.setattr(places, "_most", 8)
    service = run.host.service_uri("/server")
    kept = run.connected(service, {"service": "/switch", "persistent": "1", **SET_BOOL})
    kept.header()
    left = [opened(run, uri) for uri in (run.host.world.uri, run.host.node_uri("/talker"), service) * 8]
    for each in left:
        each.sendall(b"P")
        run.host.exchange()
    assert len(places) <= 8
    assert is_served(run)
    kept.frames.has_status = True
    kept.socket.sendall(b"\x01\0\0\0\x01")
    assert kept.frame()[0] == 1, "one that is of use does not give way"
    run.host.bounds.places.look(time.monotonic() + peer_places.HEAD_S + 1)
    run.run_while(lambda: len(places) > 2)
    for each in (*left, kept.socket):
        each.close()


def test_new_connection_is_refused_when_all_others_are_in_use(run: Joined, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run.host.bounds.places, "_most", 2)
    service = run.host.service_uri("/server")
    fields = {"service": "/switch", "persistent": "1", **SET_BOOL}
    wires = [run.connected(service, fields) for _ in range(2)]
    for each in wires:
        each.header()
    late = run.connected(service, fields)
    late.ended()
    for each in (*wires, late):
        each.socket.close()
    run.run_while(lambda: bool(len(run.host.bounds.places)))


def test_largest_unfinished_message_is_closed_when_memory_is_needed(
    run: Joined, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run.host.bounds.room, "_most", 300_000)
    service = run.host.service_uri("/server")
    small, large = opened(run), run.connected(service, {"service": "/switch", **SET_BOOL})
    large.header()
    small.sendall(f"{HEAD}Content-Length: 100000\r\n\r\n".encode() + b"x" * 50_000)
    data = struct.pack("<I", 1 << 20) + b"x" * 400_000
    while not large.is_over:
        with suppress(BlockingIOError, ConnectionError):
            data = data[large.socket.send(data) :]
        run.host.exchange()
        large._look()
    assert run.host.bounds.room.size == 50_000
    small.close()
    large.socket.close()
    run.run_while(lambda: bool(run.host.bounds.room.size))


@pytest.mark.parametrize("size", [1 << 31, (32 << 20) + 1])
def test_a_huge_frame_ends_its_connection(run: Joined, size: int) -> None:
    wire = run.connected(run.host.service_uri("/server"), {"service": "/switch", **SET_BOOL})
    wire.header()
    wire.socket.sendall(struct.pack("<I", size))
    wire.ended()
    wire.socket.close()
    stranger = opened(run, run.host.service_uri("/server"))
    stranger.sendall(struct.pack("<I", size))
    run.run_while(lambda: bool(len(run.host.bounds.places)))
    stranger.close()


def test_caller_that_does_not_wait_gets_all_answers(run: Joined) -> None:
    wire = run.connected(run.host.service_uri("/server"), {"service": "/switch", "persistent": "1", **SET_BOOL})
    wire.header()
    wire.frames.has_status = True
    wire.socket.sendall(b"\x01\0\0\0\x01" * 50)
    assert [wire.frame()[0] for _ in range(50)] == [1] * 50
    wire.socket.close()


def test_caller_that_left_is_not_served_any_more(run: Joined) -> None:
    wire = run.connected(run.host.service_uri("/server"), {"service": "/switch", "persistent": "1", **SET_BOOL})
    wire.header()
    wire.socket.sendall(b"\x01\0\0\0\x01" * 2_000)
    for _ in range(5):
        run.host.exchange()
    wire.socket.close()
    calls = run.host._last_call
    run.run_while(lambda: bool(len(run.host.bounds.places)))
    assert run.host._last_call < calls + 100


SLOW = """
import threading
import rospy
from std_msgs.msg import String
from std_srvs.srv import SetBool
rospy.init_node("server")
going = threading.Event()
rospy.Subscriber("/go", String, lambda message: going.set())
rospy.Service("/switch", SetBool, lambda request: (going.wait(), "on"))
rospy.spin()
"""


def test_calls_of_a_service_that_wait_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rospy_shim.graph.outside.ROS_CALLS", 4)
    with joined(tmp_path, {"SERVER": SLOW}) as run:
        uri = run.master("lookupService", "/switch")
        fields = {"service": "/switch", **SET_BOOL}
        left = [run.connected(uri, fields) for _ in range(4)]
        for each in left:
            each.header()
            each.socket.sendall(b"\x01\0\0\0\x01")
        entry = run.mission.ros.graph.services["/switch"]
        run.run_while(lambda: len(entry.calls) < 4)
        late = run.connected(uri, fields)
        late.header()
        late.frames.has_status = True
        late.socket.sendall(b"\x01\0\0\0\x01")
        assert b"the limit of 4 pending calls of /switch is reached" in late.frame()
        for each in (*left, late):
            each.socket.close()
        run.mission.outside.act("publish", "/go", text("now"))
        run.run_while(lambda: bool(entry.calls))  # also those whose callers have disconnected
        again = run.connected(uri, fields)
        again.header()
        again.frames.has_status = True
        again.socket.sendall(b"\x01\0\0\0\x01")
        assert again.frame()[0] == 1
        again.socket.close()


def test_unreadable_messages_are_logged_a_limited_number_of_times(tmp_path: Path) -> None:
    with joined(tmp_path, {"TALKER": TALKER}) as run:
        before = len(run.mission.console.lines)
        speaker = OutsideSpeaker(run, "/orders")
        speaker.connect()
        for _ in range(40):
            speaker.send_frames(b"\0\0\0\0" * 25)
        speaker.send(b"\4\0\0\0done")
        chatter = run.mission.ros.graph.nodes["/talker"].links["/chatter"]
        run.run_while(lambda: chatter.latch is None or chatter.latch.data != "DONE")
        told = [each for each in run.mission.console.lines[before:] if "cannot read a message" in each]
        assert 16 < len(told) < 40
        speaker.close()


BAD_HEADERS = {
    "nothing": b"\0\0\0\0",
    "zeros": bytes(400),
    "a field longer than its header": b"\x08\0\0\0\xff\0\0\0a=b!",
    "a field of all numbers": b"\x08\0\0\0\xff\xff\xff\xffa=b!",
    "no sign": pack_header({})[:0] + b"\x07\0\0\0\x03\0\0\0abc",
    "both": pack_header({"topic": "/chatter", "service": "/switch", "md5sum": "*"}),
    "no name": pack_header({"topic": "", "md5sum": "*"}),
    "no such topic": pack_header({"topic": "/none", "md5sum": "*"}),
    "a long name": pack_header({"topic": "/chatter", "md5sum": "*", "callerid": "x" * 100_000}),
    "no UTF-8": b"\x10\0\0\0\x0c\0\0\0topic=\xff\xfe\xfd\xfc\xfb\xfa",
    "many fields": pack_header({str(n): "" for n in range(10_000)}),
}


@pytest.mark.parametrize("data", BAD_HEADERS.values(), ids=list(BAD_HEADERS))
def test_a_bad_connection_header_ends_its_connection(run: Joined, data: bytes) -> None:
    for node in ("/talker", "/server"):
        stranger = opened(run, run.host.service_uri(node))
        stranger.sendall(data)
        while len(run.host.bounds.places):
            run.host.exchange()
            if data == pack_header({"topic": "/chatter", "service": "/switch", "md5sum": "*"}):
                break
        stranger.close()
    assert is_served(run)
    run.run_while(lambda: bool(len(run.host.bounds.places)))


# -- answers of other programs -----------------------------------------------------------------------------------------


class Answering:
    """A server of one answer, as bytes."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.uri = f"http://127.0.0.1:{self._socket.getsockname()[1]}/"

    def serve(self) -> None:
        for _ in range(2):  # a client asks again when nothing came
            connected, _ = self._socket.accept()
            connected.recv(1 << 16)
            with suppress(OSError):
                connected.sendall(self._data)
            connected.close()

    def close(self) -> None:
        self._socket.close()


def answered(body: bytes, more: str = "") -> bytes:
    return f"HTTP/1.1 200 OK\r\nContent-Type: text/xml\r\n{more}Content-Length: {len(body)}\r\n\r\n".encode() + body


BAD_ANSWERS = {
    "nothing": b"",
    "no HTTP": b"\0\1\2\r\n\r\n",
    "a page": b"HTTP/1.1 404 Not Found\r\nContent-Length: 2\r\n\r\nno",
    "no XML": answered(b"hello"),
    "a fault": answered(dumps(Fault(1, "x"), methodresponse=True).encode()),
    "no triple": answered(dumps((5,), methodresponse=True).encode()),
    "a short one": answered(dumps(([1, ""],), methodresponse=True).encode()),
    "a code that is none": answered(dumps((["1", "", 0],), methodresponse=True).encode()),
    "packed": answered(b"\x1f\x8b", "Content-Encoding: gzip\r\n"),
    "too large": answered(b" " * (input_limits.RPC_BYTES + 100_000)),
}


@pytest.mark.parametrize("data", BAD_ANSWERS.values(), ids=list(BAD_ANSWERS))
def test_malformed_answer_is_an_error(data: bytes) -> None:
    server = Answering(data)
    found: list[Any] = []
    errands = Errands()
    errands.run("serve", server.serve, lambda result, error: found.append(error))
    with pytest.raises((RosError, OSError)):
        ask(server.uri, "getPid", CALLER)
    server.close()
    errands.close()


def test_many_errands_use_few_threads_and_too_many_are_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(errands_module, "MOST_LINES", 50)
    monkeypatch.setattr(errands_module, "MOST_THREADS", 3)
    gate, done, told = errands_module.threading.Event(), [], []
    errands = Errands(told.append)
    for number in range(60):
        errands.run(f"line {number}", gate.wait, lambda result, error: done.append(error))
    assert errands._threads == 3
    errands.deliver()
    assert [type(each) for each in done] == [RosError] * 10
    gate.set()
    while len(done) < 60:
        errands.deliver()
    assert done[10:] == [None] * 50
    errands.run("bad", lambda: 1, lambda result, error: result["x"])
    while not told:
        errands.deliver()
    assert "invalid answer of another program: TypeError" in told[0]
    errands.close()


def test_peer_that_is_not_a_master_is_reported(tmp_path: Path) -> None:
    from cfepy.extra.ros_host import JoinedMaster

    server = Answering(b"HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\nhello")
    errands = Errands()
    errands.run("serve", server.serve, lambda result, error: None)
    with (
        pytest.raises(UsageError, match="no ROS master answers"),
        joined(tmp_path, {}, world=lambda host: JoinedMaster(host, server.uri)),
    ):
        pass
    server.close()
    errands.close()
