"""The run loop, its counter, and waiting for the others (es_behavior_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.es import APP_EXIT, APP_RUN, SYSTEM_OPERATIONAL
from cfepy.time import A_LT_B

NO_STATUS = 0  # CFE_ES_RunStatus_UNDEFINED


def test_run_counter(cfe: Cfe) -> None:
    es = cfe.es

    def count() -> int:
        return es.get_task_info(es.get_task_id()).execution_counter

    before = count()
    assert es.run_loop(APP_RUN) is True
    assert count() == before + 1
    assert es.run_loop() is True
    assert count() == before + 2
    es.increment_task_counter()
    assert count() == before + 3
    assert es.run_loop(NO_STATUS) is False
    assert es.run_loop(APP_EXIT) is False
    assert count() == before + 5, "who does not want to go on has come by as well"


def test_wait_behavior(cfe: Cfe) -> None:
    begin = cfe.time.get_time()
    for state in range(SYSTEM_OPERATIONAL + 1):
        cfe.es.wait_for_system_state(state, 10_000)
    cfe.es.wait_for_startup_sync(10_000)
    passed = cfe.time.subtract(cfe.time.get_time(), begin)
    assert cfe.time.compare(passed, (8, 0)) == A_LT_B
    assert passed == (0, 0), "all of it is reached already, and asking takes no time"
