"""TCPROS on the wire; the bytes are those of rospy 1.15.15."""

from __future__ import annotations

import pytest

from cfepy.extra.ros_host.tcpros import TcprosFrames, WireError, frame, pack_header, parse_header

# Of rosgraph.network.encode_ros_handshake_header.
HEADER = b" \x00\x00\x00\x08\x00\x00\x00topic=/a\x10\x00\x00\x00type=std_msgs/a="


def test_a_header_is_a_frame_of_fields() -> None:
    assert pack_header({"topic": "/a", "type": "std_msgs/a="}) == HEADER
    assert parse_header(HEADER[4:]) == {"topic": "/a", "type": "std_msgs/a="}


@pytest.mark.parametrize("damaged", [b"\x01\x00", b"\x09\x00\x00\x00a=b", b"\x03\x00\x00\x00abc"])
def test_damaged_header_is_refused(damaged: bytes) -> None:
    with pytest.raises(WireError):
        parse_header(damaged)


def test_frames_are_parsed_from_any_pieces() -> None:
    stream = frame(b"one") + frame(b"") + frame(b"three")
    for size in range(1, len(stream) + 1):
        frames = TcprosFrames()
        found = []
        for at in range(0, len(stream), size):
            frames.add(stream[at : at + size])
            found += list(frames.take())
        assert found == [b"one", b"", b"three"], size


def test_answer_begins_with_a_status_byte() -> None:
    frames = TcprosFrames()
    frames.add(frame(b"header") + b"\x01" + frame(b"good") + b"\x00" + frame(b"bad"))
    found = []
    for each in frames.take():
        found.append(each)
        frames.has_status = True
    assert found == [b"header", b"\x01good", b"\x00bad"]


def test_impossible_length_ends_the_connection() -> None:
    frames = TcprosFrames()
    frames.add(b"GET / HTTP/1.1\r\n\r\n")
    with pytest.raises(WireError, match="not TCPROS"):
        list(frames.take())
