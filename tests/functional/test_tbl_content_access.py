"""Addresses of tables, one and several, and their release (tbl_content_access_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_ERR_NEVER_LOADED,
    CFE_TBL_INFO_TABLE_LOCKED,
    CFE_TBL_INFO_UPDATED,
)
from tests.functional.harness import SHARED_TABLE, answer_of, status_of
from tests.functional.tables import BAD_HANDLE, NUMBERS, register

IMAGE = NUMBERS.pack(1, 2)


def test_table_get_address(cfe: Cfe) -> None:
    tbl, handle = cfe.tbl, register(cfe)
    assert status_of(tbl.get_address, handle) == CFE_TBL_ERR_NEVER_LOADED
    assert status_of(tbl.get_address, BAD_HANDLE) == CFE_TBL_ERR_INVALID_HANDLE
    assert tbl.load(handle, IMAGE) == CFE_SUCCESS
    assert tbl.get_address(handle) == (IMAGE, True)
    assert tbl.get_address(handle) == (IMAGE, False)
    tbl.unregister(handle)
    assert status_of(tbl.get_address, handle) == CFE_TBL_ERR_INVALID_HANDLE
    shared = tbl.share(SHARED_TABLE)
    assert tbl.get_address(shared)[1] is True, "loaded, and not looked at since"
    tbl.unregister(shared)


def test_table_release_address(cfe: Cfe) -> None:
    tbl, handle = cfe.tbl, register(cfe)
    assert answer_of(tbl.release_address, handle) == CFE_TBL_ERR_NEVER_LOADED
    assert answer_of(tbl.release_address, BAD_HANDLE) == CFE_TBL_ERR_INVALID_HANDLE
    assert tbl.load(handle, IMAGE) == CFE_SUCCESS
    assert tbl.release_address(handle) == CFE_TBL_INFO_UPDATED
    assert tbl.load(handle, IMAGE) == CFE_SUCCESS
    assert tbl.get_address(handle)[1] is True
    assert tbl.load(handle, IMAGE) == CFE_TBL_INFO_TABLE_LOCKED
    assert tbl.release_address(handle) == CFE_SUCCESS
    assert tbl.manage(handle) == CFE_TBL_INFO_UPDATED, "the load that had to wait"
    assert tbl.load(handle, IMAGE) == CFE_SUCCESS
    tbl.unregister(handle)
    assert answer_of(tbl.release_address, handle) == CFE_TBL_ERR_INVALID_HANDLE


def test_table_get_and_release_addresses(cfe: Cfe) -> None:
    tbl, handles = cfe.tbl, [register(cfe, f"Test{number}") for number in (1, 2, 3)]
    assert status_of(tbl.get_addresses, [BAD_HANDLE, *handles]) == CFE_TBL_ERR_INVALID_HANDLE
    assert status_of(tbl.get_addresses, handles) == CFE_TBL_ERR_NEVER_LOADED
    assert [tbl.load(handle, IMAGE) for handle in handles] == [CFE_SUCCESS] * 3
    assert tbl.get_addresses(handles) == [(IMAGE, True)] * 3
    assert tbl.get_addresses(handles) == [(IMAGE, False)] * 3
    assert answer_of(tbl.release_addresses, [BAD_HANDLE, *handles]) == CFE_TBL_ERR_INVALID_HANDLE
    assert [tbl.load(handle, IMAGE) for handle in handles] == [CFE_SUCCESS] * 3, "released all the same"
    assert tbl.release_addresses(handles) == CFE_TBL_INFO_UPDATED
    assert tbl.get_addresses(handles) == [(IMAGE, True)] * 3
    assert tbl.release_addresses(handles) == CFE_SUCCESS
    assert {status_of(tbl.unregister, handle) for handle in handles} == {CFE_SUCCESS}
