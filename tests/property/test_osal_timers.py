"""The tickless timers of OSAL against a model that counts every tick, as OS_TimeBase_CallbackThread does."""

from __future__ import annotations

from dataclasses import dataclass

from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.osal import Osal
from cfepy.rtos import Kernel

MS = 1_000_000
END_MS = 400
TIMES = st.integers(1, 120).map(lambda ms: ms * 1000)


@dataclass
class Model:
    """One timer, counted down at every tick of its time base."""

    left_us: int
    interval_us: int

    def tick(self, tick_us: int) -> int:
        """Return how many callbacks a tick makes."""
        was_running = self.left_us > 0
        self.left_us -= tick_us
        calls = 0
        while self.left_us <= 0:
            self.left_us = max(self.left_us + self.interval_us, -self.interval_us)
            calls += was_running
            if not self.interval_us:
                break
        return calls


@settings(max_examples=60, deadline=None)
@given(
    start_ms=st.integers(1, 30),
    tick_ms=st.integers(1, 30),
    set_at_ms=st.integers(0, 100),
    timers=st.lists(st.tuples(TIMES, st.one_of(st.just(0), TIMES)), min_size=1, max_size=4),
)
def test_expiries_equal_a_model_that_counts_every_tick(
    start_ms: int, tick_ms: int, set_at_ms: int, timers: list[tuple[int, int]]
) -> None:
    seen: list[tuple[int, int]] = []
    with Kernel("thread") as kernel:
        osal = Osal(kernel)
        base = osal.time_base_create("BASE")
        osal.time_base_set(base, start_ms * 1000, tick_ms * 1000)
        ids = [
            osal.timer_add(f"T{number}", base, lambda _, number: seen.append((kernel.now // MS, number)), number)
            for number in range(len(timers))
        ]
        kernel.run(until_ns=set_at_ms * MS)
        for timer_id, (first_us, interval_us) in zip(ids, timers, strict=True):
            osal.timer_set(timer_id, first_us, interval_us)
        kernel.run(until_ns=END_MS * MS)
    models = [Model(*times) for times in timers]
    expected: list[tuple[int, int]] = []
    for at_ms in range(start_ms, END_MS + 1, tick_ms):
        if at_ms > set_at_ms:
            length = (start_ms if at_ms == start_ms else tick_ms) * 1000
            for number in reversed(range(len(models))):
                expected += [(at_ms, number)] * models[number].tick(length)
    assert seen == expected
