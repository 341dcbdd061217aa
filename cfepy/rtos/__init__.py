"""The simulated real-time kernel: virtual time, tasks with priorities, and the objects tasks wait for.

What belongs here makes tasks run or wait, decides which task runs next, or charges virtual time for it. OSAL's tasks,
queues and mutexes do not: OSAL builds them on the names below. The host's threads, CPUs and clock are touched in
`context`, `cpus`, `realtime` and `watchdog`, and in no package above.
"""

from __future__ import annotations

from cfepy.rtos.abreast import Abreast
from cfepy.rtos.context_choice import AUTO, GREENLET, THREAD, TaskKind, has_greenlets, task_kind
from cfepy.rtos.costs import CpuCosts
from cfepy.rtos.cpus import allowed_cpus
from cfepy.rtos.errors import DeadlockError, InjectedCrash
from cfepy.rtos.exploring import CallObserver, CallPointKernel, ExploringKernel, make_kernel
from cfepy.rtos.kernel import ENDLESS, Kernel
from cfepy.rtos.moves import Move, MoveNumbers, MovePolicy, MovesToMake, plain_name
from cfepy.rtos.mutex import Mutex
from cfepy.rtos.points import CALLS, Points
from cfepy.rtos.policy import (
    HOLD,
    PCT,
    AskingPolicy,
    Decision,
    Deviations,
    Fair,
    From,
    InOrder,
    Moment,
    NotingPolicy,
    Policy,
    Question,
    SeededRandom,
)
from cfepy.rtos.queue import EMPTY, Queue
from cfepy.rtos.races import Race, RaceSide, VectorClocks
from cfepy.rtos.realtime import Pacer, Stopwatch
from cfepy.rtos.schedule import DEPTH, ORDER, STEPS, Schedule
from cfepy.rtos.semaphore import Semaphore
from cfepy.rtos.stall_signals import LastResort
from cfepy.rtos.task import FOREVER, PLACE, TIMEOUT, Task, TaskExit
from cfepy.rtos.wait_graph import Wait, circles, endless
from cfepy.rtos.wait_list import WaitList
from cfepy.rtos.watchdog import STALL_S, StallWatch
from cfepy.rtos.wrapped_calls import wrapping

__all__ = [
    "AUTO",
    "CALLS",
    "DEPTH",
    "EMPTY",
    "ENDLESS",
    "FOREVER",
    "GREENLET",
    "HOLD",
    "ORDER",
    "PCT",
    "PLACE",
    "STALL_S",
    "STEPS",
    "THREAD",
    "TIMEOUT",
    "Abreast",
    "AskingPolicy",
    "CallObserver",
    "CallPointKernel",
    "CpuCosts",
    "DeadlockError",
    "Decision",
    "Deviations",
    "ExploringKernel",
    "Fair",
    "From",
    "InOrder",
    "InjectedCrash",
    "Kernel",
    "LastResort",
    "Moment",
    "Move",
    "MoveNumbers",
    "MovePolicy",
    "MovesToMake",
    "Mutex",
    "NotingPolicy",
    "Pacer",
    "Points",
    "Policy",
    "Question",
    "Queue",
    "Race",
    "RaceSide",
    "Schedule",
    "SeededRandom",
    "Semaphore",
    "StallWatch",
    "Stopwatch",
    "Task",
    "TaskExit",
    "TaskKind",
    "VectorClocks",
    "Wait",
    "WaitList",
    "allowed_cpus",
    "circles",
    "endless",
    "has_greenlets",
    "make_kernel",
    "plain_name",
    "task_kind",
    "wrapping",
]
