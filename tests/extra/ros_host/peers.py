"""External programs, played by the tests: the test drives each step, and nothing waits for the wall clock."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from xmlrpc.client import ServerProxy, Transport

from cfepy.extra.ros_host import RosHost, ServedMaster
from cfepy.extra.ros_host.tcpros import TcprosFrames, frame, pack_header, parse_header
from cfepy.extra.ros_host.world import RosWorld
from cfepy.extra.ros_host.xmlrpc_server import XmlRpcServer
from cfepy.io import Listening, listening_socket
from cfepy.io.host_network import HostNetwork
from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.io.echo import PATIENCE_NS, pacer

CALLER = "/outside"
STRING = {"type": "std_msgs/String", "md5sum": "992ce8a1687cec8c8bd883ec73ca41d1"}
SET_BOOL = {"type": "std_srvs/SetBool", "md5sum": "09fb03525b03e7ea1fd3992bafd87e16"}

TALKER = """
import rospy
from std_msgs.msg import String
rospy.init_node("talker")
publisher = rospy.Publisher("/chatter", String, queue_size=10, latch=True)
publisher.publish("first")
def heard(message):
    publisher.publish(message.data.upper())
rospy.Subscriber("/orders", String, heard)
rospy.spin()
"""
SERVER = """
import rospy
from std_srvs.srv import SetBool
rospy.init_node("server")
def switch(request):
    if not request.data:
        raise ValueError("off is not possible")
    return True, "by " + request._connection_header["callerid"]
rospy.Service("/switch", SetBool, switch)
rospy.spin()
"""


def text(value: str) -> bytes:
    """Return a std_msgs/String as ROS serialises it."""
    return frame(value.encode())


class Joined:
    """A paced mission that serves a ROS master."""

    def __init__(self, mission: Mission, bridge: HostNetwork, host: RosHost, told: list[str]) -> None:
        self.mission = mission
        self.host = host
        self.told = told
        self._bridge = bridge
        self._pacer = pacer(mission.kernel, self._run_until, bridge.wait)

    def _run_until(self, until_ns: int) -> None:
        self.mission.run_until(until_ns)
        self._bridge.exchange()

    def run_while(self, missing: Callable[[], bool]) -> None:
        """Let the run go on until nothing is missing any more."""
        while missing():
            assert self.mission.kernel.now < PATIENCE_NS, "what was expected never came"
            self._pacer.step(PATIENCE_NS)

    def heard(self, line: str) -> bool:
        """Return whether the console has a line."""
        return any(line in each for each in self.mission.console.lines)

    def ask(self, uri: str, method: str, *arguments: Any) -> Any:
        """Ask the master, or a node, while the run continues. Returns the whole answer."""
        found: list[Any] = []

        def call() -> None:
            with ServerProxy(uri, Transport(use_builtin_types=True)) as server:
                try:
                    found.append(getattr(server, method)(*arguments))
                except Exception as error:  # the test looks at it
                    found.append(error)

        thread = threading.Thread(target=call)
        thread.start()
        self.run_while(lambda: not found)
        thread.join()
        return found[0]

    def master(self, method: str, *arguments: Any) -> Any:
        """Return the value of the master's answer, which is a success."""
        code, why, value = self.ask(self.host.world.uri, method, CALLER, *arguments)
        assert code == 1, why
        return value

    def connected(self, uri: str, header: Mapping[str, str]) -> Wire:
        """Return a TCPROS connection with a host and port, and its header sent."""
        address, _, port = uri.rpartition("://")[2].rstrip("/").rpartition(":")
        wire = Wire(self, socket.create_connection((address, int(port))))
        wire.socket.sendall(pack_header({"callerid": CALLER, **header}))
        return wire

    def subscribed(self, topic: str, kind: Mapping[str, str] = STRING) -> Wire:
        """Subscribe to the first publisher of a topic, and connect with it."""
        uris = self.master("registerSubscriber", topic, kind["type"], "http://127.0.0.1:1/")
        _, _, (protocol, address, port) = self.ask(uris[0], "requestTopic", CALLER, topic, [["TCPROS"]])
        assert protocol == "TCPROS"
        return self.connected(f"{address}:{port}", {"topic": topic, **kind})


