"""Messages in transit: sequence counts, limits, buffers, and contents (sb_sendrecv_test.c)."""

from __future__ import annotations

import struct

from cfepy.app import Cfe
from cfepy.ids import UNDEFINED
from cfepy.msg import get_msg_id, get_sequence_count, get_user_data, set_sequence_count, set_size
from cfepy.sb import PEND_FOREVER, POLL, MessageBuffer
from cfepy.sb.bus import DEFAULT_QOS
from cfepy.status import CFE_SB_BAD_ARGUMENT, CFE_SB_BUFFER_INVALID, CFE_SB_MSG_TOO_BIG
from tests.functional.harness import CMD_MID, TLM_MID, status_of

VALUE = struct.Struct("<Q")
LARGEST = 32768
HEADER_SIZES = {CMD_MID: 8, TLM_MID: 16}


def message(cfe: Cfe, msg_id: int, value: int, sequence: int = 0) -> bytearray:
    """Return a message whose payload is one number."""
    packet = cfe.msg.init(msg_id, HEADER_SIZES[msg_id] + VALUE.size)
    set_sequence_count(packet, sequence)
    packet[HEADER_SIZES[msg_id] :] = VALUE.pack(value)
    return packet


def value_of(packet: bytes) -> int:
    number: int = VALUE.unpack(get_user_data(packet))[0]
    return number


def listening_pipe(cfe: Cfe, msg_id: int, limit: int, depth: int = 5) -> int:
    pipe = cfe.sb.create_pipe(depth, f"TestPipe {msg_id:x} {limit}")
    cfe.sb.subscribe_ex(msg_id, pipe, DEFAULT_QOS, limit)
    return pipe


def test_basic_transmit_receive(cfe: Cfe) -> None:
    sb = cfe.sb
    for msg_id in (CMD_MID, TLM_MID):
        pipe = listening_pipe(cfe, msg_id, limit=3)
        for value, is_origination in enumerate([True, True, False, True]):  # the limit is reached with the last one
            sb.transmit_msg(message(cfe, msg_id, 0xC0FFEE + value, sequence=11), is_origination)
        got = [sb.receive_buffer(pipe, timeout) for timeout in (PEND_FOREVER, PEND_FOREVER, PEND_FOREVER, 100)]
        received = [packet for packet in got if packet is not None]
        assert [get_msg_id(packet) for packet in received] == [msg_id] * 3
        assert [value_of(packet) for packet in received] == [0xC0FFEE, 0xC0FFEF, 0xC0FFF0]
        assert [get_sequence_count(packet) for packet in received] == [1, 2, 11]
        assert got[3] is None
        assert status_of(sb.receive_buffer, pipe, -100) == CFE_SB_BAD_ARGUMENT
        sb.delete_pipe(pipe)
    assert status_of(sb.receive_buffer, UNDEFINED, 100) == CFE_SB_BAD_ARGUMENT
    assert status_of(sb.transmit_msg, b"\xff" * 10) == CFE_SB_BAD_ARGUMENT
    assert status_of(sb.transmit_msg, cfe.msg.init(CMD_MID, LARGEST + 16)) == CFE_SB_MSG_TOO_BIG


def buffer_of(cfe: Cfe, packet: bytearray) -> MessageBuffer:
    """Return a zero-copy buffer that holds a message."""
    buffer = cfe.sb.allocate_message_buffer(len(packet))
    buffer[:] = packet
    return buffer


def test_zero_copy_transmit_receive(cfe: Cfe) -> None:
    sb, pipes = cfe.sb, {msg_id: listening_pipe(cfe, msg_id, limit=3) for msg_id in (CMD_MID, TLM_MID)}
    assert status_of(sb.allocate_message_buffer, LARGEST + 1) == CFE_SB_MSG_TOO_BIG
    released = buffer_of(cfe, message(cfe, CMD_MID, 1))
    sb.release_message_buffer(released)
    assert status_of(sb.release_message_buffer, released) == CFE_SB_BUFFER_INVALID
    assert status_of(sb.transmit_buffer, released) == CFE_SB_BUFFER_INVALID

    sent = [(1, True, 1), (2, True, 2), (3, False, 1234)]
    for msg_id, pipe in pipes.items():
        for value, is_origination, sequence in sent:
            buffer = buffer_of(cfe, message(cfe, msg_id, value, sequence=1234))
            sb.transmit_buffer(buffer, is_origination)
            assert status_of(sb.transmit_buffer, buffer) == CFE_SB_BUFFER_INVALID, "it is the bus's now"
            packet = sb.receive_buffer(pipe, 100)
            assert packet is not None
            assert (get_msg_id(packet), value_of(packet), get_sequence_count(packet)) == (msg_id, value, sequence)
            assert sb.receive_buffer(pipe, POLL) is None

    largest = buffer_of(cfe, cfe.msg.init(CMD_MID, LARGEST))
    set_size(largest, LARGEST + 16)
    assert status_of(sb.transmit_buffer, largest) == CFE_SB_MSG_TOO_BIG
    set_size(largest, LARGEST)
    sb.transmit_buffer(largest)
    packet = sb.receive_buffer(pipes[CMD_MID], POLL)
    assert packet is not None
    assert (len(packet), get_sequence_count(packet)) == (LARGEST, 3), "the refused one does not count"


def test_msg_broadcast(cfe: Cfe) -> None:
    sb = cfe.sb
    pipes = [listening_pipe(cfe, CMD_MID, limit, depth) for limit, depth in ((1, 3), (2, 3), (4, 3), (6, 5))]

    def broadcast(*values: int) -> list[list[int]]:
        """Send values.

        Returns the values received from the pipes in each round; a round has the same message in all pipes.
        """
        for value in values:
            sb.transmit_msg(message(cfe, CMD_MID, value))
        rounds = []
        while any(got := [sb.receive_buffer(pipe, POLL) for pipe in pipes]):
            packets = [packet for packet in got if packet is not None]
            assert all(packet is packets[0] for packet in packets)
            rounds.append([value_of(packet) if packet is not None else 0 for packet in got])
        return rounds

    assert broadcast(10, 11, 12, 13) == [[10, 10, 10, 10], [0, 11, 11, 11], [0, 0, 12, 12], [0, 0, 0, 13]]
    sb.unsubscribe(CMD_MID, pipes[1])
    assert broadcast(14, 15) == [[14, 0, 14, 14], [0, 0, 15, 15]]


def test_miscellaneous_message_utility_apis(cfe: Cfe) -> None:
    get, put = cfe.msg.message_string_get, cfe.msg.message_string_set
    assert get(b"x" * 12, 16, "abc") == "x" * 12
    assert get(b"w" * 12, 16) == "w" * 12
    assert get(bytes(12), 16, "abc") == "abc"
    assert get(b"", 16, "defg") == "defg"
    assert get(b"", 16) == ""
    assert status_of(get, b"x" * 12, 0, "abc") == CFE_SB_BAD_ARGUMENT
    assert put("z" * 16, 12) == b"z" * 12, "a field that is full ends without a NUL"
    assert put("z", 12) == b"z" + bytes(11)


def test_message_user_data_apis(cfe: Cfe) -> None:
    msg = cfe.msg
    for msg_id in (CMD_MID, TLM_MID):
        packet = message(cfe, msg_id, 5)
        assert msg.get_user_data(packet) == VALUE.pack(5)
        assert msg.get_user_data_length(packet) == VALUE.size
        msg.set_user_data_length(packet, VALUE.size - 2)
        assert msg.get_user_data_length(packet) == VALUE.size - 2
        assert msg.get_size(packet) == HEADER_SIZES[msg_id] + VALUE.size - 2
