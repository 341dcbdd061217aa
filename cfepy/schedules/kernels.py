"""The kernel of a run: the plain one for first come, first served, and an exploring one for any other schedule.

The plain kernel is nearly always used, so the other one is loaded only if a policy is given.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.rtos import Kernel, Policy
from cfepy.trace import Trace


def make_kernel(
    context: str = "thread",
    trace: Trace | None = None,
    policy: Policy | None = None,
    tick_ns: int = 0,
    switch_cost_ns: int = 0,
    seed: int = 0,
    derived: Callable[[type[Kernel]], type[Kernel]] = lambda base: base,
) -> Kernel:
    """Return the kernel for a run: the plain one without a policy.

    Args:
        context: see `Kernel`, as for the arguments not named here.
        policy: decides which task runs next; None for first come, first served.
        derived: derives the class of the kernel from the default one.
    """
    if policy is None:
        return derived(Kernel)(context, trace, tick_ns, switch_cost_ns, seed)
    from cfepy.schedules.exploring import CallPointKernel, ExploringKernel
    from cfepy.schedules.preemption_points import CALLS, Points

    kind: Any = derived(CallPointKernel if Points.parse(policy.points).kind == CALLS else ExploringKernel)
    made: Kernel = kind(context, trace, policy, tick_ns, switch_cost_ns, seed)
    return made
