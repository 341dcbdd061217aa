"""Test procedures in Python for OpenC3 COSMOS, flown against a mission in virtual time.

Code that gives procedures the functions of `openc3.script` belongs here: names from definitions, commands, telemetry,
waits, checks, suites, and the requirement matrix. It is written by COSMOS's documentation and depends on none of its
packages. The central file is `cfepy/extra/procedures/flying_suites.py`, which flies suites.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.procedures.flying_suites import (
        CampaignResult,
        FlyingSuite,
        ProcedureResult,
        Settings,
        fly_procedures,
    )
    from cfepy.extra.procedures.procedure_loader import find_procedures, suites_in
    from cfepy.extra.procedures.racy_tests import Verdicts, explore_procedures
    from cfepy.extra.procedures.requirements import Requirements, requirement

__all__ = [
    "CampaignResult",
    "FlyingSuite",
    "ProcedureResult",
    "Requirements",
    "Settings",
    "Verdicts",
    "explore_procedures",
    "find_procedures",
    "fly_procedures",
    "requirement",
    "suites_in",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".flying_suites": (
                "CampaignResult",
                "FlyingSuite",
                "Settings",
                "ProcedureResult",
                "fly_procedures",
            ),
            ".procedure_loader": ("find_procedures", "suites_in"),
            ".racy_tests": ("Verdicts", "explore_procedures"),
            ".requirements": ("Requirements", "requirement"),
        },
    )
