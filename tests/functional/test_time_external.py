"""Functions called by a tone, and external time (time_external_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TIME_BAD_ARGUMENT,
    CFE_TIME_CALLBACK_NOT_REGISTERED,
    CFE_TIME_NOT_IMPLEMENTED,
    CFE_TIME_TOO_MANY_SYNCH_CALLBACKS,
)
from tests.functional.harness import status_of


def test_time_synch_callbacks(cfe: Cfe) -> None:
    calls: list[str] = []

    def first() -> None:
        calls.append("first")

    def second() -> None:
        calls.append("second")

    register, unregister = cfe.time.register_synch_callback, cfe.time.unregister_synch_callback
    assert status_of(register, first) == CFE_SUCCESS
    assert status_of(register, second) == CFE_TIME_TOO_MANY_SYNCH_CALLBACKS
    cfe.os.task_delay(2500)
    assert calls in (["first"] * 2, ["first"] * 3)
    assert status_of(unregister, first) == CFE_SUCCESS
    assert status_of(unregister, first) == CFE_TIME_CALLBACK_NOT_REGISTERED
    calls.clear()
    cfe.os.task_delay(2500)
    assert calls == []
    assert status_of(register, None) == CFE_TIME_BAD_ARGUMENT
    assert status_of(unregister, None) == CFE_TIME_BAD_ARGUMENT


def test_external_sources(cfe: Cfe) -> None:
    """The tone source always exists; the sources of time need configuration."""
    assert status_of(cfe.time.external_tone) == CFE_SUCCESS
    assert status_of(cfe.time.external_met, (1000, 0)) == CFE_TIME_NOT_IMPLEMENTED
    assert status_of(cfe.time.external_gps, (1000, 0), 5) == CFE_TIME_NOT_IMPLEMENTED
    assert status_of(cfe.time.external_time, (1000, 0)) == CFE_TIME_NOT_IMPLEMENTED
