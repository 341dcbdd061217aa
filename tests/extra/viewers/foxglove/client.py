"""A client of Foxglove's WebSocket protocol, as the tests play it (foxglove/ws-protocol, docs/spec.md)."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait
from functools import partial
from inspect import signature
from typing import Any, TypeVar

from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

PROTOCOL = Subprotocol("foxglove.sdk.v1")
WAIT_S = 0.001  # wait for input before the run continues
PATIENCE_S = 20.0  # of a test that hangs
T = TypeVar("T")


class FoxgloveClient:
    """A viewer; use as a context manager.

    Args:
        url: URL of the server.
        meanwhile: called while it waits, such as to let the run continue.
        options: options of `websockets.sync.client.connect`.

    Attributes:
        channels: advertised channels of the server, by topic.
        messages: messages of subscribed channels: topic, time in ns, data.
        times: times that the server has sent, in ns.
        texts: other received messages, as JSON.
        answers: answers of service calls: number, encoding, data.
    """

    def __init__(self, url: str, meanwhile: Callable[[], object] = lambda: None, **options: Any) -> None:
        self.channels: dict[str, dict[str, Any]] = {}
        self.services: dict[str, dict[str, Any]] = {}
        self.messages: list[tuple[str, int, bytes]] = []
        self.times: list[int] = []
        self.texts: list[dict[str, Any]] = []
        self.answers: list[tuple[int, str, bytes]] = []
        self._topics: dict[int, str] = {}
        self._meanwhile = meanwhile
        # Behind a full queue it would wait ten seconds for the end of a connection that it closes.
        known = signature(connect).parameters  # older releases of the package have fewer
        more = {name: value for name, value in {"max_queue": None, "legacy": True}.items() if name in known}
        options = {"max_size": None, **more, **options}
        self.socket: ClientConnection = self._served(partial(connect, url, subprotocols=[PROTOCOL], **options))

    def __enter__(self) -> FoxgloveClient:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """End the connection, as the protocol has it."""
        self._served(self.socket.close)

    def _served(self, step: Callable[[], T]) -> T:
        """Execute a step that waits for the server, which answers while the run continues."""
        with ThreadPoolExecutor(1) as aside:
            done = aside.submit(step)
            while not done.done():
                self._meanwhile()
                wait([done], WAIT_S)
            return done.result()

    # -- sending -------------------------------------------------------------------------------------------------------

    def send(self, **message: Any) -> None:
        """A message in JSON."""
        self.socket.send(json.dumps(message))

    def subscribe(self, *topics: str) -> None:
        """Subscribe to topics, as soon as they are advertised."""
        for topic in topics:
            self.wait_for(lambda topic=topic: topic in self.channels)  # type: ignore[misc]  # a lambda in a loop
            number = self.channels[topic]["id"]
            self._topics[number] = topic
            self.send(op="subscribe", subscriptions=[{"id": number, "channelId": number}])

    def advertise(self, number: int, topic: str, kind: str, encoding: str = "ros1", **more: Any) -> None:
        """Advertise a topic that it publishes."""
        channel = {"id": number, "topic": topic, "encoding": encoding, "schemaName": kind, **more}
        self.send(op="advertise", channels=[channel])

    def publish(self, number: int, data: bytes) -> None:
        """Publish a message."""
        self.socket.send(b"\x01" + struct.pack("<I", number) + data)

    def call(self, service: str, number: int, request: bytes, encoding: str = "ros1") -> None:
        """Call a service."""
        self.wait_for(lambda: service in self.services)
        head = struct.pack("<III", self.services[service]["id"], number, len(encoding))
        self.socket.send(b"\x02" + head + encoding.encode() + request)

    # -- receiving -----------------------------------------------------------------------------------------------------

    def wait_for(self, there: Callable[[], object]) -> None:
        """Receive until a condition is true. The run continues meanwhile."""
        left = int(PATIENCE_S / WAIT_S)
        while not there():
            self._meanwhile()
            try:
                self._take(self.socket.recv(timeout=WAIT_S))
            except TimeoutError:
                left -= 1
                assert left, f"it never came: {self.texts[-5:]}"

    def take_rest(self) -> None:
        """Take all that came before the server has closed the connection."""
        for message in self.socket:
            self._take(message)

    def told(self, op: str) -> list[dict[str, Any]]:
        """Return the messages of one kind."""
        return [each for each in self.texts if each["op"] == op]

    def of(self, topic: str) -> list[bytes]:
        """Return the messages of one topic."""
        return [data for name, _, data in self.messages if name == topic]

    def _take(self, message: str | bytes) -> None:
        if isinstance(message, str):
            self._take_text(json.loads(message))
        elif message[0] == 1:
            number, time_ns = struct.unpack_from("<IQ", message, 1)
            self.messages.append((self._topics[number], time_ns, message[13:]))
        elif message[0] == 2:
            self.times.append(struct.unpack_from("<Q", message, 1)[0])
        elif message[0] == 3:
            _, number, length = struct.unpack_from("<III", message, 1)
            self.answers.append((number, message[13 : 13 + length].decode(), message[13 + length :]))

    def _take_text(self, text: dict[str, Any]) -> None:
        self.texts.append(text)
        if text["op"] == "advertise":
            self.channels |= {each["topic"]: each for each in text["channels"]}
        elif text["op"] == "advertiseServices":
            self.services |= {each["name"]: each for each in text["services"]}
