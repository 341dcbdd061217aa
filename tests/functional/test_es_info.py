"""ES's information on applications, tasks, libraries and the last reset (es_info_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.es.records import CORE, EXTERNAL
from cfepy.es.records import LIBRARY as LIBRARY_TYPE
from cfepy.ids import UNDEFINED
from cfepy.psp.psp import RST_TYPE_POWERON
from cfepy.status import CFE_ES_ERR_NAME_NOT_FOUND, CFE_ES_ERR_RESOURCEID_NOT_VALID
from tests.functional.harness import APP, APP_ENTRY, APP_FILE, LIBRARY, LIBRARY_ENTRY, LIBRARY_FILE, status_of


def test_app_info(cfe: Cfe) -> None:
    es = cfe.es
    me = es.get_app_id()
    assert es.get_app_id_by_name(APP) == me
    assert es.get_app_name(me) == APP
    mine, core = es.get_app_info(me), es.get_app_info(es.get_app_id_by_name("CFE_ES"))
    assert (mine.type, mine.name, mine.entry_point, mine.file_name) == (EXTERNAL, APP, APP_ENTRY, APP_FILE)
    assert (core.type, core.name, core.entry_point, core.file_name) == (CORE, "CFE_ES", "", "")
    assert mine.stack_size > 0
    assert core.stack_size > 0
    assert (mine.exception_action, core.exception_action) == (0, 1)
    assert mine.priority > 0
    assert core.priority > 0
    assert mine.num_of_child_tasks == 0
    assert core.num_of_child_tasks > 0
    assert status_of(es.get_app_id_by_name, "INVALID_NAME") == CFE_ES_ERR_NAME_NOT_FOUND
    assert status_of(es.get_app_name, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.get_app_info, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_task_info(cfe: Cfe) -> None:
    es = cfe.es
    app = es.get_app_info(es.get_app_id())
    task = es.get_task_info(app.main_task_id)
    assert es.get_task_id() == app.main_task_id == task.task_id
    assert (task.app_name, task.task_name, task.app_id) == (app.name, app.main_task_name, app.resource_id)
    assert task.execution_counter == app.execution_counter
    assert status_of(es.get_task_info, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_lib_info(cfe: Cfe) -> None:
    es = cfe.es
    library = es.get_lib_id_by_name(LIBRARY)
    info = es.get_lib_info(library)
    assert es.get_lib_name(library) == LIBRARY
    assert (info.type, info.name, info.entry_point, info.file_name) == (
        LIBRARY_TYPE,
        LIBRARY,
        LIBRARY_ENTRY,
        LIBRARY_FILE,
    )
    assert (info.stack_size, info.exception_action, info.priority) == (0, 0, 0)
    assert (info.main_task_id, info.main_task_name, info.execution_counter) == (UNDEFINED, "", 0)
    assert info.num_of_child_tasks == 0
    assert status_of(es.get_lib_id_by_name, "INVALID_NAME") == CFE_ES_ERR_NAME_NOT_FOUND
    assert status_of(es.get_lib_info, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.get_lib_name, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_reset_type(cfe: Cfe) -> None:
    kind, subtype = cfe.es.get_reset_type()
    assert kind == RST_TYPE_POWERON
    assert 0 < subtype < 10


def test_module_info(cfe: Cfe) -> None:
    es = cfe.es
    me, library = es.get_app_id(), es.get_lib_id_by_name(LIBRARY)
    assert es.get_module_info(me) == es.get_app_info(me)
    assert es.get_module_info(library) == es.get_lib_info(library)
    assert status_of(es.get_module_info, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
