"""Ids as indices of arrays (es_resource_id_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.ids import UNDEFINED
from cfepy.mission import Mission
from cfepy.status import CFE_ES_ERR_RESOURCEID_NOT_VALID
from tests.functional.harness import LIBRARY, status_of


def test_obtaining_indices_from_app_id(cfe: Cfe, mission: Mission) -> None:
    index, me = cfe.es.app_id_to_index, cfe.es.get_app_id()
    assert index(me) == index(me) < mission.config.es_max_applications
    assert status_of(index, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_obtaining_indices_from_lib_id(cfe: Cfe, mission: Mission) -> None:
    index, library = cfe.es.lib_id_to_index, cfe.es.get_lib_id_by_name(LIBRARY)
    assert index(library) == index(library) < mission.config.es_max_libraries
    assert status_of(index, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_obtaining_indices_from_task_id(cfe: Cfe, mission: Mission) -> None:
    index, task = cfe.es.task_id_to_index, cfe.es.get_task_id()
    assert index(task) == index(task) < mission.config.os_max_tasks
    assert status_of(index, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_obtaining_indices_from_counter_id(cfe: Cfe, mission: Mission) -> None:
    index, counter = cfe.es.counter_id_to_index, cfe.es.register_gen_counter("TEST_COUNTER")
    assert index(counter) == index(counter) < mission.config.es_max_gen_counters
    assert status_of(index, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    cfe.es.delete_gen_counter(counter)
