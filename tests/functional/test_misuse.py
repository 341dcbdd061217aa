"""Beyond NASA's segments: arguments that only Python allows, and that must not harm the core.

Numbers of more bits than C's, names with multi-byte characters, functions that do not return a number.
"""

from __future__ import annotations

from typing import Any

import pytest

from cfepy.app import Cfe
from cfepy.fs import read_header
from cfepy.mission import Mission
from cfepy.osal.limits import OS_FILE_FLAG_CREATE, OS_READ_WRITE
from cfepy.sb import POLL
from cfepy.sb import packets as sb_pk
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_CDS_INVALID_NAME,
    CFE_ES_CDS_INVALID_SIZE,
    CFE_EVS_UNKNOWN_FILTER,
    CFE_FS_BAD_ARGUMENT,
    CFE_SB_PIPE_CR_ERR,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CFE_SUCCESS,
    CFE_TBL_ERR_INVALID_NAME,
)
from cfepy.tbl import OPT_CRITICAL
from cfepy.tbl import packets as tbl_pk
from tests.functional.harness import CMD_MID, TLM_MID, status_of
from tests.functional.tables import FULL_NAME, NAME, SIZE


def test_names_are_counted_in_bytes(cfe: Cfe) -> None:
    assert status_of(cfe.es.register_gen_counter, "é" * 10) == CFE_ES_BAD_ARGUMENT
    assert status_of(cfe.es.register_gen_counter, "é" * 9) == CFE_SUCCESS
    assert status_of(cfe.es.register_cds, 10, "é" * 9) == CFE_ES_CDS_INVALID_NAME
    assert status_of(cfe.es.register_cds, 10, "é" * 8) == CFE_SUCCESS
    assert status_of(cfe.tbl.register, "é" * 8, SIZE) == CFE_TBL_ERR_INVALID_NAME
    assert status_of(cfe.tbl.register, "é" * 7, SIZE) == CFE_SUCCESS
    assert status_of(cfe.sb.create_pipe, 5, "é" * 10) == CFE_SB_PIPE_CR_ERR


def test_pipe_options_have_8_bits(cfe: Cfe, mission: Mission) -> None:
    pipe = cfe.sb.create_pipe(5, "Pipe")
    cfe.sb.set_pipe_opts(pipe, 0x102)
    assert cfe.sb.get_pipe_opts(pipe) == 2
    cfe.sb.transmit_msg(sb_pk.WRITE_PIPE_INFO.packet(Filename="/ram/pipes.dat"))
    cfe.os.task_delay(2000)
    assert read_header(mission.files.read_file("/ram/pipes.dat")).length == 64


def test_quality_of_a_subscription_has_16_bits(cfe: Cfe) -> None:
    cfe.sb.transmit_msg(sb_pk.ENABLE_SUB_REPORTING.packet())
    reports = cfe.sb.create_pipe(3, "Reports")
    cfe.sb.subscribe_local(sb_pk.ONESUB_TLM.msg_id, reports, 2)
    assert status_of(cfe.sb.subscribe_ex, CMD_MID, reports, 0x12345678, 0x10002) == CFE_SUCCESS
    report = cfe.sb.receive_buffer(reports, POLL)
    assert report is not None
    assert sb_pk.ONESUB_TLM.read(report)["Qos"] == {"Priority": 0x78, "Reliability": 0x56}


