"""Faults: errors injected into a run, from a plan or from a seed, at the same times in every run.

Code that defines the contents of a plan, reads and checks it, or injects its faults belongs here: a `FaultInjector` is
an attachment, so the mission and its parts do not know it. Checking a run, with or without faults, belongs to
`cfepy.monitors`. The central file is `cfepy/faults/injector.py`.
"""

from cfepy.faults.fault_plan import Fault, FaultPlan, read_plan
from cfepy.faults.injector import FaultInjector
from cfepy.faults.plan_check import Prepared, check_plan, plan_of, prepare
from cfepy.faults.targets import Found, Targets, look_at, random_plan, targets_of
from cfepy.faults.timing import When

__all__ = [
    "Fault",
    "FaultInjector",
    "FaultPlan",
    "Found",
    "Prepared",
    "Targets",
    "When",
    "check_plan",
    "look_at",
    "plan_of",
    "prepare",
    "random_plan",
    "read_plan",
    "targets_of",
]
