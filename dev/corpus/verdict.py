"""Result of a scenario, and whether its expectations hold."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from dev.corpus import likeness
from dev.corpus.scenarios import Scenario


@dataclass(frozen=True, slots=True)
class Outcome:
    """Results of a run.

    Attributes:
        counts, messages, remarks, rates: the observer's N, T, R, and messages per second by topic.
        status: the node's exit status, None if it had to be killed.
        ended_itself: whether it ended before it was asked to.
        out, helpers_out: output of the node and of its helpers.
        files: sizes of the files in the scenario's folder, as "@TMP/name".
        wall_s: wall time of the run, s.
    """

    counts: Mapping[str, int] = field(default_factory=dict)
    messages: Mapping[str, list[Any]] = field(default_factory=dict)
    remarks: Mapping[str, Any] = field(default_factory=dict)
    rates: Mapping[str, float | None] = field(default_factory=dict)
    status: int | None = None
    ended_itself: bool = False
    out: str = ""
    helpers_out: str = ""
    files: Mapping[str, int] = field(default_factory=dict)
    wall_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether all expectations of a scenario hold. `reason` names those that do not, or is ""."""

    id: str
    reason: str
    wall_s: float

    @property
    def passed(self) -> bool:
        """Whether all expectations hold."""
        return not self.reason


def judge(scenario: Scenario, outcome: Outcome) -> Verdict:
    """Evaluate a scenario's expectations.

    They can use N, T, R, rate, rc, out, hout (output of the helpers), `approx(a, b, tolerance)`, and rec with self_exit
    and files. For driven nodes, they contain digests of the results on ROS (`likeness.py`): of `like(topic)`, of
    `said`, of `about(remark)`.
    """
    names = {
        "N": outcome.counts,
        "T": outcome.messages,
        "R": outcome.remarks,
        "rate": outcome.rates,
        "rc": outcome.status,
        "out": outcome.out,
        "hout": outcome.helpers_out,
        "rec": {"self_exit": outcome.ended_itself, "files": outcome.files},
        "approx": _approx,
        "like": lambda topic: likeness.digest(likeness.messages(outcome.messages[topic])),
        "said": likeness.digest(likeness.lines(outcome.out)),
        "about": lambda name: likeness.digest(likeness.plain(outcome.remarks[name])),
    }
    failed = [expression for expression in scenario.expect if not _holds(expression, names)]
    reason = "; ".join([*failed, *_last_error(outcome)]) if failed else ""
    return Verdict(scenario.id, reason, outcome.wall_s)


def _holds(expression: str, names: dict[str, Any]) -> bool:
    try:
        return bool(eval(expression, dict(names)))
    except (LookupError, TypeError, ValueError, AttributeError):
        return False  # the expression uses a value that is missing


def _approx(value: float, expected: float, tolerance: float = 1e-9) -> bool:
    return math.isclose(value, expected, rel_tol=0.0, abs_tol=tolerance)


def _last_error(outcome: Outcome) -> list[str]:
    """Return the main line of a failure: the last one of a traceback, or the error that ended the stimulus."""
    if "stimulus failed" in outcome.remarks:
        return [f"stimulus: {outcome.remarks['stimulus failed'].strip().splitlines()[-1]}"]
    lines = outcome.out.splitlines()
    if not any(line.startswith("Traceback") for line in lines):
        return []
    return [line for line in lines if "Error" in line.split(":")[0]][-1:]
