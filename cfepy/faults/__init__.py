"""Faults: what goes wrong in a run, from a plan or from a seed, at the same instants every time.

It stands below missions, which it meets as an attachment.
"""

from cfepy.faults.gate import When
from cfepy.faults.injector import FaultInjector
from cfepy.faults.plan import Fault, FaultPlan, read_plan
from cfepy.faults.random_plan import Targets, random_plan

__all__ = ["Fault", "FaultInjector", "FaultPlan", "Targets", "When", "random_plan", "read_plan"]
