"""Requirements of Executive Services about generic counters."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_DUPLICATE_NAME,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
)
from tests.requirements.covers import covers
from tests.requirements.flight import PROCESSOR_RESET, Flight
from tests.statuses import status_of

Fly = Callable[..., Flight]


@covers("cES1338", "cES1339")
def test_cES1338_register_and_delete(fly: Fly) -> None:
    es = (flight := fly()).cfe.es
    made = [flight.call(lambda: es.register_gen_counter(f"C{n}")) for n in range(8)]  # noqa: B023
    assert status_of(lambda: es.register_gen_counter("C8")) == CFE_ES_NO_RESOURCE_IDS_AVAILABLE
    es.delete_gen_counter(made[0])
    assert status_of(lambda: es.get_gen_count(made[0])) == CFE_ES_BAD_ARGUMENT
    assert status_of(lambda: es.register_gen_counter("C1")) == CFE_ES_ERR_DUPLICATE_NAME
    assert es.register_gen_counter("C8") not in made


@covers("cES1340", "cES1341", "cES1342")
def test_cES1340_count_set_and_get(fly: Fly) -> None:
    es = (flight := fly()).cfe.es
    counter = flight.call(lambda: es.register_gen_counter("ut"))
    assert es.get_gen_count(counter) == 0
    flight.call(lambda: es.increment_gen_counter(counter), app="MUTE")
    assert es.get_gen_count(counter) == 1
    es.set_gen_count(counter, 41)
    es.increment_gen_counter(counter)
    assert flight.call(lambda: es.get_gen_count(counter)) == 42


@covers("cES1343", "cES1346")
def test_cES1343_id_and_name(fly: Fly) -> None:
    es = (flight := fly()).cfe.es
    counter = flight.call(lambda: es.register_gen_counter("ut"))
    assert es.get_gen_counter_id_by_name("ut") == counter
    assert es.get_gen_counter_name(counter) == "ut"
    flight.reset(PROCESSOR_RESET)
    assert status_of(lambda: flight.cfe.es.get_gen_counter_id_by_name("ut")) == CFE_ES_ERR_NAME_NOT_FOUND
