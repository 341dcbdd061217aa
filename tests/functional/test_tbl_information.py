"""Information on a table, and notification of requests by message (tbl_information_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_ERR_INVALID_NAME,
    CFE_TBL_ERR_NO_ACCESS,
)
from tests.functional.harness import CMD_MID, SHARED_TABLE, answer_of, status_of
from tests.functional.tables import BAD_HANDLE, FULL_NAME, SIZE, register


def test_table_get_status(cfe: Cfe) -> None:
    assert cfe.tbl.get_status(register(cfe)) == CFE_SUCCESS
    assert answer_of(cfe.tbl.get_status, BAD_HANDLE) == CFE_TBL_ERR_INVALID_HANDLE


def test_table_get_info(cfe: Cfe) -> None:
    register(cfe)
    info = cfe.tbl.get_info(FULL_NAME)
    assert (info.size, info.num_users, info.table_loaded_once) == (SIZE, 1, False)
    assert (info.dump_only, info.double_buffered, info.user_def_addr, info.critical) == (False,) * 4
    assert status_of(cfe.tbl.get_info, "BadTable") == CFE_TBL_ERR_INVALID_NAME


def test_table_notify_by_message(cfe: Cfe) -> None:
    notify = cfe.tbl.notify_by_message
    assert status_of(notify, BAD_HANDLE, CMD_MID, 0, 0) == CFE_TBL_ERR_INVALID_HANDLE
    assert status_of(notify, register(cfe), CMD_MID, 0, 0) == CFE_SUCCESS
    assert status_of(notify, cfe.tbl.share(SHARED_TABLE), CMD_MID, 0, 0) == CFE_TBL_ERR_NO_ACCESS
