"""`--profile`: the wall time of a run by application, callback, service and library, and a file for a flame graph.

Code that measures how fast cfepy itself flies a mission belongs here. Virtual time and its costs belong to the kernel
and the board. `cfepy.extra.profiler.task_times` measures the time of each task. `stack_sampler` (greenlets) and
`turn_tracer` (threads) see the stacks inside. All only read: the trace of the run stays the same. The central file is
`cfepy/extra/profiler/run_profile.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.profiler.flame_files import flame_text
    from cfepy.extra.profiler.profile_report import profile_tables
    from cfepy.extra.profiler.run_profile import RunProfile
    from cfepy.extra.profiler.stack_sampler import StackSampler
    from cfepy.extra.profiler.task_times import TimedTasks
    from cfepy.extra.profiler.turn_tracer import TurnTracer

__all__ = [
    "RunProfile",
    "StackSampler",
    "TimedTasks",
    "TurnTracer",
    "flame_text",
    "profile_tables",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".flame_files": ("flame_text",),
            ".profile_report": ("profile_tables",),
            ".run_profile": ("RunProfile",),
            ".stack_sampler": ("StackSampler",),
            ".task_times": ("TimedTasks",),
            ".turn_tracer": ("TurnTracer",),
        },
    )
