"""Coverage, profilers and debuggers see the actions of tasks on threads."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from cfepy.rtos import Kernel


def counted(kernel: Kernel) -> None:
    """Execute the work of a task."""
    kernel.delay(10)


def run() -> None:
    with Kernel(context="thread") as kernel:
        kernel.spawn("task", lambda: counted(kernel))
        kernel.run(100)


@pytest.mark.parametrize("kind", ["trace", "profile"])
def test_tasks_are_traced_as_threads_are(kind: str) -> None:
    seen: list[tuple[str, int]] = []

    def look(frame: FrameType, event: str, arg: object) -> Any:
        seen.append((frame.f_code.co_name, threading.get_ident()))
        return None

    get, set_ = getattr(threading, f"get{kind}"), getattr(threading, f"set{kind}")
    before = get()
    run()  # so that there are threads that have been used
    set_(look)
    try:
        run()
    finally:
        set_(before)
    assert "counted" in [name for name, _ in seen]
    assert threading.get_ident() not in [ident for _, ident in seen]
    seen.clear()
    run()
    assert "counted" not in [name for name, _ in seen]
    assert getattr(sys, f"get{kind}")() is not look


@pytest.mark.parametrize("tasks", [pytest.param("thread", marks=pytest.mark.slow), "greenlet"])
def test_a_function_can_be_traced_after_a_stall(tasks: str, tmp_path: Path) -> None:
    """Ending a task that spins leaves nothing in the interpreter; a traced function hung there."""
    (tmp_path / "spin.py").write_text("while True:\n    pass\n", encoding="utf-8")
    script = (
        "import sys, cfepy\n"
        f"assert cfepy.run({str(tmp_path / 'spin.py')!r}, stall=0.3, tasks={tasks!r}).problems\n"
        "sys.settrace(lambda frame, what, value: None)\n"
        "(lambda: None)()\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True, timeout=60)  # which ends it when it hangs
