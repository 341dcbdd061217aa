"""A run whose servers get damaged input over real sockets: TCPROS, the slave and master API, rosbridge, Foxglove.

A case is a connection. After each case the run must continue: no node ends, cfepy prints no error of its own,
and no server keeps data of the connection.
"""

from __future__ import annotations

import atexit
import re
import socket
import struct
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from tempfile import mkdtemp
from typing import Any
from xmlrpc.client import dumps

from cfepy.extra.ros_host import RosHost, ServedMaster
from cfepy.extra.ros_host.tcpros import frame, pack_header
from cfepy.extra.viewers.foxglove import FoxgloveViewer
from cfepy.extra.viewers.listen import Admission, ListenPlace
from cfepy.extra.viewers.rosbridge import RosbridgeServer
from cfepy.io import HostNetwork, PeerCounts
from cfepy.mission import Mission
from cfepy.writing.console import Console

LOOPBACK = "127.0.0.1"
PIECE_NS = 2_000_000
PIECES = 4  # of the run, while a connection is there
MOST_PIECES = 2_000  # until nothing of a connection is left
MOST_CASES = 2_000  # of one run: its records grow with each message
TALKER = """
import rospy
from std_msgs.msg import String, UInt8MultiArray
from std_srvs.srv import SetBool, Trigger
rospy.init_node("talker")
publisher = rospy.Publisher("/chatter", String, queue_size=10, latch=True)
publisher.publish("first")
rospy.Subscriber("/orders", String, lambda message: publisher.publish(message.data[:20]))
rospy.Subscriber("/bytes", UInt8MultiArray, lambda message: None)
rospy.Service("/switch", SetBool, lambda request: (request.data, "on"))
rospy.Service("/pull", Trigger, lambda request: (True, "ok"))
rospy.set_param("/a/b", [1, 2.5, "x", True])
rospy.spin()
"""
_TROUBLE = re.compile(r"died of an exception|Traceback|ExceptionID")


class ServersRun:
    """A mission with all servers."""

    def __init__(self) -> None:
        self._open = ExitStack()
        self.told: list[str] = []
        folder = Path(mkdtemp(prefix="cfepy-servers-"))
        self._open.callback(_remove, folder)
        (folder / "mission.yaml").write_text("name: servers\n", encoding="utf-8")
        (folder / "startup.scr").write_text(
            "CFE_APP, talker.py, __main__, TALKER, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8"
        )
        (folder / "talker.py").write_text(TALKER, encoding="utf-8")
        enter, place = self._open.enter_context, ListenPlace(LOOPBACK, 0)
        self.rosbridge = RosbridgeServer(place, Admission(), PeerCounts())
        self._open.callback(self.rosbridge.close)
        self.foxglove = FoxgloveViewer(place, Admission(), "servers", PeerCounts())
        self._open.callback(self.foxglove.close)
        attachments = [self.rosbridge, self.foxglove]
        self.mission = enter(Mission(str(folder), console=Console(quiet=True), attachments=attachments))
        self.network = enter(HostNetwork(self.mission))
        self.host = enter(RosHost(self.mission, lambda host: ServedMaster(host, 0), {}, self.told.append))
        for guest in (self.host, self.rosbridge, self.foxglove):
            self.network.join(guest)
        while "/switch" not in (self.mission.ros.graph.services if self.mission.ros is not None else ()):
            self.go_on()
        self.host.see()
        self.cases = 0
        self._lines = len(self.mission.console.lines)

    def go_on(self) -> None:
        """A piece of the run."""
        self.mission.run_until(self.mission.kernel.now + PIECE_NS)
        self.network.exchange()

    def send(self, port: int, *parts: bytes) -> None:
        """Connect, send one part after the other, and leave."""
        self.cases += 1
        with socket.create_connection((LOOPBACK, port)) as peer:
            peer.setblocking(False)
            for part in parts:
                _push(peer, part, self.go_on)
            for _ in range(PIECES):
                self.go_on()
                _drain(peer)
        for _ in range(MOST_PIECES):
            self.go_on()
            if not self._is_busy():
                break
        else:
            raise AssertionError("a server keeps a connection that is over")
        self._check()

    def _is_busy(self) -> bool:
        bounds = self.host.bounds
        listeners = (self.rosbridge._listener, self.foxglove._server._listener)
        held = sum(each._room.size + len(each._connections) for each in listeners)
        return bool(len(bounds.places) or bounds.room.size or bounds.late or held)

    def _check(self) -> None:
        lines = self.mission.console.lines[self._lines :]
        self._lines += len(lines)
        assert not any(_TROUBLE.search(each) for each in lines), "\n".join(lines[-40:])
        assert self.mission.ros is not None
        outside = self.mission.ros.outside
        assert len(outside.nodes) <= 2_000, "outside nodes are kept"
        assert self.host.errands._threads <= 16
        unusable = [each for each in self.told if "could not be used" in each]
        assert not unusable, unusable

    @property
    def is_used_up(self) -> bool:
        """Whether its nodes are gone, as the master's API can have it, or it has been used for long."""
        ros = self.mission.ros
        return self.cases >= MOST_CASES or ros is None or "/switch" not in ros.graph.services

    def close(self) -> None:
        """End it."""
        self._open.close()


