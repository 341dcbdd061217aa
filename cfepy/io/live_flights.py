"""Running flights of this user, and the connection of a second terminal with one: `cfepy rostopic echo live: /odom`.

A run with --realtime listens at a Unix socket in a folder that only its user may enter (`flight_folder`). Programs of
other users and of other computers cannot reach it. `cfepy.extra.attach` is the flight's side.

Each message in either direction is its length in four bytes and a mapping in MessagePack. A request has a key "op":
hello, topics, listen (topics, telemetry), send (packet), publish (topic, fields). The answer has the key "of". After
"listen" the flight sends a mapping for each message ("topic") and for each packet ("packet").
"""

from __future__ import annotations

import contextlib
import os
import socket
import stat
import tempfile
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple

from cfepy.mission import TopicMessage
from cfepy.rtos import Stopwatch
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

LIVE = "live:"
"""The source of a command that means a running flight; a name or a process id may follow."""

SUFFIX = ".sock"
MOST_BYTES = 1 << 27  # of a message
ANSWER_S = 10.0  # wall time for an answer; a flight answers between two parts of its run
CONNECT_S = 1.0
LOOK_S = 0.25  # longest time for which Ctrl-C may wait
LEAST_S = 1e-4
CHUNK = 1 << 16


class LiveTopic(NamedTuple):
    """A topic of a running flight; nodes by name."""

    name: str
    type: str
    publishers: tuple[str, ...]
    subscribers: tuple[str, ...]


def flight_folder() -> Path:
    """Return the folder of the sockets of this user's flights: cfepy in XDG_RUNTIME_DIR, or one for temporary files.

    Raises:
        UsageError: if it cannot be made, or other users may enter it; or if this system has no such sockets.
    """
    if not hasattr(socket, "AF_UNIX"):
        raise UsageError("attaching to a flight is not possible on this system: it has no Unix sockets")
    base = os.environ.get("XDG_RUNTIME_DIR")
    folder = Path(base) / "cfepy" if base else Path(tempfile.gettempdir()) / f"cfepy-flights-{os.getuid()}"
    try:
        folder.mkdir(mode=0o700, parents=False, exist_ok=True)
        found = folder.lstat()
    except OSError as error:
        raise UsageError(f"cannot be made: {error.strerror}; set XDG_RUNTIME_DIR", file=folder) from None
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid() or found.st_mode & 0o077:
        raise UsageError("must be a folder that only you may enter; remove it", file=folder)
    return folder


def framed(message: Mapping[str, Any]) -> bytes:
    """Return a message with its length in front."""
    import msgpack

    data: bytes = msgpack.packb(dict(message), default=str)
    return len(data).to_bytes(4, "big") + data


class LiveFrames:
    """Collects received bytes into messages.

    Args:
        longest: maximum number of bytes of a message.
    """

    def __init__(self, longest: int = MOST_BYTES) -> None:
        self._longest = longest
        self._data = bytearray()

    def take(self, data: bytes) -> Iterator[dict[str, Any]]:
        """Take bytes, and yield the complete messages.

        Raises:
            ValueError: if they are not such messages.
        """
        import msgpack

        self._data += data
        while len(self._data) >= 4:
            size = int.from_bytes(self._data[:4], "big")
            if size > self._longest:
                raise ValueError(f"a message has {size} bytes, more than {self._longest}")
            if len(self._data) < 4 + size:
                return
            body = bytes(self._data[4 : 4 + size])
            del self._data[: 4 + size]
            message = msgpack.unpackb(body, strict_map_key=False)
            if not isinstance(message, dict):
                raise ValueError("a message is not a mapping")
            yield message


def live_name(word: str) -> str | None:
    """Return the name or process id after `live:`, "" for any flight; None for a word that is no running flight."""
    return word.removeprefix(LIVE) if word.startswith(LIVE) else None


def live_flight(name: str) -> LiveFlight:
    """Connect with a running flight.

    Args:
        name: the mission's name or the process id; "" if only one flight runs.

    Raises:
        UsageError: if there is none, or several.
    """
    flights = [each for each in map(_connected, _sockets()) if each is not None]
    chosen = [each for each in flights if name in ("", each.mission, str(each.pid))]
    for each in flights:
        if each not in chosen or len(chosen) != 1:
            each.close()
    if len(chosen) == 1:
        return chosen[0]
    running = ", ".join(f"{LIVE}{each.pid} ({each.mission})" for each in flights)
    if chosen:
        raise UsageError(f"several flights run: {running}; choose one", field=f"{LIVE}{name}")
    if not flights:
        raise UsageError("no flight runs; start one with `cfepy run MISSION --realtime`", field=f"{LIVE}{name}")
    raise UsageError(f"does not run; running are {running}", field=f"{LIVE}{name}")