def test_numbers_in_file_headers_have_32_bits(cfe: Cfe) -> None:
    file = cfe.os.open_create("/ram/file", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    assert status_of(cfe.fs.write_header, file, cfe.fs.init_header("", 1 << 32)) == CFE_FS_BAD_ARGUMENT
    assert status_of(cfe.fs.set_timestamp, file, (1 << 32, 0)) == CFE_FS_BAD_ARGUMENT


@pytest.mark.parametrize(("said", "told"), [(0, 0), (-5, -5), (7, 7), (1 << 40, 0), (-(1 << 40) - 5, -5)])
def test_status_of_a_table_validation_reaches_the_ground(cfe: Cfe, said: int, told: int) -> None:
    assert validation_told(cfe, said) == told


@pytest.mark.parametrize("said", [None, 2.5, "good"])
def test_table_validation_without_a_number_has_failed(cfe: Cfe, said: object) -> None:
    assert validation_told(cfe, said) == -1


def validation_told(cfe: Cfe, said: Any) -> int:
    """Return LastValStatus in housekeeping after a validation function's result."""
    answers: list[Any] = [0, said]
    handle = cfe.tbl.register(NAME, SIZE, 0, lambda image: answers.pop(0))
    cfe.tbl.load(handle, bytes(SIZE))
    pipe = cfe.sb.create_pipe(5, "Housekeeping")
    cfe.sb.subscribe(tbl_pk.HK_TLM.msg_id, pipe)
    cfe.sb.transmit_msg(tbl_pk.VALIDATE.packet(ActiveTableFlag=tbl_pk.ACTIVE_BUFFER, TableName=FULL_NAME))
    try:
        cfe.tbl.manage(handle)
    except TypeError:
        assert not isinstance(said, int)
    cfe.sb.transmit_msg(tbl_pk.SEND_HK.packet())
    packet = cfe.sb.receive_buffer(pipe, 100)
    assert packet is not None
    status: int = tbl_pk.HK_TLM.read(packet)["LastValStatus"]
    return status


def test_table_notification_is_sent_or_reported(cfe: Cfe) -> None:
    handle = cfe.tbl.register(NAME, SIZE, 0, lambda image: 0)
    cfe.tbl.load(handle, bytes(SIZE))
    pipe = cfe.sb.create_pipe(5, "Requests")
    cfe.sb.subscribe(CMD_MID, pipe)
    validate = tbl_pk.VALIDATE.packet(ActiveTableFlag=tbl_pk.ACTIVE_BUFFER, TableName=FULL_NAME)

    def notification(*wish: int) -> bytes | None:
        cfe.tbl.notify_by_message(handle, *wish)
        cfe.sb.transmit_msg(validate)
        packet = cfe.sb.receive_buffer(pipe, 100)
        cfe.tbl.manage(handle)
        return packet

    packet = notification(CMD_MID, 5, 0xFFFFFFFE)
    assert packet is not None
    assert cfe.msg.get_fcn_code(packet) == 5
    assert tbl_pk.NOTIFY_COMMAND.unpack(packet, 8)["Parameter"] == 0xFFFFFFFE
    packet = notification(CMD_MID, 5, -2)
    assert packet is not None
    assert tbl_pk.NOTIFY_COMMAND.unpack(packet, 8)["Parameter"] == 0xFFFFFFFE, "32 bits"
    for wish in ((CMD_MID, 200, 0), (TLM_MID, 5, 0), (0, 5, 0)):
        assert notification(*wish) is None
    assert notification(CMD_MID, 5, 0) is not None, "Table Services are still there"


def test_registration_of_a_cds_block_is_refused_before_events_are_available(cfe: Cfe) -> None:
    assert status_of(cfe.evs.register, (), 99) == CFE_EVS_UNKNOWN_FILTER
    assert status_of(cfe.es.register_cds, 0, "Block") == CFE_ES_CDS_INVALID_SIZE


def test_failed_timestamp_of_a_header_is_logged(cfe: Cfe) -> None:
    assert status_of(cfe.fs.set_timestamp, 0, (1, 2)) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL
    assert cfe.es.syslog.read().endswith(b" CFE_FS_SetTimestamp: Failed to lseek time fields (Status=-16)\n")


def test_statuses_of_osal_and_psp_are_decimal_texts(cfe: Cfe) -> None:
    assert [cfe.os.status_to_string(each) for each in (0, -35, 0xCA000003)] == ["0", "-35", "-905969661"]
    assert cfe.psp.status_to_string(-4) == "-4"


def test_invalid_table_registration_is_logged(cfe: Cfe) -> None:
    log = cfe.es.syslog
    for name, size, options, line in (
        ("", 4, 0, "CFE_TBL_TxnCheckConfig: bad table name: '' (0xffffffffcc000002)"),
        ("T", 4, 3, "CFE_TBL_TxnCheckConfig: bad TblOptionFlags combination for 'T' (0x3)"),
        ("T", 0, 0, "CFE_TBL_TxnCheckConfig: Table 'T' has invalid size (0)"),
    ):
        status_of(cfe.tbl.register, name, size, options)
        assert line.encode() in log.read()
    cfe.tbl.register("T", 4)
    status_of(cfe.tbl.register, "T", 8)
    assert log.read().endswith(b" existing table ('CFE_TEST.T') with different size(8!=4)\n")


def test_refused_notification_is_logged_with_its_status(cfe: Cfe) -> None:
    status_of(cfe.tbl.notify_by_message, 0x1B0009, CMD_MID, 1, 2)
    assert cfe.es.syslog.read().endswith(b" Handle=1769481 status code=ffffffffcc000001\n")


def test_long_cds_name_is_cut_in_the_log(cfe: Cfe) -> None:
    status_of(cfe.es.register_cds, 4, "N" * 45)
    assert b"CDS Name (" + b"N" * 39 + b") is" in cfe.es.syslog.read()


def test_critical_table_without_an_image_cannot_be_stored(cfe: Cfe) -> None:
    handle = cfe.tbl.register("T", 4, OPT_CRITICAL)
    cfe.tbl.modified(handle)
    text = b"Unable to update Critical Table 'CFE_TEST.T' in CDS (Err=0xCC000005)\n"
    assert cfe.es.syslog.read().endswith(text)
