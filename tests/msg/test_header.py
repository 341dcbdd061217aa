"""Header fields: ranges, wrong kinds, short buffers."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy import msg, status
from cfepy.msg import MsgType, SegmentationFlag
from cfepy.status import CfeError


def test_init() -> None:
    packet = msg.init(0x1806, 10)
    assert packet.hex() == "1806c000000300000000"
    assert msg.get_segmentation_flag(packet) is SegmentationFlag.UNSEGMENTED
    assert msg.get_has_secondary_header(packet)
    assert msg.get_header_version(packet) == 0


@pytest.mark.parametrize(("msg_id", "size"), [(0, 8), (0x2000, 8), (0x1806, 6), (0x1806, 65543), (-1, 8)])
def test_init_refuses(msg_id: int, size: int) -> None:
    with pytest.raises(CfeError) as caught:
        msg.init(msg_id, size)
    assert caught.value.status == status.CFE_MSG_BAD_ARGUMENT


@pytest.mark.parametrize(
    ("setter", "bad"),
    [
        (msg.set_header_version, 8),
        (msg.set_type, MsgType.INVALID),
        (msg.set_ap_id, 0x800),
        (msg.set_segmentation_flag, SegmentationFlag.INVALID),
        (msg.set_segmentation_flag, 5),
        (msg.set_sequence_count, 0x4000),
        (msg.set_size, 6),
        (msg.set_fcn_code, 128),
        (msg.set_msg_id, 0),
    ],
)
def test_setters_refuse_invalid_values_and_change_nothing(setter: Callable[[bytearray, int], None], bad: int) -> None:
    packet = msg.init(0x1806, 8)
    before = bytes(packet)
    with pytest.raises(CfeError, match="CFE_SB_BAD_ARGUMENT"):
        setter(packet, bad)
    assert packet == before


@pytest.mark.parametrize("getter", [msg.get_msg_id, msg.get_size, msg.get_fcn_code, msg.get_msg_time])
def test_short_buffers_are_an_argument_error(getter: Callable[[bytes], object]) -> None:
    for size in range(6):
        with pytest.raises(CfeError, match="CFE_SB_BAD_ARGUMENT"):
            getter(bytes(size))


def test_setters_never_lengthen_a_short_buffer() -> None:
    packet = bytearray(4)
    with pytest.raises(CfeError):
        msg.set_size(packet, 20)
    assert len(packet) == 4


def test_sequence_count_wraps() -> None:
    assert msg.get_next_sequence_count(0) == 1
    assert msg.get_next_sequence_count(0x3FFF) == 0


def test_wrong_kind() -> None:
    command, telemetry = msg.init(0x1806, 16), msg.init(0x0806, 16)
    for call in (
        lambda: msg.get_fcn_code(telemetry),
        lambda: msg.set_fcn_code(telemetry, 1),
        lambda: msg.generate_checksum(telemetry),
        lambda: msg.validate_checksum(telemetry),
        lambda: msg.get_msg_time(command),
        lambda: msg.set_msg_time(command, (1, 2)),
    ):
        with pytest.raises(CfeError) as caught:
            call()
        assert caught.value.status == status.CFE_MSG_WRONG_MSG_TYPE


def test_wrong_kind_has_precedence_over_a_short_packet() -> None:
    with pytest.raises(CfeError) as caught:
        msg.get_msg_time(msg.command(0x1806, 0))
    assert caught.value.status == status.CFE_MSG_WRONG_MSG_TYPE


def test_checksum_covers_only_the_size_of_the_header() -> None:
    packet = msg.command(0x1806, 3, b"\x01\x02")
    padded = packet + b"\xff\x01"
    assert msg.validate_checksum(padded)
    with pytest.raises(CfeError):
        msg.validate_checksum(packet[:9])


def test_long_and_short_packets_have_the_same_checksum_rule() -> None:
    for size in (0, 1, 23, 24, 25, 31, 32, 33, 1000, 4097):
        packet = msg.command(0x1806, 1, bytes(range(256))[: size % 256] * (size // 256 + 1))
        folded = 0
        for byte in packet:
            folded ^= byte
        assert folded == 0xFF
        assert msg.validate_checksum(packet)


def test_origination_does_not_change_other_packets() -> None:
    bare = msg.init(0x0006, 16)
    before = bytes(bare)
    msg.origination_action(bare, 1 << 40)
    assert bare == before
    assert msg.verification_action(bare)


def test_user_data() -> None:
    command, telemetry, bare = msg.command(0x1806, 0, b"abc"), msg.telemetry(0x0806, b"abc"), msg.init(0x0006, 9)
    assert [msg.get_header_size(packet) for packet in (command, telemetry, bare)] == [8, 16, 6]
    assert bytes(msg.get_user_data(command)) == bytes(msg.get_user_data(telemetry)) == b"abc"
    assert [msg.get_user_data_length(packet) for packet in (command, telemetry, bare)] == [3, 3, 3]


def test_set_user_data_length() -> None:
    packet = msg.command(0x1806, 0, bytes(20))
    msg.set_user_data_length(packet, 5)
    assert (msg.get_size(packet), msg.get_user_data_length(packet), len(packet)) == (13, 5, 28)
    with pytest.raises(CfeError, match="CFE_SB_BAD_ARGUMENT"):
        msg.set_user_data_length(packet, 32761)


def test_extended_fields_are_refused() -> None:
    packet = msg.init(0x1806, 8)
    for getter in (msg.get_eds_version, msg.get_endian, msg.get_playback_flag, msg.get_subsystem, msg.get_system):
        with pytest.raises(CfeError) as caught:
            getter(packet)
        assert caught.value.status == status.CFE_MSG_NOT_IMPLEMENTED
    for setter in (msg.set_eds_version, msg.set_endian, msg.set_playback_flag, msg.set_subsystem, msg.set_system):
        with pytest.raises(CfeError, match="extended header"):
            setter(packet, 1)


def test_topics() -> None:
    assert msg.local_cmd_topic_id_to_msg_id(6) == msg.cmd_topic_id_to_msg_id(6, 1) == 0x1806
    assert msg.local_tlm_topic_id_to_msg_id(0) == msg.tlm_topic_id_to_msg_id(0, 3) == 0x0800
    assert msg.cmd_topic_id_to_msg_id(2, 0) == msg.global_cmd_topic_id_to_msg_id(2) == 0x1862
    assert msg.tlm_topic_id_to_msg_id(2, 0) == msg.global_tlm_topic_id_to_msg_id(2) == 0x0862
    assert msg.msg_id_equal(msg.value_to_msg_id(0x1806), msg.msg_id_to_value(0x1806))