def _sockets() -> list[Path]:
    return sorted(flight_folder().glob(f"*{SUFFIX}"))


def _connected(path: Path) -> LiveFlight | None:
    """Return the connection with the flight at a socket; None if it has ended without removing the socket."""
    plug = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    plug.settimeout(CONNECT_S)
    try:
        plug.connect(str(path))
        return LiveFlight(plug)
    except OSError as error:
        plug.close()
        if isinstance(error, ConnectionRefusedError):
            path.unlink(missing_ok=True)
        return None


class LiveFlight:
    """The connection with a running flight; use as a context manager.

    Args:
        plug: the connected socket.

    Attributes:
        mission: name of the mission.
        script: its startup script or launch file.
        pid: process id of the flight.
        lost: number of messages that the flight dropped because they were not read in time.
    """

    def __init__(self, plug: socket.socket) -> None:
        self._plug = plug
        self._frames = LiveFrames()
        self._unread: deque[dict[str, Any]] = deque()
        self.lost = 0
        hello = self.ask({"op": "hello"})
        self.mission, self.script, self.pid = str(hello["mission"]), str(hello["script"]), int(hello["pid"])

    def __enter__(self) -> LiveFlight:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connection."""
        self._plug.close()

    def ask(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Return the answer to a request.

        Raises:
            UsageError: if the flight refuses it.
            OSError: if the flight has ended, or does not answer in time.
        """
        self._plug.settimeout(ANSWER_S)
        self._plug.sendall(framed(request))
        answer: dict[str, Any] | None = None
        while answer is None:
            for message in self._received():
                if message.get("of") == request["op"]:
                    answer = message
                else:
                    self._unread.append(message)
        if "error" in answer:
            raise UsageError(str(answer["error"]))
        return answer

    def topics(self) -> list[LiveTopic]:
        """Return the topics, by name."""
        rows = self.ask({"op": "topics"})["topics"]
        return [LiveTopic(name, kind, tuple(publishers), tuple(subs)) for name, kind, publishers, subs in rows]

    def nodes(self) -> dict[str, str]:
        """Return the URIs of the nodes, by name."""
        found: dict[str, str] = self.ask({"op": "topics"})["nodes"]
        return found

    def listen(self, topics: Sequence[str] = (), telemetry: Sequence[int] | None = None) -> None:
        """Ask for messages.

        Args:
            topics: names or patterns of topics.
            telemetry: MsgIds of packets, empty for all telemetry; None for none.
        """
        ids = None if telemetry is None else list(telemetry)
        self.ask({"op": "listen", "topics": list(topics), "telemetry": ids})

    def messages(self, seconds: float | None = None) -> Iterator[TopicMessage | tuple[bytes, int]]:
        """Yield the messages and packets for which `listen` asked: messages on topics; packets with the virtual ns of
        their sending. It ends with the flight, with the time, and at Ctrl-C.

        Args:
            seconds: wall time; None for no limit.
        """
        watch = Stopwatch()
        with contextlib.suppress(KeyboardInterrupt, ConnectionError):
            while seconds is None or watch.elapsed_ns() < seconds * NS_PER_S:
                rest_s = LOOK_S if seconds is None else min(LOOK_S, seconds - watch.elapsed_ns() / NS_PER_S)
                message = self.receive(rest_s)
                if message is not None:
                    yield message

    def receive(self, seconds: float) -> TopicMessage | tuple[bytes, int] | None:
        """Return the next message or packet; None if none comes in this wall time.

        Raises:
            ConnectionError: if the flight has ended.
        """
        if not self._unread:
            self._plug.settimeout(max(seconds, LEAST_S))
            with contextlib.suppress(TimeoutError):
                self._unread += self._received()
        return self._message(self._unread.popleft()) if self._unread else None

    def _message(self, message: Mapping[str, Any]) -> TopicMessage | tuple[bytes, int] | None:
        self.lost = message.get("lost", self.lost)
        if "topic" in message:
            fields = (message[name] for name in ("topic", "header", "data", "at_ns", "stamp_ns"))
            return TopicMessage(*fields)
        return (message["packet"], message["at_ns"]) if "packet" in message else None

    def _received(self) -> list[dict[str, Any]]:
        data = self._plug.recv(CHUNK)
        if not data:
            raise ConnectionResetError("the flight has ended")
        return list(self._frames.take(data))
