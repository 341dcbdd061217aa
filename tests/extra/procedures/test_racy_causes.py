"""The decisions that change the verdict of a racy test."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.procedures import Verdicts, explore_procedures
from cfepy.extra.procedures.flying_suites import FAIL
from cfepy.extra.procedures.racy_tests import SuiteTrial, cause_of_racy
from cfepy.schedules import Schedule
from tests.extra.procedures.demo import settings

ALIGNED = "import time\nwait(3 - time.time() % 1)\nfirst = get_tlm_cnt('LAB CFE_ES_HK')\n"


def explored(folder: Path, text: str, schedules: int, probes: int = 10) -> Verdicts:
    """Return the verdicts of a script under schedules."""
    file = folder / "script.py"
    file.write_text(text, encoding="utf-8")
    (found,) = explore_procedures([file], settings(through_lab=False, line_delay=0.0), schedules, probes=probes)
    return found


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        (f"{ALIGNED}wait(0.50)\nassert get_tlm_cnt('LAB CFE_ES_HK') > first\n", "it passes if a pause at script.py:"),
        ("wait(0.5)\nassert get_tlm_cnt('LAB CFE_ES_HK') == 0\n", "it fails if the procedure starts "),
    ],
)
def test_late_pause_or_start_that_changes_the_verdict_is_named(tmp_path: Path, text: str, cause: str) -> None:
    found = explored(tmp_path, text, 4)
    assert found.is_racy
    assert found.cause.startswith(cause)


def test_late_pauses_of_one_line_are_counted(tmp_path: Path) -> None:
    text = (
        "import time\nstart = time.time()\nfor each in range(4):\n    wait(0.25)\nassert time.time() - start < 1.06\n"
    )
    found = explored(tmp_path, text, 2, probes=40)
    assert found.is_racy
    assert found.cause.startswith("it fails if 2 pauses at script.py:4 last ")


def test_search_that_ends_early_says_so(tmp_path: Path) -> None:
    file = tmp_path / "script.py"
    file.write_text("wait(0.5)\nassert get_tlm_cnt('LAB CFE_ES_HK') == 0\n", encoding="utf-8")
    late = settings(through_lab=False, line_delay=0.0, ground_seed=3)
    trial = SuiteTrial(file, "", late, "script::script::script", FAIL)
    text = cause_of_racy(trial, Schedule(), most_s=0.0)
    assert text.startswith("it fails if ")
    assert "the search ended after 0 s" in text


def test_test_with_one_verdict_has_no_cause(tmp_path: Path) -> None:
    found = explored(tmp_path, "wait(1)\nassert False\n", 2)
    assert (found.is_racy, found.decided, found.deviant) == (False, "", None)
