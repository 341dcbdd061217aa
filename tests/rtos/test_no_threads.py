"""A host that has no more threads: the error says so, and the run can still end."""

from __future__ import annotations

import _thread

import pytest

from cfepy.rtos import Kernel
from cfepy.rtos.context import drain
from cfepy.status import UsageError


def test_error_explains_how_to_allow_more_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(function: object, arguments: object) -> int:
        raise RuntimeError("can't start new thread")

    with Kernel(context="thread") as kernel:
        kernel.spawn("first", lambda: kernel.delay(10))
        drain()
        monkeypatch.setattr(_thread, "start_new_thread", refuse)
        with pytest.raises(UsageError, match=r"cannot start another thread.*ulimit -u.*--tasks greenlet"):
            kernel.spawn("second", lambda: None)
        monkeypatch.undo()
        assert [task.name for task in kernel.tasks] == ["first"]
        kernel.run(100)
        assert kernel.tasks == []
