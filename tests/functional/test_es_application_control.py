"""Restarting, reloading and deleting invalid applications (es_application_control_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.es import APP_RUN
from cfepy.ids import UNDEFINED
from cfepy.status import CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_FILE_IO_ERR
from tests.functional.harness import APP_FILE, status_of


def test_application_control_api(cfe: Cfe) -> None:
    es = cfe.es
    assert status_of(es.restart_app, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.delete_app, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.reload_app, UNDEFINED, APP_FILE) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.reload_app, es.get_app_id(), "/cf/NOT_cfe_testcase.so") == CFE_ES_FILE_IO_ERR
    assert es.control_request() == APP_RUN, "a request that was refused must not count"
