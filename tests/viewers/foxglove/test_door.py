"""Whom the door lets through, and what it counts."""

from __future__ import annotations

import socket
import struct
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.exceptions import InvalidStatus

from cfepy.io import PeerCounts
from cfepy.status import UsageError
from cfepy.viewers.foxglove import FoxgloveViewer
from cfepy.viewers.foxglove.door import FrameCounter
from cfepy.viewers.listen import Admission, ListenPlace
from tests.viewers.foxglove.client import FoxgloveClient
from tests.viewers.foxglove.runs import shown, spec_of

HEAD = b"HTTP/1.1 101 Switching Protocols\r\nConnection: Upgrade\r\n\r\n"
TOKEN = "a-long-enough-token"


def frame(opcode: int, payload: bytes) -> bytes:
    """A frame of a server (RFC 6455, 5.2)."""
    if len(payload) < 126:
        return bytes([0x80 | opcode, len(payload)]) + payload
    if len(payload) < 1 << 16:
        return struct.pack(">BBH", 0x80 | opcode, 126, len(payload)) + payload
    return struct.pack(">BBQ", 0x80 | opcode, 127, len(payload)) + payload


FRAMES = st.lists(
    st.one_of(
        st.tuples(st.just(2), st.just(b"\x01"), st.sampled_from([0, 12, 124, 125, 126, 300, 70_000])),
        st.tuples(st.just(2), st.sampled_from([b"\x02", b"\x03"]), st.integers(0, 200)),
        st.tuples(st.sampled_from([1, 9, 8]), st.sampled_from([b"", b"\x01", b"{"]), st.integers(0, 30)),
    ),
    max_size=12,
)


@given(frames=FRAMES, cuts=st.lists(st.integers(1, 400), max_size=20))
def test_messages_are_counted_however_the_bytes_are_cut(frames: list[tuple[int, bytes, int]], cuts: list[int]) -> None:
    data = HEAD + b"".join(frame(opcode, first + bytes(more)) for opcode, first, more in frames)
    counter = FrameCounter()
    for cut in cuts:
        counter.add(data[:cut])
        data = data[cut:]
    counter.add(data)
    assert counter.messages == sum(opcode == 2 and first == b"\x01" for opcode, first, _ in frames)


def refused(viewer: FoxgloveViewer, path: str = "/", origin: str | None = None) -> int:
    """The status with which a connection is refused; 101 when it is not."""
    headers = {} if origin is None else {"Origin": origin}
    try:
        FoxgloveClient(f"ws://{viewer.place}{path}", additional_headers=headers).socket.close()
    except InvalidStatus as error:
        return error.response.status_code
    return 101


def test_pages_of_strangers_are_refused_and_foxglove_is_not(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {})) as run:
        for origin in (None, "https://app.foxglove.dev", "http://localhost:8080", "file://", "app://lichtblick"):
            assert refused(run.viewer, origin=origin) == 101, origin
        for origin in ("https://example.org", "null", "https://app.foxglove.dev.example.org"):
            assert refused(run.viewer, origin=origin) == 403, origin
        run.viewer.close()
        row = run.rows()["(connections)", "out"]
        assert (row["connections"], row["refused"]) == (5, 3)
        assert "example.org" in row["why"]


def test_a_token_is_wanted_of_everybody_where_there_is_one(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {}), Admission(TOKEN)) as run:
        assert refused(run.viewer) == 401
        assert refused(run.viewer, "/?token=wrong-one", "https://app.foxglove.dev") == 401
        assert refused(run.viewer, f"/?token={TOKEN}") == 101
        assert refused(run.viewer, f"/?token={TOKEN}", "https://example.org") == 101


@pytest.mark.parametrize(
    "data", [b"", b"GET / HTTP/1.1\r\n", b"\x16\x03\x01" + b"\xff" * 300 + b"\r\n\r\n", b"x" * 70_000]
)
def test_what_is_no_request_harms_nobody(tmp_path: Path, data: bytes) -> None:
    with shown(spec_of(tmp_path, {})) as run:
        with socket.create_connection((run.viewer.place.host, run.viewer.place.port)) as peer:
            peer.settimeout(10)
            try:
                peer.sendall(data)
                peer.shutdown(socket.SHUT_WR)
                while peer.recv(1000):
                    pass
            except ConnectionError:
                pass  # what comes after the end of the connection is reset
        assert refused(run.viewer) == 101


def test_a_port_that_is_taken_is_told(tmp_path: Path) -> None:
    with shown(spec_of(tmp_path, {})) as run, pytest.raises(UsageError, match=r"--foxglove: .*give another port"):
        FoxgloveViewer(ListenPlace("127.0.0.1", run.viewer.place.port), Admission(), "other", PeerCounts())