_runs: list[ServersRun] = []


def the_run() -> ServersRun:
    """Return the current run, or a new one if it is used up."""
    if _runs and _runs[0].is_used_up:
        _runs.pop().close()
    if not _runs:
        _runs.append(ServersRun())
    return _runs[0]


@atexit.register
def end_runs() -> None:
    """End the runs that are active."""
    while _runs:
        _runs.pop().close()


def _remove(folder: Path) -> None:
    for each in folder.iterdir():
        each.unlink()
    folder.rmdir()


def _push(peer: socket.socket, data: bytes, meanwhile: Callable[[], object]) -> None:
    for _ in range(MOST_PIECES):
        if not data:
            return
        try:
            data = data[peer.send(data) :]
        except BlockingIOError:
            meanwhile()
        except ConnectionError:
            return
        _drain(peer)


def _drain(peer: socket.socket) -> None:
    try:
        while peer.recv(1 << 16):
            pass
    except (BlockingIOError, ConnectionError):
        pass


# -- inputs ------------------------------------------------------------------------------------------------------------


def tcpros(data: bytes, path: Path) -> None:
    """Send a connection header and further bytes to the port of a node."""
    run = the_run()
    port = int(run.host.service_uri("/talker").rpartition(":")[2])
    half = len(data) // 2
    run.send(port, *((data,) if len(data) % 2 else (data[:half], data[half:])))


def http(data: bytes, path: Path) -> None:
    """Bytes at the port of the master."""
    run = the_run()
    run.send(_port(run.host.world.uri), data)


def master_api(data: bytes, path: Path) -> None:
    """The body of a request to the master."""
    run = the_run()
    run.send(_port(run.host.world.uri), _posted(data))


def slave_api(data: bytes, path: Path) -> None:
    """The body of a request to a node."""
    run = the_run()
    run.send(_port(run.host.node_uri("/talker")), _posted(data))


def rosbridge(data: bytes, path: Path) -> None:
    """Ops, one a line."""
    run = the_run()
    run.send(run.rosbridge.place.port, _handshake(), *map(_text, data.split(b"\n")))


def foxglove(data: bytes, path: Path) -> None:
    """Send messages, one per line. Those that do not begin with a bracket are binary."""
    run = the_run()
    lines = [_text(each) if each[:1] in (b"{", b"[") else _frame(2, each) for each in data.split(b"\n")]
    run.send(run.foxglove.place.port, _handshake("Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"), *lines)


def websocket(data: bytes, path: Path) -> None:
    """Bytes at the port of a server for viewers."""
    run = the_run()
    run.send(run.rosbridge.place.port if len(data) % 2 else run.foxglove.place.port, data)


def _port(uri: str) -> int:
    return int(uri.rstrip("/").rpartition(":")[2])


def _posted(body: bytes) -> bytes:
    head = f"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/xml\r\nContent-Length: {len(body)}\r\n\r\n"
    return head.encode() + body


def _handshake(more: str = "") -> bytes:
    lines = ["GET / HTTP/1.1", "Host: localhost", "Upgrade: websocket", "Connection: Upgrade"]
    lines += ("Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Version: 13", "")
    return ("\r\n".join(lines) + more + "\r\n").encode()


def _text(data: bytes) -> bytes:
    return _frame(1, data)


