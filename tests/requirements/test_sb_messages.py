"""Requirements of the Software Bus about single messages: reading and writing by `cfe.msg` (cSB4311-4328,
4335-4352)."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from operator import xor

import pytest

from cfepy.app import Cfe
from cfepy.msg import MsgType, SegmentationFlag
from cfepy.status import CFE_MSG_BAD_ARGUMENT, CFE_MSG_WRONG_MSG_TYPE, CfeError
from tests.requirements.covers import covers
from tests.requirements.flight import Flight

TLM, CMD = 0x0FD1, 0x1FD1


@pytest.fixture
def cfe(fly: Callable[..., Flight]) -> Cfe:
    return fly().cfe


@covers("cSB4311", "cSB4312")
def test_cSB4311_message_id(cfe: Cfe) -> None:
    packet = cfe.msg.init(TLM, 20)
    assert cfe.msg.get_msg_id(packet) == TLM
    cfe.msg.set_msg_id(packet, CMD)
    assert cfe.msg.get_msg_id(packet) == CMD
    assert packet[:2] == CMD.to_bytes(2, "big")


@covers("cSB4313", "cSB4314")
def test_cSB4313_strings(cfe: Cfe) -> None:
    field = cfe.msg.message_string_set("abc", 5)
    assert field == b"abc\0\0"
    assert cfe.msg.message_string_get(field, 20) == "abc"
    assert cfe.msg.message_string_set("abcdefgh", 5) == b"abcde"
    assert cfe.msg.message_string_get(b"abcde", 20) == "abcde"
    assert cfe.msg.message_string_get(b"abcde", 4) == "abc", "room for the NUL of C"
    assert cfe.msg.message_string_get(b"\0", 20, "usual") == "usual"


def test_cSB4315_init(cfe: Cfe) -> None:
    packet = cfe.msg.init(CMD, 24)
    assert len(packet) == cfe.msg.get_size(packet) == 24
    assert cfe.msg.get_msg_id(packet) == CMD
    assert bytes(packet[:6]) == bytes.fromhex("1FD1 C000 0011")  # not segmented, count 0, 17 bytes and one behind here
    assert set(packet[6:]) == {0}


@covers("cSB4316", "cSB4317", "cSB4318")
def test_cSB4316_user_data(cfe: Cfe) -> None:
    for packet in (cfe.msg.command(CMD, 1, b"payload"), cfe.msg.telemetry(TLM, b"payload")):
        assert bytes(cfe.msg.get_user_data(packet)) == b"payload"
        assert cfe.msg.get_user_data_length(packet) == 7
        cfe.msg.set_user_data_length(packet, 5)
        assert cfe.msg.get_user_data_length(packet) == 5


@covers("cSB4319", "cSB4320")
def test_cSB4319_total_length(cfe: Cfe) -> None:
    packet = cfe.msg.init(TLM, 30)
    cfe.msg.set_size(packet, 17)
    assert cfe.msg.get_size(packet) == 17
    assert int.from_bytes(packet[4:6], "big") == 10


@covers("cSB4321", "cSB4322")
def test_cSB4321_time(cfe: Cfe) -> None:
    packet = cfe.msg.telemetry(TLM)
    cfe.msg.set_msg_time(packet, (1_000_000, 0xABCD0000))
    assert cfe.msg.get_msg_time(packet) == (1_000_000, 0xABCD0000)
    assert bytes(packet[6:12]) == bytes.fromhex("000F4240 ABCD")
    with pytest.raises(CfeError) as caught:
        cfe.msg.get_msg_time(cfe.msg.command(CMD, 0))
    assert caught.value.status == CFE_MSG_WRONG_MSG_TYPE


@covers("cSB4324", "cSB4325")
def test_cSB4324_command_code(cfe: Cfe) -> None:
    packet = cfe.msg.command(CMD, 3)
    assert cfe.msg.get_fcn_code(packet) == 3
    cfe.msg.set_fcn_code(packet, 127)
    assert cfe.msg.get_fcn_code(packet) == packet[6] == 127


@covers("cSB4327", "cSB4328")
def test_cSB4327_checksum(cfe: Cfe) -> None:
    packet = cfe.msg.command(CMD, 3, b"payload")
    assert cfe.msg.validate_checksum(packet)
    packet[-1] ^= 1
    assert not cfe.msg.validate_checksum(packet)
    cfe.msg.generate_checksum(packet)
    assert cfe.msg.validate_checksum(packet)
    assert reduce(xor, packet) == 0xFF


@covers("cSB4335", "cSB4336", "cSB4337", "cSB4345")
def test_cSB4335_message_ids_are_compared_converted_and_judged(cfe: Cfe) -> None:
    assert cfe.msg.msg_id_equal(TLM, TLM)
    assert not cfe.msg.msg_id_equal(TLM, CMD)
    assert cfe.msg.msg_id_to_value(TLM) == cfe.msg.value_to_msg_id(0x0FD1) == 0x0FD1
    assert [cfe.sb.is_valid_msg_id(each) for each in (0, 1, 0x1FFF, 0x2000)] == [False, True, True, False]
    assert [cfe.msg.is_valid_msg_id(each) for each in (0, 1, 0x1FFF, 0x2000)] == [False, True, True, False]


@covers("cSB4344", "cSB4346", "cSB4352")
def test_cSB4344_packet_type(cfe: Cfe) -> None:
    packet = cfe.msg.init(TLM, 20)
    assert cfe.msg.get_type(packet) is cfe.msg.get_type_from_msg_id(TLM) is MsgType.TLM
    cfe.msg.set_type(packet, MsgType.CMD)
    assert cfe.msg.get_type(packet) is cfe.msg.get_type_from_msg_id(CMD) is MsgType.CMD
    assert cfe.msg.get_msg_id(packet) == CMD
    cfe.msg.set_type(packet, MsgType.TLM)
    assert cfe.msg.get_msg_id(packet) == TLM


@covers("cSB4347", "cSB4348")
@pytest.mark.parametrize(
    ("field", "before", "good", "header", "bad"),
    [
        ("header_version", 0, 5, "BFD1 C000", 8),
        ("ap_id", 0x7D1, 0x7FE, "1FFE C000", 0x800),
        ("segmentation_flag", SegmentationFlag.UNSEGMENTED, SegmentationFlag.LAST, "1FD1 8000", 0),
        ("has_secondary_header", True, False, "17D1 C000", None),
    ],
)
def test_cSB4347_header_fields(cfe: Cfe, field: str, before: int, good: int, header: str, bad: int | None) -> None:
    packet = cfe.msg.init(CMD, 20)
    get, put = getattr(cfe.msg, f"get_{field}"), getattr(cfe.msg, f"set_{field}")
    assert get(packet) == before
    put(packet, good)
    assert get(packet) == good
    assert bytes(packet[:4]) == bytes.fromhex(header)
    if bad is not None:
        with pytest.raises(CfeError) as caught:
            put(packet, bad)
        assert caught.value.status == CFE_MSG_BAD_ARGUMENT
        assert get(packet) == good


@covers("cSB4349", "cSB4350", "cSB4351")
def test_cSB4349_sequence_count(cfe: Cfe) -> None:
    packet = cfe.msg.init(TLM, 20)
    cfe.msg.set_sequence_count(packet, 0x3FFF)
    assert cfe.msg.get_sequence_count(packet) == 0x3FFF
    cfe.msg.set_sequence_count(packet, 0x1234)
    assert bytes(packet[2:4]) == bytes.fromhex("D234"), "the segmentation flags stay"
    assert cfe.msg.get_next_sequence_count(0x3FFF) == 0
    assert cfe.msg.get_next_sequence_count(7) == 8
