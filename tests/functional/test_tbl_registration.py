"""Registering and sharing tables, up to their limit, and from outside of applications (tbl_registration_test.c)."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.app import Cfe
from cfepy.mission import Mission
from cfepy.status import (
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_SUCCESS,
    CFE_TBL_ERR_DUPLICATE_DIFF_SIZE,
    CFE_TBL_ERR_HANDLES_FULL,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_ERR_INVALID_NAME,
    CFE_TBL_ERR_INVALID_OPTIONS,
    CFE_TBL_ERR_INVALID_SIZE,
    CFE_TBL_ERR_REGISTRY_FULL,
    CFE_TBL_WARN_DUPLICATE,
)
from cfepy.tbl import OPT_CRITICAL, OPT_DBL_BUFFER, OPT_DUMP_ONLY, OPT_USR_DEF_ADDR
from tests.functional.harness import APP, CMD_MID, SHARED_TABLE, call_outside, status_of
from tests.functional.tables import BAD_HANDLE, NAME, SIZE, register


def test_table_registration(cfe: Cfe, mission: Mission) -> None:
    tbl, config = cfe.tbl, mission.config
    handle = tbl.register(NAME, SIZE, 0, lambda image: 1)
    again = tbl.register(NAME, SIZE, 0, lambda image: 1)
    assert (again, again.status) == (handle, CFE_TBL_WARN_DUPLICATE)
    assert status_of(tbl.register, NAME, SIZE // 2) == CFE_TBL_ERR_DUPLICATE_DIFF_SIZE
    assert status_of(tbl.unregister, BAD_HANDLE) == CFE_TBL_ERR_INVALID_HANDLE
    assert status_of(tbl.unregister, handle) == CFE_SUCCESS
    assert status_of(tbl.unregister, handle) == CFE_TBL_ERR_INVALID_HANDLE
    for name in ("", "N" * 16, "a" * 41):
        assert status_of(tbl.register, name, SIZE) == CFE_TBL_ERR_INVALID_NAME
    single, double = config.tbl_max_sngl_table_size, config.tbl_max_dbl_table_size
    for size, options in ((0, 0), (single + 1, 0), (double + 1, OPT_DBL_BUFFER)):
        assert status_of(tbl.register, NAME, size, options) == CFE_TBL_ERR_INVALID_SIZE
    for options in (OPT_DBL_BUFFER | OPT_USR_DEF_ADDR, OPT_CRITICAL | OPT_DUMP_ONLY, OPT_CRITICAL | OPT_USR_DEF_ADDR):
        assert status_of(tbl.register, NAME, SIZE, options) == CFE_TBL_ERR_INVALID_OPTIONS


def take_all(make: Callable[[int], int], handles: list[int]) -> int:
    """Add handles until there are no more. Returns the status of the failed call."""
    while (status := status_of(lambda: handles.append(make(len(handles) + 1)))) == CFE_SUCCESS:
        assert len(handles) < 1000
    return status


def test_table_max_limits(cfe: Cfe, mission: Mission) -> None:
    handles: list[int] = []
    tbl = cfe.tbl
    assert take_all(lambda number: register(cfe, f"Test{number}"), handles) == CFE_TBL_ERR_REGISTRY_FULL
    assert 0 < len(handles) < mission.config.tbl_max_num_tables, "SAMPLE_APP has one"
    tbl.unregister(handles.pop())
    assert take_all(lambda number: tbl.share(f"{APP}.Test1"), handles) == CFE_TBL_ERR_HANDLES_FULL
    assert len(handles) < mission.config.tbl_max_num_handles
    assert status_of(register, cfe) == CFE_TBL_ERR_HANDLES_FULL
    assert {status_of(tbl.unregister, handle) for handle in reversed(handles)} == {CFE_SUCCESS}


def test_table_sharing(cfe: Cfe) -> None:
    assert status_of(cfe.tbl.share, SHARED_TABLE) == CFE_SUCCESS
    assert status_of(cfe.tbl.share, "ExampleTable") == CFE_TBL_ERR_INVALID_NAME


def test_table_bad_context(cfe: Cfe) -> None:
    tbl, handle = cfe.tbl, register(cfe)

    def in_no_application() -> None:
        assert status_of(register, cfe, "OtherTable") == CFE_ES_ERR_RESOURCEID_NOT_VALID
        assert status_of(tbl.share, SHARED_TABLE) == CFE_ES_ERR_RESOURCEID_NOT_VALID
        for call in (
            tbl.dump_to_buffer,
            tbl.get_address,
            tbl.get_status,
            tbl.manage,
            tbl.modified,
            tbl.release_address,
            tbl.update,
            tbl.validate,
            tbl.unregister,
        ):
            assert status_of(call, handle) == CFE_ES_ERR_RESOURCEID_NOT_VALID, call
        assert status_of(tbl.load, handle, "/ram/any.tbl") == CFE_ES_ERR_RESOURCEID_NOT_VALID
        assert status_of(tbl.notify_by_message, handle, CMD_MID, 0, 0) == CFE_ES_ERR_RESOURCEID_NOT_VALID

    call_outside(cfe, in_no_application)
    assert status_of(tbl.unregister, handle) == CFE_SUCCESS
