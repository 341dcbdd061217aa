"""A mission with a rosbridge server, and clients that the test plays: the test drives each step."""

from __future__ import annotations

import json
import socket
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from websockets.client import ClientProtocol
from websockets.uri import parse_uri

from cfepy.extra.viewers.listen import Admission, ListenPlace
from cfepy.extra.viewers.rosbridge import RosbridgeServer
from cfepy.io import HostNetwork, PeerCounts
from cfepy.mission import Mission, MissionSpec
from cfepy.writing.console import Console
from tests.io.echo import PATIENCE_NS, pacer

LOOPBACK = "127.0.0.1"


class Bridged:
    """A paced mission that rosbridge clients reach.

    Attributes:
        port: where.
    """

    def __init__(self, mission: Mission, network: HostNetwork, server: RosbridgeServer, counts: PeerCounts) -> None:
        self.mission = mission
        self.port = server.place.port
        self.server = server
        self.counts = counts
        self._network = network
        self._pacer = pacer(mission.kernel, self._run_until, network.wait)

    def _run_until(self, until_ns: int) -> None:
        self.mission.run_until(until_ns)
        self._network.exchange()

    def step(self) -> None:
        """Let the run go on for a while."""
        self._pacer.step(self.mission.kernel.now + PATIENCE_NS)

    def run_while(self, missing: Callable[[], bool]) -> None:
        """Let the run go on until nothing is missing any more."""
        until_ns = self.mission.kernel.now + PATIENCE_NS
        while missing():
            assert self.mission.kernel.now < until_ns, "what was expected never came"
            self.step()

    def client(self, path: str = "/", headers: Mapping[str, str] | None = None) -> Client:
        """Return a client that is connected."""
        client = Client(self, path, headers or {})

        def waits() -> bool:
            client.look()
            return not client.is_open and not client.is_over

        self.run_while(waits)
        return client


class Client:
    """A client.

    Attributes:
        refused: status and text of the answer to its request, if it was refused.
        code: close code of the connection; None before its end.
    """

    def __init__(self, run: Bridged, path: str, headers: Mapping[str, str]) -> None:
        self._run = run
        self.socket = socket.create_connection((LOOPBACK, run.port))
        self.socket.setblocking(False)
        self._protocol = ClientProtocol(parse_uri(f"ws://{LOOPBACK}:{run.port}{path}"), max_size=1 << 26)
        request = self._protocol.connect()
        for name, value in headers.items():
            request.headers[name] = value
        self._protocol.send_request(request)
        self.is_open = self.is_over = False
        self.refused: tuple[int, str] | None = None
        self.code: int | None = None
        self._found: list[Any] = []
        self._number = 0
        self.flush()

    def flush(self) -> None:
        """Send all pending data."""
        self.socket.setblocking(True)
        self.socket.sendall(b"".join(self._protocol.data_to_send()))
        self.socket.setblocking(False)

    def look(self) -> list[Any]:
        """Return the received messages that were not read yet."""
        try:
            while data := self.socket.recv(1 << 16):
                self._protocol.receive_data(data)
            self.is_over = True
            self._protocol.receive_eof()
        except BlockingIOError:
            pass
        except ConnectionError:
            self.is_over = True
        for event in self._protocol.events_received():
            if not self.is_open:
                self.is_open = event.status_code == 101
                if not self.is_open:
                    self.refused = (event.status_code, (event.body or b"").decode())
                    self.is_over = True
            elif event.opcode.name == "TEXT":
                self._found.append(json.loads(event.data))
            elif event.opcode.name == "BINARY":
                self._found.append(bytes(event.data))
            elif event.opcode.name == "CLOSE":
                self.is_over = True
                self.code = self._protocol.close_rcvd.code
        return self._found

    def send(self, **op: Any) -> None:
        """Send an op."""
        self.text(json.dumps(op))

    def text(self, text: str | bytes) -> None:
        """Send a text."""
        self._protocol.send_text(text.encode() if isinstance(text, str) else text)
        self.flush()

    def binary(self, data: bytes) -> None:
        """Send bytes."""
        self._protocol.send_binary(data)
        self.flush()

    def next(self) -> Any:
        """Return the next message, running the mission until it arrives."""
        self._run.run_while(lambda: not self.look() and not self.is_over)
        return self._found.pop(0)

    def ended(self) -> int | None:
        """Run until the connection is over. Returns its close code."""

        def stays() -> bool:
            self.look()
            return not self.is_over

        self._run.run_while(stays)
        return self.code

    def call(self, service: str, *arguments: Any, **fields: Any) -> Any:
        """Return the answer to a call: its values on success, otherwise the error as an op."""
        self._number += 1
        name = f"call:{self._number}"
        self.send(op="call_service", service=service, id=name, args=fields or list(arguments))
        answer = self.next()
        assert (answer["op"], answer["id"], answer["service"]) == ("service_response", name, service)
        return answer["values"] if answer["result"] else answer

    def close(self) -> None:
        """Leave."""
        self.socket.close()


@contextmanager
def bridged(
    folder: Path,
    nodes: Mapping[str, str],
    mission_file: str = "",
    admission: Admission | None = None,
    lines: str = "",
) -> Iterator[Bridged]:
    """Run a mission of nodes, by application, that clients can reach.

    Args:
        folder: folder of the mission.
        nodes: their programs.
        mission_file: further text of it.
        admission: the clients that the server accepts.
        lines: further lines of its startup script.
    """
    (folder / "mission.yaml").write_text(mission_file or "name: bridged\n", encoding="utf-8")
    apps = [f"CFE_APP, {app.lower()}.py, __main__, {app}, 100, 16384, 0x0, 0;\n" for app in nodes]
    (folder / "startup.scr").write_text("".join(apps) + lines + "!\n", encoding="utf-8")
    for app, source in nodes.items():
        (folder / f"{app.lower()}.py").write_text(source, encoding="utf-8")
    with bridged_mission(str(folder), admission) as run:
        yield run


@contextmanager
def bridged_mission(mission_spec: str | MissionSpec, admission: Admission | None = None) -> Iterator[Bridged]:
    """A mission that clients reach while it runs."""
    counts = PeerCounts()
    server = RosbridgeServer(ListenPlace(LOOPBACK, 0), admission or Admission(), counts)
    try:
        with (
            Mission(mission_spec, console=Console(quiet=True), attachments=[server]) as mission,
            HostNetwork(mission) as network,
        ):
            network.join(server)
            run = Bridged(mission, network, server, counts)
            run.run_while(lambda: mission.booted is None)
            yield run
    finally:
        server.close()
