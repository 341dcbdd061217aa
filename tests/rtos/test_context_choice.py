"""The kind of tasks of a run that does not name one."""

from __future__ import annotations

import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from cfepy.rtos import AUTO, GREENLET, THREAD, task_kind
from cfepy.rtos.context_choice import ELSEWHERE, FOLLOWED


def test_greenlets_are_used_if_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    assert task_kind(AUTO) == (GREENLET, "")
    monkeypatch.setitem(sys.modules, "greenlet", None)
    assert task_kind(AUTO) == (THREAD, "")


@pytest.mark.parametrize("kind", ["trace", "profile"])
def test_tool_that_follows_threads_selects_threads(kind: str) -> None:
    before, set_ = getattr(threading, f"get{kind}")(), getattr(threading, f"set{kind}")
    set_(lambda frame, event, arg: None)
    try:
        assert task_kind(AUTO) == (THREAD, FOLLOWED)
        assert task_kind(GREENLET) == (GREENLET, "")
    finally:
        set_(before)


def test_run_outside_the_main_thread_gets_threads() -> None:
    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(task_kind, AUTO).result() == (THREAD, ELSEWHERE)


def test_report_names_the_kind_of_tasks_and_the_reason() -> None:
    assert str(task_kind(THREAD)) == "thread tasks"
    assert str(task_kind(THREAD)._replace(why=FOLLOWED)) == f"thread tasks ({FOLLOWED})"
