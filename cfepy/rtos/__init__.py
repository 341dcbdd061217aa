"""The simulated real-time kernel: virtual time, tasks with priorities, and the objects tasks wait for.

It may import only `cfepy.trace` and `cfepy.status`. Everything above talks to it through the names below.
"""

from __future__ import annotations

from cfepy.rtos.depth_first import DepthFirst
from cfepy.rtos.errors import DeadlockError
from cfepy.rtos.exploring import ExploringKernel, make_kernel
from cfepy.rtos.kernel import Kernel
from cfepy.rtos.mutex import Mutex
from cfepy.rtos.policy import PCT, Decision, Deviations, Policy, Recorded, SeededRandom
from cfepy.rtos.queue import EMPTY, Queue
from cfepy.rtos.schedule import Schedule
from cfepy.rtos.semaphore import Semaphore
from cfepy.rtos.task import FOREVER, TIMEOUT, Task, TaskExit, WaitList

__all__ = [
    "EMPTY",
    "FOREVER",
    "PCT",
    "TIMEOUT",
    "DeadlockError",
    "Decision",
    "DepthFirst",
    "Deviations",
    "ExploringKernel",
    "Kernel",
    "Mutex",
    "Policy",
    "Queue",
    "Recorded",
    "Schedule",
    "SeededRandom",
    "Semaphore",
    "Task",
    "TaskExit",
    "WaitList",
    "make_kernel",
]