def _frame(opcode: int, data: bytes) -> bytes:
    """Return a client's frame with mask 0 (RFC 6455, 5.2)."""
    size = len(data)
    if size < 126:
        head = bytes([0x80 | opcode, 0x80 | size])
    elif size < 1 << 16:
        head = bytes([0x80 | opcode, 0xFE]) + struct.pack(">H", size)
    else:
        head = bytes([0x80 | opcode, 0xFF]) + struct.pack(">Q", size)
    return head + bytes(4) + data


# -- samples -----------------------------------------------------------------------------------------------------------


def tcpros_samples() -> list[bytes]:
    """Return subscribers, callers and probes."""
    string = {"type": "std_msgs/String", "md5sum": "992ce8a1687cec8c8bd883ec73ca41d1", "callerid": "/x"}
    call = {"service": "/switch", "md5sum": "*", "callerid": "/x", "persistent": "1"}
    return [
        pack_header({"topic": "/chatter", "tcp_nodelay": "1", **string}),
        pack_header({"topic": "/rosout", "md5sum": "*", "type": "*", "callerid": "/y"}),
        pack_header(call) + frame(b"\1") + frame(b"") + frame(b"\0"),
        pack_header({**call, "service": "/pull"}) + frame(b""),
        pack_header({**call, "service": "/talker/set_logger_level"})
        + frame(frame(b"rosout") + frame(b"info"))
        + frame(frame(b"x")[:3]),
        pack_header({**call, "probe": "1"}),
        pack_header(call | {"service": "/talker/get_loggers"}) + frame(b"") * 20,
    ]


def _request(method: str, *arguments: Any) -> bytes:
    return dumps(arguments, method).encode()


NOBODY = "http://127.0.0.1:1/"


def master_samples() -> list[bytes]:
    """Return requests to the master."""
    value = {"p": 1, "q": [1.5, True, b"\0\1", {"r": "text"}]}
    calls = [{"methodName": "getPid", "params": ["/x"]}, {"methodName": "deleteParam", "params": ["/x", "/p"]}]
    return [
        _request("setParam", "/x", "/p", value),
        _request("getParam", "/x", "/a/b"),
        _request("searchParam", "/x/y", "b"),
        _request("getParamNames", "/x"),
        _request("subscribeParam", "/x", NOBODY, "/p"),
        _request("registerPublisher", "/x", "/orders", "std_msgs/String", NOBODY),
        _request("unregisterPublisher", "/x", "/orders", NOBODY),
        _request("registerSubscriber", "/x", "/chatter", "*", NOBODY),
        _request("unregisterSubscriber", "/x", "/chatter", NOBODY),
        _request("registerService", "/x", "/s", "rosrpc://127.0.0.1:1", NOBODY),
        _request("unregisterService", "/x", "/s", "rosrpc://127.0.0.1:1"),
        _request("getSystemState", "/x"),
        _request("getPublishedTopics", "/x", ""),
        _request("lookupService", "/x", "/switch"),
        _request("system.multicall", calls),
    ]


def slave_samples() -> list[bytes]:
    """Return requests to a node."""
    return [
        _request("requestTopic", "/x", "/chatter", [["TCPROS"]]),
        _request("publisherUpdate", "/master", "/orders", [NOBODY]),
        _request("paramUpdate", "/master", "/p/", {"q": 1}),
        _request("getBusInfo", "/x"),
        _request("getBusStats", "/x"),
        _request("getPublications", "/x"),
        _request("getSubscriptions", "/x"),
        _request("getMasterUri", "/x"),
        _request("system.multicall", [{"methodName": "getPid", "params": ["/x"]}]),
    ]


def http_samples() -> list[bytes]:
    """Return requests with their heads."""
    return [_posted(each) for each in (*master_samples()[:3], slave_samples()[0])] + [
        _posted(b"").replace(b"HTTP/1.1", b"HTTP/1.0") + _posted(master_samples()[1]),
        _posted(master_samples()[0]).replace(b"Content-Type", b"Expect: 100-continue\r\nContent-Type"),
        b"GET / HTTP/1.1\r\nHost: localhost\r\nOrigin: https://x.example\r\n\r\n",
    ]


