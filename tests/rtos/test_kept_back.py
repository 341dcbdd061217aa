"""Tasks that are ready without running, and turns in place of priorities."""

from __future__ import annotations

from cfepy.rtos import Kernel

MS = 1_000_000


def hog(kernel: Kernel, length_ms: int) -> None:
    """Use virtual CPU time in small steps, as a loop that polls."""
    for _ in range(length_ms * 100):
        kernel.charge(MS // 100)


def test_task_that_is_ready_while_a_more_urgent_one_computes_is_found() -> None:
    with Kernel() as kernel:
        kernel.spawn("HOG", lambda: hog(kernel, 1000), 50)
        kernel.spawn("LATE", lambda: kernel.delay(1), 60)
        kernel.spawn("TICKS", lambda: [kernel.delay(10 * MS) for _ in range(200)], 10)
        kernel.run(3000 * MS)
        (found,) = kernel.kept_back()
    assert (found.task.name, found.by.name) == ("LATE", "HOG")
    assert found.since_ns == 100 * MS
    assert found.length_ns >= 800 * MS


def test_run_in_which_computing_takes_no_time_has_no_such_tasks() -> None:
    with Kernel() as kernel:
        for number in range(4):
            kernel.spawn(f"T{number}", lambda: [kernel.delay(MS) for _ in range(1000)], 50 + number)
        kernel.run(3000 * MS)
        assert kernel.kept_back() == []


def test_fair_kernel_lets_tasks_take_turns_whatever_their_priorities() -> None:
    with Kernel() as kernel:
        kernel.is_fair = True
        ends: dict[str, int] = {}

        def work(name: str, length_ms: int) -> None:
            hog(kernel, length_ms)
            ends[name] = kernel.now // MS

        kernel.spawn("HOG", lambda: work("HOG", 100), 1)
        kernel.set_priority(kernel.spawn("OTHER", lambda: work("OTHER", 50), 200), 255)
        kernel.run(1000 * MS)
    assert ends == {"OTHER": 100, "HOG": 150}
