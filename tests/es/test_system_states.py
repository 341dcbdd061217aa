"""The states that `wait_for_system_state` takes, as CFE_ES_SystemState numbers them."""

from __future__ import annotations

import cfepy.es as es


def test_states_have_the_numbers_of_c() -> None:
    names = ("EARLY_INIT", "CORE_STARTUP", "CORE_READY", "APPS_INIT", "OPERATIONAL", "SHUTDOWN")
    assert [getattr(es, f"SYSTEM_{name}") for name in names] == [1, 2, 3, 4, 5, 6]
    assert {f"SYSTEM_{name}" for name in names} <= set(es.__all__)
