"""Samples of the stacks of greenlets: a thread of the host looks at the running task about a thousand times a second.

It needs Python's global lock for a look. A switch between greenlets keeps the lock, so the sampler gets it anywhere in
a task, and the samples of a task are spread over its code as its time is.
"""

from __future__ import annotations

import sys
import threading
from collections import Counter
from types import CodeType

from cfepy.attachment import Attachment
from cfepy.extra.profiler.task_times import DEEPEST, Stack, TaskLabel, TimedTasks
from cfepy.mission import Mission

PERIOD_S = 0.001
SWITCH_S = 0.0005  # for `sys.setswitchinterval`: how long the sampler waits for a task that computes


class StackSampler(Attachment):
    """Samples the stacks of a run.

    Args:
        timed: has the running task.

    Attributes:
        count: number of samples.
    """

    def __init__(self, timed: TimedTasks) -> None:
        self.count = 0
        self._timed = timed
        self._seen: Counter[tuple[TaskLabel, tuple[int, ...]]] = Counter()
        self._codes: dict[int, CodeType] = {}  # by id, because the hash of a code object is slow
        self._over = threading.Event()
        self._thread: threading.Thread | None = None
        self._usual_s = 0.0

    def begin(self, mission: Mission) -> None:
        if mission.kernel.context.name == "thread":
            return  # `TurnTracer` sees the stacks
        self._usual_s = sys.getswitchinterval()
        sys.setswitchinterval(SWITCH_S)
        self._thread = threading.Thread(target=self._run, name="cfepy profiler", daemon=True)
        self._thread.start()

    def conclude(self) -> None:
        self._stop()

    def close(self) -> None:
        self._stop()

    def _stop(self) -> None:
        thread, self._thread = self._thread, None
        if thread is not None:
            self._over.set()
            thread.join()
            sys.setswitchinterval(self._usual_s)

    def _run(self) -> None:
        while not self._over.wait(PERIOD_S):
            self.take()

    def take(self) -> None:
        """Take a sample of the running task, if one runs."""
        timed, times = self._timed, self._timed.times
        label, task = times.label, times.task
        if task is None:
            return
        frame = sys._current_frames().get(timed.host_ident)
        if times.is_switching or times.task is not task:
            return  # the frame may belong to another task
        ids: list[int] = []
        while frame is not None and len(ids) < DEEPEST:
            code = frame.f_code
            at = id(code)
            self._codes[at] = code
            ids.append(at)
            frame = frame.f_back
        self._seen[label, tuple(ids)] += 1
        self.count += 1

    def stacks(self) -> dict[TaskLabel, Counter[Stack]]:
        """Return how often each stack was seen, by task."""
        found: dict[TaskLabel, Counter[Stack]] = {}
        for (label, ids), count in self._seen.items():
            found.setdefault(label, Counter())[tuple(self._codes[each] for each in reversed(ids))] += count
        return found
