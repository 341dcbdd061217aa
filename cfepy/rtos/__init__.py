"""The simulated real-time kernel: virtual time, tasks with priorities, and the objects tasks wait for.

It may import only `cfepy.trace`. Everything above talks to it through the names below.
"""

from __future__ import annotations

from cfepy.rtos.errors import DeadlockError
from cfepy.rtos.kernel import Kernel
from cfepy.rtos.mutex import Mutex
from cfepy.rtos.policy import Policy, Recorded, Replay, SeededRandom
from cfepy.rtos.queue import EMPTY, Queue
from cfepy.rtos.semaphore import Semaphore
from cfepy.rtos.task import FOREVER, TIMEOUT, Task, TaskExit, WaitList

__all__ = [
    "EMPTY",
    "FOREVER",
    "TIMEOUT",
    "DeadlockError",
    "Kernel",
    "Mutex",
    "Policy",
    "Queue",
    "Recorded",
    "Replay",
    "SeededRandom",
    "Semaphore",
    "Task",
    "TaskExit",
    "WaitList",
]
