"""Sending events of every type, and too many of them (evs_send_test.c)."""

from __future__ import annotations

import pytest

from cfepy.app import Cfe
from cfepy.evs import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.ids import UNDEFINED
from cfepy.mission import Mission
from cfepy.status import (
    CFE_EVS_APP_ILLEGAL_APP_ID,
    CFE_EVS_APP_SQUELCHED,
    CFE_EVS_INVALID_PARAMETER,
    CFE_SUCCESS,
)
from tests.functional.harness import status_of

TYPES = (DEBUG, INFORMATION, ERROR, CRITICAL)


def test_send_event(cfe: Cfe, mission: Mission) -> None:
    send, burst = cfe.evs.send_event, mission.config.evs_max_app_event_burst
    for event_type in TYPES:
        assert send(0, event_type, "OK") == CFE_SUCCESS
        assert status_of(send, 0, event_type, None) == CFE_EVS_INVALID_PARAMETER
    cfe.os.task_delay(1000 * burst // mission.config.evs_app_events_per_sec)
    assert [send(0, INFORMATION, "one of a burst") for _ in range(burst)] == [CFE_SUCCESS] * burst
    assert send(0, INFORMATION, "one too many") == CFE_EVS_APP_SQUELCHED
    cfe.os.task_delay(1000)
    assert send(0, INFORMATION, "after a rest") == CFE_SUCCESS


@pytest.mark.parametrize("event_type", TYPES)
def test_send_event_with_app_id(cfe: Cfe, event_type: int) -> None:
    send, me = cfe.evs.send_event_with_app_id, cfe.es.get_app_id()
    assert send(0, event_type, me, "OK") == CFE_SUCCESS
    assert status_of(send, 0, event_type, me, None) == CFE_EVS_INVALID_PARAMETER
    assert status_of(send, 0, event_type, UNDEFINED, "OK") == CFE_EVS_APP_ILLEGAL_APP_ID


@pytest.mark.parametrize("event_type", TYPES)
def test_send_timed_event(cfe: Cfe, event_type: int) -> None:
    time = (1000, 1000)
    assert cfe.evs.send_timed_event(time, 0, event_type, "OK") == CFE_SUCCESS
    assert status_of(cfe.evs.send_timed_event, time, 0, event_type, None) == CFE_EVS_INVALID_PARAMETER
