"""Ids stay unique with any sequence of creations and deletions."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from cfepy import ids
from cfepy.ids import IdTable


@given(st.integers(1, 9), st.lists(st.integers(0, 20), max_size=60))
def test_id_is_reused_only_after_all_others(capacity: int, choices: list[int]) -> None:
    table: IdTable[int] = IdTable(ids.ES_APPID_BASE, capacity)
    live: list[int] = []
    issued: list[int] = []
    for choice in choices:
        if live and (choice % 3 == 0 or len(live) == capacity):
            table.delete(live.pop(choice % len(live)))
        else:
            new = table.create(choice)
            assert new not in issued
            issued.append(new)
            live.append(new)
        assert sorted(live) == sorted(found for found, _ in table.items())
        assert len({table.index(one) for one in live}) == len(live)
