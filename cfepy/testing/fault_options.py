"""The faults that a test gives to a mission: a file, a seed, a plan or a dictionary."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

from cfepy.attachment import Attachment
from cfepy.faults.injector import FaultInjector
from cfepy.faults.plan import FaultPlan

Faults = str | os.PathLike[str] | Mapping[str, Any] | FaultPlan | None
SEED = "seed:"


def fault_text(faults: Faults, place: Callable[[str | os.PathLike[str]], str]) -> str | None:
    """What a run plan says of the faults; None for those that are in the test alone.

    Args:
        faults: as the test gives them.
        place: makes the path that the command line needs.
    """
    if faults is None or isinstance(faults, Mapping | FaultPlan):
        return None
    return str(faults) if str(faults).startswith(SEED) else place(faults)


def fault_attachments(faults: Faults) -> list[Attachment]:
    """What lets faults happen that are in the test alone.

    Raises:
        UsageError: something in the plan is wrong.
    """
    if isinstance(faults, FaultPlan):
        return [FaultInjector(faults)]
    return [FaultInjector(FaultPlan.from_dict(faults))] if isinstance(faults, Mapping) else []
