"""Generic counters: as many as there are, their names, and counting (es_counter_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.ids import UNDEFINED
from cfepy.mission import Mission
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_DUPLICATE_NAME,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_SUCCESS,
)
from tests.functional.harness import status_of


def test_counter_create_delete(cfe: Cfe, mission: Mission) -> None:
    es, most = cfe.es, mission.config.es_max_gen_counters
    made = [es.register_gen_counter(f"C{number}") for number in range(most)]
    assert status_of(es.register_gen_counter, "one more") == CFE_ES_NO_RESOURCE_IDS_AVAILABLE
    assert sorted(es.counter_id_to_index(each) for each in made) == list(range(most))
    assert status_of(es.counter_id_to_index, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    for number, each in enumerate(made):
        assert es.get_gen_counter_id_by_name(f"C{number}") == each
        assert es.get_gen_counter_name(each) == f"C{number}"
    assert status_of(es.get_gen_counter_id_by_name, "na") == CFE_ES_ERR_NAME_NOT_FOUND
    assert status_of(es.get_gen_counter_name, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(es.delete_gen_counter, UNDEFINED) == CFE_ES_BAD_ARGUMENT
    es.delete_gen_counter(made.pop())
    assert status_of(es.register_gen_counter, "C0") == CFE_ES_ERR_DUPLICATE_NAME
    assert status_of(es.register_gen_counter, "N" * 20) == CFE_ES_BAD_ARGUMENT
    assert [status_of(es.delete_gen_counter, each) for each in made] == [CFE_SUCCESS] * (most - 1)
    assert {status_of(es.delete_gen_counter, each) for each in made} == {CFE_ES_BAD_ARGUMENT}


def test_counter_get_set(cfe: Cfe) -> None:
    es = cfe.es
    counter = es.register_gen_counter("ut")
    assert es.get_gen_count(counter) == 0
    es.set_gen_count(counter, 5)
    assert es.get_gen_count(counter) == 5
    es.increment_gen_counter(counter)
    assert es.get_gen_count(counter) == 6
    assert status_of(es.get_gen_count, UNDEFINED) == CFE_ES_BAD_ARGUMENT
    assert status_of(es.increment_gen_counter, UNDEFINED) == CFE_ES_BAD_ARGUMENT
    assert status_of(es.set_gen_count, UNDEFINED, 0) == CFE_ES_BAD_ARGUMENT
    es.delete_gen_counter(counter)
    assert status_of(es.get_gen_count, counter) == CFE_ES_BAD_ARGUMENT
