"""The board under a mission (cFE's Platform Support Package): its profile, memory, clock and resets.

It may import cfepy.osal and what is left of it.
"""

from __future__ import annotations

from cfepy.psp.cpu import CpuCosts
from cfepy.psp.memory import MemoryBudget, OverBudget, object_sizes
from cfepy.psp.profile import BoardProfile, available_boards, load_profile
from cfepy.psp.psp import Psp, RestartType
from cfepy.psp.retained import Retained
from cfepy.psp.watchdog import Watchdog

__all__ = [
    "BoardProfile",
    "CpuCosts",
    "MemoryBudget",
    "OverBudget",
    "Psp",
    "RestartType",
    "Retained",
    "Watchdog",
    "available_boards",
    "load_profile",
    "object_sizes",
]
