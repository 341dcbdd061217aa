"""The door before Foxglove's server: it looks at the request of each connection, and passes bytes on from then on.

It does what the library's server does not: wants the token from programs on other computers, turns pages of strangers
away (RFC 6455, 10.2), counts what went out, and knows when everything is out. It works in a thread of its own; what a
viewer does not take waits in the server, which drops the oldest.
"""

from __future__ import annotations

import asyncio
import contextlib
import socket
import threading
import time
from typing import Any
from urllib.parse import parse_qs, urlsplit

from cfepy.status import UsageError
from cfepy.viewers.listen import Admission, ListenPlace

LONGEST_HEAD = 1 << 14  # bytes
HEAD_S = 10.0  # wall time for a request
CHUNK = 1 << 16
MOST_CONNECTIONS = 64
QUIET_S, PATIENCE_S = 0.05, 1.0  # wall time: nothing more comes then; for which the end of a run waits
SETTLE_S = 0.005  # wall time after which the server knows a channel that it has told of: until then it refuses viewers
HEAD_END = b"\r\n\r\n"
MESSAGE_DATA = 1  # first byte of a binary frame: a message of a channel
APPS = ("https://app.foxglove.dev", "https://studio.foxglove.dev")
"""Pages that are Foxglove itself."""


class FrameCounter:
    """Counts messages in what the server sends: frames as RFC 6455, 5.2 has them, which a server does not mask.

    Attributes:
        messages: so far.
    """

    def __init__(self) -> None:
        self.messages = 0
        self._head = bytearray()  # of the answer to the request, then of a frame
        self._left = -1  # bytes of the payload that are to come; -1 before the first frame

    def add(self, data: bytes) -> None:
        """Bytes go out."""
        at = 0
        if self._left < 0:
            self._head += data
            end = self._head.find(HEAD_END)
            if end < 0:
                return
            data, self._left = bytes(self._head[end + len(HEAD_END) :]), 0
            self._head.clear()
        while at < len(data):
            if self._left:
                step = min(self._left, len(data) - at)
                self._left -= step
                at += step
                continue
            self._head.append(data[at])
            at += 1
            self._begin()

    def _begin(self) -> None:
        """The head of a frame may be whole now, with the first byte of what is in it."""
        head = self._head
        if len(head) < 2:
            return
        length, size = head[1] & 0x7F, 2
        if length > 125:
            size = 4 if length == 126 else 10
            if len(head) < size:
                return
            length = int.from_bytes(head[2:size], "big")
        if length and len(head) == size:
            return
        if length:
            self.messages += head[0] & 0x0F == 2 and head[size] == MESSAGE_DATA
            self._left = length - 1
        head.clear()


