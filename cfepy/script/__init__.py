"""Mission scripts: commands at certain times and the answers that are expected, a step a line.

What belongs here reads a script, carries it out while a mission flies, and reports the result of each step. What must
hold of a run at any time is in `cfepy.monitors`. docs/how_to/ground_tools.md describes the language. The central
file is `cfepy/script/script_run.py`.
"""

from __future__ import annotations

from cfepy.script.conditions import APP_STATES, OPERATORS, Collected, Scene, Since
from cfepy.script.script_run import LOOK_NS, OVER, Outcome, ScriptRun, StepVerdict
from cfepy.script.standing import TYPED, StandingScript
from cfepy.script.text import RESET_TYPES, Step

__all__ = [
    "APP_STATES",
    "LOOK_NS",
    "OPERATORS",
    "OVER",
    "RESET_TYPES",
    "TYPED",
    "Collected",
    "Outcome",
    "Scene",
    "ScriptRun",
    "Since",
    "StandingScript",
    "Step",
    "StepVerdict",
]
