"""Stored exceptions: read once, contexts kept for a while, preserved through a processor reset."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from cfepy.psp import Retained
from cfepy.psp.exceptions import EXCEPTION_ID_BASE
from cfepy.status import CFE_PSP_NO_EXCEPTION_DATA, OsalError
from tests.psp.test_psp import Board


@pytest.fixture
def board() -> Iterator[Board]:
    """Return a board that has not been booted."""
    made = Board()
    with made.kernel:
        yield made


def no_data(call: Callable[[], object]) -> None:
    """A call fails with CFE_PSP_NO_EXCEPTION_DATA."""
    with pytest.raises(OsalError) as caught:
        call()
    assert caught.value.status == CFE_PSP_NO_EXCEPTION_DATA


def test_oldest_exception_is_returned_first_and_once(board: Board) -> None:
    psp = board.psp
    psp.set_default_exception_environment()
    no_data(psp.exception_get_summary)
    first = psp.store_exception(0x10005, "division by zero", b"pump.py:12")
    second = psp.store_exception(0x10006, "no such key")
    assert (first, second) == (EXCEPTION_ID_BASE, EXCEPTION_ID_BASE + 1)
    assert psp.exception_get_count() == 2
    assert psp.exception_get_summary() == (first, 0x10005, "division by zero")
    assert psp.exception_get_summary() == (second, 0x10006, "no such key")
    assert psp.exception_get_count() == 0
    no_data(psp.exception_get_summary)


def test_contexts_are_kept_until_their_place_is_needed(board: Board) -> None:
    psp = board.psp
    first = psp.store_exception(1, "first", b"context")
    assert psp.exception_copy_context(first, 100) == b"context"
    assert board.console.lines == []
    assert psp.exception_copy_context(first, 3) == b"con"
    assert board.console.lines == [
        "CFE_PSP: Insufficient buffer for exception context, total=7 bytes, saved=3",
    ]
    psp.exception_get_summary()
    for _ in range(2):
        psp.store_exception(2, "later")
    assert psp.exception_copy_context(first, 100) == b"context"
    psp.store_exception(2, "later")
    no_data(lambda: psp.exception_copy_context(first, 100))
    no_data(lambda: psp.exception_copy_context(0, 100))


def test_full_storage_keeps_the_oldest_exceptions(board: Board) -> None:
    psp = board.psp
    ids = [psp.store_exception(task, "why") for task in range(1, 6)]
    assert ids[4] == 0
    assert psp.exception_get_count() == 4
    summaries = [psp.exception_get_summary() for _ in range(4)]
    assert [summary.task_id for summary in summaries] == [1, 2, 3, 4]
    assert [summary.context_id for summary in summaries] == [0, *ids[1:4]]  # the place of the first is the next to go


def test_unread_exceptions_are_dropped_at_the_next_start() -> None:
    retained = Retained()
    first = Board(retained)
    with first.kernel:
        first.psp.boot()
        stored = first.psp.store_exception(1, "why", b"context")
        first.psp.restart(1)
    second = Board(retained)
    with second.kernel:
        second.psp.boot()
        assert second.psp.exception_get_count() == 1
        second.psp.attach_exceptions()
        assert second.console.lines[-1] == "CFE_PSP: CFE_PSP_AttachExceptions called"
        assert second.psp.exception_get_count() == 0
        assert second.psp.exception_copy_context(stored, 100) == b"context"
        second.psp.restart(2)
    third = Board(retained)
    with third.kernel:
        third.psp.boot()
        no_data(lambda: third.psp.exception_copy_context(stored, 100))
