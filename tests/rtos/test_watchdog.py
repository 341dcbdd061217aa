"""The stall watch names a task that computes without end, and changes nothing else."""

from __future__ import annotations

import threading

import pytest

from cfepy.rtos import Kernel
from cfepy.rtos.watchdog import StallWatch


def test_a_task_that_never_yields_is_named(make_kernel: type[Kernel]) -> None:
    reports: list[str] = []

    def spin() -> None:
        while not reports:
            pass

    with make_kernel() as kernel:
        watch = StallWatch(kernel, limit_s=0.02, report=reports.append)
        kernel.spawn("spinning", spin)
        watch.begin()
        kernel.run()
        watch.end()
    assert "task spinning has not given up the CPU" in reports[0]
    assert "in spin" in reports[0]


@pytest.mark.parametrize("pieces", [1, 50])
def test_many_pieces_have_one_thread(make_kernel: type[Kernel], pieces: int) -> None:
    before = threading.active_count()
    with make_kernel() as kernel:
        watch = StallWatch(kernel)
        kernel.spawn("sleeper", lambda: kernel.delay(1000))
        for piece in range(pieces):
            watch.begin()
            kernel.run(piece)
        assert threading.active_count() == before + 1
        watch.end()
    assert threading.active_count() == before
