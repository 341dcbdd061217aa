"""The simulated real-time kernel: virtual time, tasks with priorities, and the objects that tasks wait for.

Code that makes tasks run or wait, decides which task runs next, or charges virtual time for it belongs here. Tasks,
queues and mutexes of OSAL are in OSAL, which builds them on the names below. Only `context`, `cpus`, `cpu_time`,
`realtime` and `watchdog` use the host's threads, CPUs and clock, and no package above does. The central file is
`cfepy/rtos/scheduler.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.rtos.context_choice import AUTO, GREENLET, THREAD, TaskKind, has_greenlets, task_kind
    from cfepy.rtos.costs import CpuCosts
    from cfepy.rtos.cpu_time import kept_waiting_ns
    from cfepy.rtos.cpus import allowed_cpus
    from cfepy.rtos.errors import DeadlockError, InjectedCrash
    from cfepy.rtos.kept_back import KeptBack
    from cfepy.rtos.kernel import ENDLESS, Kernel
    from cfepy.rtos.mutex import Mutex
    from cfepy.rtos.policies import (
        HOLD_ODDS,
        PCT,
        STARTERS_ODDS,
        Deviations,
        Fair,
        From,
        InOrder,
        SeededRandom,
        Seldom,
    )
    from cfepy.rtos.policy import (
        HOLD,
        AskingPolicy,
        Decision,
        Moment,
        NotingPolicy,
        Policy,
        Question,
        Settings,
        missed_notes,
    )
    from cfepy.rtos.queue import EMPTY, Queue
    from cfepy.rtos.realtime import Pacer, Stopwatch
    from cfepy.rtos.scheduler import SLICE_NS
    from cfepy.rtos.semaphore import Semaphore
    from cfepy.rtos.stall_signals import LastResort
    from cfepy.rtos.task import FOREVER, PLACE, TIMEOUT, Task, TaskExit, is_end_of_task
    from cfepy.rtos.task_starters import StartersFirst
    from cfepy.rtos.wait_graph import Wait, circles, endless
    from cfepy.rtos.wait_list import WaitList
    from cfepy.rtos.watchdog import STALL_S, StallWatch
    from cfepy.rtos.wrapped_calls import wrapping

__all__ = [
    "AUTO",
    "EMPTY",
    "ENDLESS",
    "FOREVER",
    "GREENLET",
    "HOLD",
    "HOLD_ODDS",
    "PCT",
    "PLACE",
    "SLICE_NS",
    "STALL_S",
    "STARTERS_ODDS",
    "THREAD",
    "TIMEOUT",
    "AskingPolicy",
    "CpuCosts",
    "DeadlockError",
    "Decision",
    "Deviations",
    "Fair",
    "From",
    "InOrder",
    "InjectedCrash",
    "KeptBack",
    "Kernel",
    "LastResort",
    "Moment",
    "Mutex",
    "NotingPolicy",
    "Pacer",
    "Policy",
    "Question",
    "Queue",
    "SeededRandom",
    "Seldom",
    "Semaphore",
    "Settings",
    "StallWatch",
    "StartersFirst",
    "Stopwatch",
    "Task",
    "TaskExit",
    "TaskKind",
    "Wait",
    "WaitList",
    "allowed_cpus",
    "circles",
    "endless",
    "has_greenlets",
    "is_end_of_task",
    "kept_waiting_ns",
    "missed_notes",
    "task_kind",
    "wrapping",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".context_choice": (
                "AUTO",
                "GREENLET",
                "THREAD",
                "TaskKind",
                "has_greenlets",
                "task_kind",
            ),
            ".costs": ("CpuCosts",),
            ".cpu_time": ("kept_waiting_ns",),
            ".cpus": ("allowed_cpus",),
            ".errors": (
                "DeadlockError",
                "InjectedCrash",
            ),
            ".kept_back": ("KeptBack",),
            ".kernel": (
                "ENDLESS",
                "Kernel",
            ),
            ".mutex": ("Mutex",),
            ".policies": (
                "HOLD_ODDS",
                "PCT",
                "STARTERS_ODDS",
                "Deviations",
                "Fair",
                "From",
                "InOrder",
                "SeededRandom",
                "Seldom",
            ),
            ".policy": (
                "HOLD",
                "AskingPolicy",
                "Decision",
                "Moment",
                "NotingPolicy",
                "Policy",
                "Question",
                "Settings",
                "missed_notes",
            ),
            ".queue": (
                "EMPTY",
                "Queue",
            ),
            ".realtime": (
                "Pacer",
                "Stopwatch",
            ),
            ".scheduler": ("SLICE_NS",),
            ".semaphore": ("Semaphore",),
            ".stall_signals": ("LastResort",),
            ".task_starters": ("StartersFirst",),
            ".task": (
                "FOREVER",
                "PLACE",
                "TIMEOUT",
                "Task",
                "TaskExit",
                "is_end_of_task",
            ),
            ".wait_graph": (
                "Wait",
                "circles",
                "endless",
            ),
            ".wait_list": ("WaitList",),
            ".watchdog": (
                "STALL_S",
                "StallWatch",
            ),
            ".wrapped_calls": ("wrapping",),
        },
    )
