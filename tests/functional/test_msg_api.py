"""Fields of message headers: accepted values, and their results (msg_api_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.msg import CMD_HEADER_SIZE, HIGHEST_VALID_MSG_ID, TLM_HEADER_SIZE, MsgType, SegmentationFlag
from cfepy.status import CFE_MSG_BAD_ARGUMENT, CFE_MSG_WRONG_MSG_TYPE
from tests.functional.harness import CMD_MID, status_of


def test_basic_message_header_apis(cfe: Cfe) -> None:
    msg = cfe.msg
    for msg_id, size in [(0, CMD_HEADER_SIZE), (CMD_MID, 0), (HIGHEST_VALID_MSG_ID + 1, CMD_HEADER_SIZE)]:
        assert status_of(msg.init, msg_id, size) == CFE_MSG_BAD_ARGUMENT
    command = msg.init(CMD_MID, CMD_HEADER_SIZE)

    for size in (0, 0xFFFFFFFF):
        assert status_of(msg.set_size, command, size) == CFE_MSG_BAD_ARGUMENT
    msg.set_size(command, 12)
    assert msg.get_size(command) == 12

    assert status_of(msg.set_type, command, MsgType.INVALID) == CFE_MSG_BAD_ARGUMENT
    for kind in (MsgType.CMD, MsgType.TLM):
        msg.set_type(command, kind)
        assert msg.get_type(command) == kind

    assert msg.get_header_version(command) == 0
    assert status_of(msg.set_header_version, command, 0xFFFF) == CFE_MSG_BAD_ARGUMENT
    msg.set_header_version(command, 0)
    assert msg.get_header_version(command) == 0

    for present in (False, True):
        msg.set_has_secondary_header(command, present)
        assert msg.get_has_secondary_header(command) is present

    assert status_of(msg.set_ap_id, command, 0xFFFF) == CFE_MSG_BAD_ARGUMENT
    msg.set_ap_id(command, 5)
    assert msg.get_ap_id(command) == 5


def test_advanced_message_header_apis(cfe: Cfe) -> None:
    msg = cfe.msg
    command = msg.init(CMD_MID, CMD_HEADER_SIZE)
    for invalid in (SegmentationFlag.INVALID, SegmentationFlag.UNSEGMENTED + 1):
        assert status_of(msg.set_segmentation_flag, command, invalid) == CFE_MSG_BAD_ARGUMENT
    for flag in list(SegmentationFlag)[1:]:
        msg.set_segmentation_flag(command, flag)
        assert msg.get_segmentation_flag(command) == flag

    assert status_of(msg.set_sequence_count, command, 0xFFFF) == CFE_MSG_BAD_ARGUMENT
    msg.set_sequence_count(command, 2)
    assert msg.get_sequence_count(command) == 2
    assert msg.get_next_sequence_count(2) == 3
    assert msg.get_next_sequence_count(0xFFFF) == 0


def test_message_secondary_header_apis(cfe: Cfe) -> None:
    msg = cfe.msg
    command, telemetry = msg.init(1, CMD_HEADER_SIZE), msg.init(2, TLM_HEADER_SIZE)
    for packet, kind in ((command, MsgType.CMD), (telemetry, MsgType.TLM)):
        msg.set_has_secondary_header(packet, True)
        msg.set_type(packet, kind)

    assert msg.validate_checksum(command) is False
    msg.generate_checksum(command)
    assert msg.validate_checksum(command) is True
    assert status_of(msg.validate_checksum, telemetry) == CFE_MSG_WRONG_MSG_TYPE
    assert status_of(msg.generate_checksum, telemetry) == CFE_MSG_WRONG_MSG_TYPE

    assert status_of(msg.set_fcn_code, telemetry, 4) == CFE_MSG_WRONG_MSG_TYPE
    assert status_of(msg.get_fcn_code, telemetry) == CFE_MSG_WRONG_MSG_TYPE
    msg.set_fcn_code(command, 4)
    assert msg.get_fcn_code(command) == 4

    time = (1000, 0xFFFF0000)
    msg.set_msg_time(telemetry, time)
    assert msg.get_msg_time(telemetry) == time
    assert status_of(msg.set_msg_time, command, time) == CFE_MSG_WRONG_MSG_TYPE
    assert status_of(msg.get_msg_time, command) == CFE_MSG_WRONG_MSG_TYPE