class Wire:
    """The outside's end of a connection."""

    def __init__(self, run: Joined, connected: socket.socket) -> None:
        self.socket = connected
        self.frames = TcprosFrames()
        self._run = run
        self._found: list[bytes] = []
        self.is_over = False
        connected.setblocking(False)

    def frame(self) -> bytes:
        """Return the next frame, running the mission until it arrives."""
        self._run.run_while(lambda: not self._look())
        return self._found.pop(0)

    def header(self) -> dict[str, str]:
        """Return the other side's connection header."""
        return parse_header(self.frame())

    def ended(self) -> None:
        """Let the run go on until the peer has closed the connection."""
        self._run.run_while(lambda: not (self._look() or self.is_over) or bool(self._found))

    def _look(self) -> bool:
        try:
            data = self.socket.recv(1 << 16)
        except BlockingIOError:
            return bool(self._found)
        except ConnectionError:
            data = b""
        self.is_over = self.is_over or not data
        self.frames.add(data)
        self._found += self.frames.take()
        return bool(self._found)


class OutsideSpeaker:
    """An external publisher, with a slave API that the test serves. The master need not know it yet."""

    def __init__(self, run: Joined, topic: str, kind: Mapping[str, str] = STRING, is_known: bool = True) -> None:
        self._run = run
        self._topic = topic
        self._kind = kind
        self._accepted: list[Wire] = []
        selector = run.host.selector
        self._opened = Listening(
            selector, listening_socket("127.0.0.1"), lambda socket: self._accepted.append(Wire(run, socket))
        )
        self._server = XmlRpcServer(
            selector, "127.0.0.1", lambda *_: (1, "", ["TCPROS", "127.0.0.1", self._opened.port]), run.host.bounds
        )
        self.uri = f"http://127.0.0.1:{self._server.port}/"
        if is_known:
            run.master("registerPublisher", topic, kind["type"], self.uri)

    @property
    def is_waited_for(self) -> bool:
        """Whether the mission has connected once more."""
        return bool(self._accepted)

    def connect(self) -> dict[str, str]:
        """Wait for the mission to connect. Returns the header that it sends."""
        self._run.run_while(lambda: not self._accepted)
        self._wire = self._accepted.pop()
        header = self._wire.header()
        self._wire.socket.sendall(
            pack_header({"callerid": CALLER, "topic": self._topic, "latching": "0", **self._kind})
        )
        return header

    def send(self, payload: bytes) -> None:
        """Send a message."""
        self.send_frames(frame(payload))

    def send_frames(self, data: bytes) -> None:
        """Send messages in one piece."""
        self._wire.socket.setblocking(True)
        self._wire.socket.sendall(data)
        self._wire.socket.setblocking(False)

    def close(self) -> None:
        """Die."""
        self._wire.socket.close()
        self._opened.close()
        self._server.close()


@contextmanager
def joined(
    folder: Path,
    nodes: Mapping[str, str],
    more: str = "",
    mission_file: str = "",
    world: Callable[[RosHost], RosWorld] = lambda host: ServedMaster(host, 0),
) -> Iterator[Joined]:
    """Run a mission of nodes, by their application's name, with a master on a free port.

    `more` are lines of its script.
    """
    (folder / "mission.yaml").write_text(mission_file or "name: joined\n", encoding="utf-8")
    lines = [f"CFE_APP, {app.lower()}.py, __main__, {app}, 100, 16384, 0x0, 0;\n" for app in nodes]
    (folder / "startup.scr").write_text("".join(lines) + more + "!\n", encoding="utf-8")
    for app, source in nodes.items():
        (folder / f"{app.lower()}.py").write_text(source, encoding="utf-8")
    told: list[str] = []
    with (
        Mission(str(folder), console=Console(quiet=True)) as mission,
        HostNetwork(mission, tell=told.append) as bridge,
        RosHost(mission, world, {}, told.append) as host,
    ):
        bridge.join(host)
        run = Joined(mission, bridge, host, told)
        run.run_while(lambda: mission.booted is None)
        yield run
