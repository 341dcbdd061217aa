"""Resetting event filters (evs_filters_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.status import CFE_EVS_EVT_NOT_REGISTERED, CFE_SUCCESS
from tests.functional.harness import SAMPLE_EVENT, status_of


def test_reset_filters(cfe: Cfe) -> None:
    assert status_of(cfe.evs.reset_filter, SAMPLE_EVENT) == CFE_SUCCESS
    assert status_of(cfe.evs.reset_all_filters) == CFE_SUCCESS
    assert status_of(cfe.evs.reset_filter, SAMPLE_EVENT - 1) == CFE_EVS_EVT_NOT_REGISTERED
