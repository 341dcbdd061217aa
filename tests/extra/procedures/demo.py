"""The plugin folder of these tests, and flights of small procedures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cfepy.extra.procedures import CampaignResult, ProcedureResult, Settings, find_procedures, fly_procedures
from cfepy.flight import command_for
from cfepy.pilot import RunPlan

PLUGIN = Path(__file__).parent / "plugin"
SUITE = PLUGIN / "targets" / "DEMO" / "procedures" / "es_suite.py"


def settings(mission: str = "lab", **options: Any) -> Settings:
    """Return settings for a mission."""
    return Settings(RunPlan((mission,), command_for(mission)), **options)


def fly(path: Path, **options: Any) -> CampaignResult:
    """Fly the procedures of a file or folder against lab."""
    return fly_procedures(find_procedures(path), settings(**options))


def fly_script(folder: Path, lines: str, **options: Any) -> ProcedureResult:
    """Fly a script against lab, with all telemetry of the bus, and return its result."""
    file = folder / "script.py"
    file.write_text(lines, encoding="utf-8")
    return fly(file, through_lab=False, **options).tests[0]


def verdicts(result: CampaignResult) -> Sequence[tuple[str, str]]:
    """Return names and verdicts."""
    return [(each.name, each.verdict) for each in result.tests]
