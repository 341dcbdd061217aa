"""Blocks of the Critical Data Store: making, naming, saving and restoring them (es_cds_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.ids import UNDEFINED
from cfepy.status import (
    CFE_ES_CDS_ALREADY_EXISTS,
    CFE_ES_CDS_INVALID_NAME,
    CFE_ES_CDS_INVALID_SIZE,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_SUCCESS,
)
from tests.functional.harness import APP, status_of

NAME = "CDS_Test"


def test_register_cds(cfe: Cfe) -> None:
    register = cfe.es.register_cds
    first = register(15, NAME)
    again = register(15, NAME)
    assert (first.status, again.status, again) == (CFE_SUCCESS, CFE_ES_CDS_ALREADY_EXISTS, first)
    assert register(10, NAME).status == CFE_SUCCESS, "another size is another block"
    assert register(10, NAME).status == CFE_ES_CDS_ALREADY_EXISTS
    assert status_of(register, 0, NAME) == CFE_ES_CDS_INVALID_SIZE
    for name in ("VERY_LONG_NAME_" + NAME, "N" * 17, ""):
        assert status_of(register, 10, name) == CFE_ES_CDS_INVALID_NAME
    assert status_of(register, 10, "N" * 16) == CFE_SUCCESS


def test_cds_name(cfe: Cfe) -> None:
    es = cfe.es
    handle = es.register_cds(10, NAME)
    assert es.get_cds_block_name(handle) == f"{APP}.{NAME}"
    assert es.get_cds_block_id_by_name(f"{APP}.{NAME}") == handle
    assert status_of(es.get_cds_block_name, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.get_cds_block_id_by_name, "INVALID_NAME") == CFE_ES_ERR_NAME_NOT_FOUND
    assert status_of(es.get_cds_block_id_by_name, NAME) == CFE_ES_ERR_NAME_NOT_FOUND, "the full name is asked for"


def test_copy_restore_cds(cfe: Cfe) -> None:
    es, data = cfe.es, b"Test Data\0"
    handle = es.register_cds(len(data), "CDS_Copy_Test")
    es.copy_to_cds(handle, data)
    assert es.restore_from_cds(handle) == data
    assert status_of(es.copy_to_cds, UNDEFINED, data) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.restore_from_cds, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert es.restore_from_cds(handle) == data