class ViewerDoor:
    """Listens, and lets viewers through to the server.

    Args:
        place: where it listens.
        admission: whom it lets in.
        server: where the server is: host and port.

    Raises:
        UsageError: the port is taken.

    Attributes:
        place: with the port that was free.
        admitted, refused, ended: connections.
        messages, size: of channels, that went out; and all bytes.
        why: why one was refused, at last.
    """

    def __init__(self, place: ListenPlace, admission: Admission, server: tuple[str, int]) -> None:
        self._admission = admission
        self._server = server
        self.admitted = self.refused = self.ended = 0
        self.messages = self.size = 0
        self.why = ""
        self._open: set[asyncio.StreamWriter] = set()
        self._busy_s = 0.0
        self._socket = _listening(place)
        self.place = ListenPlace(place.host, int(self._socket.getsockname()[1]))
        self._loop = asyncio.new_event_loop()
        self._over = asyncio.Event()
        self._thread = threading.Thread(target=self._work, name="foxglove door", daemon=True)
        self._thread.start()

    def drain(self) -> None:
        """Wait until everything is out, for a second at most."""
        end_s = time.monotonic() + PATIENCE_S
        self._busy_s = time.monotonic()
        while self._open and time.monotonic() < end_s and time.monotonic() - self._busy_s < QUIET_S:
            time.sleep(QUIET_S / 5)

    def close(self) -> None:
        """Listen no more; connections of which the server has taken leave end by themselves, others are ended."""
        end_s = time.monotonic() + PATIENCE_S
        while self._open and time.monotonic() < end_s:
            time.sleep(QUIET_S / 5)
        self._loop.call_soon_threadsafe(self._over.set)
        self._thread.join(PATIENCE_S)

    def _work(self) -> None:
        try:
            self._loop.run_until_complete(self._serve())
        finally:
            self._loop.close()

    async def _serve(self) -> None:
        server = await asyncio.start_server(self._connected, sock=self._socket, limit=LONGEST_HEAD)
        await self._over.wait()
        server.close()
        tasks = [each for each in asyncio.all_tasks() if each is not asyncio.current_task()]
        for each in tasks:
            each.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    # -- one connection ----------------------------------------------------------------------------------------------

    async def _connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            head = await asyncio.wait_for(reader.readuntil(HEAD_END), HEAD_S)
            status, why = self._verdict(head)
            if why:
                self.refused += 1
                self.why = why
                body = f"{why}\n".encode()
                about = f"Connection: close\r\nContent-Length: {len(body)}\r\n\r\n"
                writer.write(f"HTTP/1.1 {status}\r\n{about}".encode() + body)
                await writer.drain()
            else:
                await self._pass_on(head, reader, writer)
        except (OSError, asyncio.IncompleteReadError, asyncio.LimitOverrunError, TimeoutError):
            self.refused += 1
            self.why = "that was no request for a WebSocket"
        except asyncio.CancelledError:
            pass  # the run is over
        finally:
            writer.close()

    def _verdict(self, head: bytes) -> tuple[str, str]:
        """The status of an answer that turns a request down, and why; no reason lets it in."""
        request, *lines = head.decode("latin-1").split("\r\n")
        fields = {name.strip().lower(): value.strip() for name, _, value in (line.partition(":") for line in lines)}
        target = [*request.split(" "), "", ""][1]
        admission = self._admission
        if admission.token:
            try:
                shown = parse_qs(urlsplit(target).query).get("token", [""])[0]
            except ValueError:
                shown = ""
            return ("", "") if admission.knows(shown) else ("401 Unauthorized", "the token is missing or wrong")
        origin = fields.get("origin")
        if not _is_app(origin) and not admission.welcomes(origin):
            return "403 Forbidden", f"pages of {origin!r:.100} are strangers"
        if len(self._open) >= MOST_CONNECTIONS:
            return "503 Service Unavailable", f"{MOST_CONNECTIONS} viewers are connected already"
        return "", ""

    async def _pass_on(self, head: bytes, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        inner, outer = await asyncio.open_connection(*self._server)
        self.admitted += 1
        self._open.add(writer)
        for each in (writer, outer):
            with contextlib.suppress(OSError):
                each.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        outer.write(head)
        ways = [asyncio.create_task(_copy(reader, outer)), asyncio.create_task(self._out(inner, writer))]
        try:
            await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
            if not ways[1].done():  # the viewer has said its last; the server may have an answer to that
                await asyncio.wait(ways, timeout=PATIENCE_S)
        finally:
            for way in ways:
                way.cancel()
            await asyncio.gather(*ways, return_exceptions=True)
            self._open.discard(writer)
            self.ended += 1
            outer.close()

    async def _out(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        counter = FrameCounter()
        while data := await reader.read(CHUNK):
            self._busy_s = time.monotonic()
            before = counter.messages
            counter.add(data)
            writer.write(data)
            await writer.drain()
            self.messages += counter.messages - before
            self.size += len(data)


async def _copy(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """From a viewer to the server."""
    while data := await reader.read(CHUNK):
        await asyncio.sleep(SETTLE_S)
        writer.write(data)
        await writer.drain()
    writer.write_eof()


def _is_app(origin: str | None) -> bool:
    """Whether a page is Foxglove's own: from its site, or in a program that has windows of its own, such as Electron.

    What has another scheme than http and https is no page of a site: browsers say "null" for what they do not trust.
    """
    if origin is None or origin.rstrip("/") in APPS:
        return True
    scheme, mark, _ = origin.partition("://")
    return bool(mark) and scheme.lower() not in ("http", "https")


def _listening(place: ListenPlace) -> Any:
    family = socket.AF_INET6 if ":" in place.host else socket.AF_INET
    opened = socket.socket(family, socket.SOCK_STREAM)
    try:
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        opened.bind((place.host, place.port))
        opened.listen(MOST_CONNECTIONS)
    except OSError as error:
        opened.close()
        remedy = "another program may have it; give another port"
        raise UsageError(f"{place} cannot be opened: {error.strerror}; {remedy}", field="--foxglove") from None
    opened.setblocking(False)
    return opened