ROSBRIDGE = b"""{"op": "advertise", "topic": "/orders", "type": "std_msgs/String", "id": "a", "latch": true}
{"op": "publish", "topic": "/orders", "msg": {"data": "text"}}
{"op": "unadvertise", "topic": "/orders", "id": "a"}
{"op": "subscribe", "topic": "/chatter", "type": "std_msgs/String", "throttle_rate": 10, "queue_length": 3, "id": 1}
{"op": "subscribe", "topic": "/chatter", "compression": "cbor", "fragment_size": 20}
{"op": "unsubscribe", "topic": "/chatter"}
{"op": "call_service", "service": "/switch", "args": {"data": true}, "id": "c"}
{"op": "call_service", "service": "/rosapi/set_param", "args": ["/p", "[1, {\\"a\\": 2}]"]}
{"op": "call_service", "service": "/rosapi/message_details", "args": {"type": "std_msgs/Header"}}
{"op": "call_service", "service": "/rosapi/topics_and_raw_types"}
{"op": "advertise_service", "service": "/mine", "type": "std_srvs/SetBool"}
{"op": "call_service", "service": "/mine", "args": [true]}
{"op": "service_response", "service": "/mine", "id": "x", "values": {}, "result": true}
{"op": "unadvertise_service", "service": "/mine"}
{"op": "fragment", "id": "f", "num": 0, "total": 2, "data": "{\\"op\\": "}
{"op": "fragment", "id": "f", "num": 1, "total": 2, "data": "\\"set_level\\"}"}
{"op": "publish", "topic": "/bytes", "msg": {"layout": {"dim": [{"label": "x", "size": 1}]}, "data": "AAEC"}}
{"op": "set_level", "level": "none"}
{"op": "auth", "mac": "", "client": "", "dest": "", "rand": "", "t": 0, "level": "", "end": 0}"""


def rosbridge_samples() -> list[bytes]:
    """Return ops of clients."""
    lines = ROSBRIDGE.split(b"\n")
    return [b"\n".join(lines[at : at + 3]) for at in range(0, len(lines), 2)]


FOXGLOVE = b"""{"op": "subscribe", "subscriptions": [{"id": 0, "channelId": 1}, {"id": 1, "channelId": 2}]}
{"op": "unsubscribe", "subscriptionIds": [0]}
{"op": "advertise", "channels": [{"id": 1, "topic": "/orders", "encoding": "json", "schemaName": "std_msgs/String"}]}
\x01\x01\0\0\0{"data": "text"}
{"op": "advertise", "channels": [{"id": 2, "topic": "/n", "encoding": "ros1", "schemaName": "a/B", "schema": "int8 x"}]}
\x01\x02\0\0\0\x05
{"op": "unadvertise", "channelIds": [1, 2]}
{"op": "getParameters", "parameterNames": ["/a/b"], "id": "x"}
{"op": "setParameters", "parameters": [{"name": "/p", "value": [1, 2.5]}, {"name": "/q", "value": 3}]}
{"op": "subscribeParameterUpdates", "parameterNames": ["/p"]}
{"op": "subscribeConnectionGraph"}
\x02\x01\0\0\0\x07\0\0\0\x04\0\0\0ros1\x01
\x02\x02\0\0\0\x08\0\0\0\x04\0\0\0ros1
{"op": "advertise", "channels": [{"id": 3, "topic": "/cfe/CFE_ES_NOOP", "encoding": "json", "schemaName": "x"}]}
\x01\x03\0\0\0{}
{"op": "unsubscribeConnectionGraph"}"""


def foxglove_samples() -> list[bytes]:
    """Return messages of viewers."""
    lines = FOXGLOVE.split(b"\n")
    return [b"\n".join(lines[at : at + 3]) for at in range(0, len(lines), 2)]


def websocket_samples() -> list[bytes]:
    """Return handshakes, and frames behind them."""
    foxglove = _handshake("Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n")
    parts = b'\x01\x83\0\0\0\0{"o' + b'\x80\x8c\0\0\0\0p": "nothing"}'
    return [
        _handshake() + parts + _frame(9, b"ping"),
        _handshake("Origin: http://localhost\r\n") + _text(b"{}") + _frame(8, struct.pack(">H", 1000)),
        foxglove + _frame(2, b"\x01\x01\0\0\0") + _text(b'{"op": "subscribeConnectionGraph"}'),
        foxglove + _frame(10, b"pong") + _text(b"[" * 20) + _frame(0, b"rest"),
    ]
