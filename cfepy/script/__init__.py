"""Mission scripts: commands at given times and expected answers, one step per line.

Code that reads a script, executes it while a mission flies, or reports the result of each step belongs here. Rules for
the whole run are in `cfepy.monitors`. See docs/how_to/ground_tools.md for the language. The central file is
`cfepy/script/script_run.py`.
"""

from __future__ import annotations

from cfepy.script.conditions import (
    APP_STATES,
    OPERATORS,
    Collected,
    Comparison,
    EventCondition,
    RosAction,
    Scene,
    Since,
    TelemetryCondition,
)
from cfepy.script.script_run import LOOK_NS, OVER, Outcome, ScriptRun, StepVerdict
from cfepy.script.standing import TYPED, StandingScript
from cfepy.script.text import RESET_TYPES, ROS_STEPS, Step, read_script, without_when

__all__ = [
    "APP_STATES",
    "LOOK_NS",
    "OPERATORS",
    "OVER",
    "RESET_TYPES",
    "ROS_STEPS",
    "TYPED",
    "Collected",
    "Comparison",
    "EventCondition",
    "Outcome",
    "RosAction",
    "Scene",
    "ScriptRun",
    "Since",
    "StandingScript",
    "Step",
    "StepVerdict",
    "TelemetryCondition",
    "read_script",
    "without_when",
]
