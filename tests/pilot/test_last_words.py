"""The failure of a node that ends with an error has the last line of its standard error."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.pilot import Failure, RunPlan, failures_of, fly

SCRIPT = "CFE_APP, node.py, __main__, NODE, 100, 16384, 0x0, 1;\n!\n"


def failure_of(folder: Path, source: str) -> Failure:
    """Return the failure of a node with this source."""
    (folder / "node.py").write_text(source, encoding="utf-8")
    (folder / "startup.scr").write_text(SCRIPT, encoding="utf-8")
    (failure,) = failures_of(fly(RunPlan((str(folder),), seconds=1.0)).problems)
    return failure


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("import sys\nsys.exit('no calibration')\n", ": no calibration"),
        ("import sys\nprint('about to stop')\nsys.exit(1)\n", ""),
        ("import sys\nprint('\\x1b[31mlow battery\\x1b[0m', file=sys.stderr)\nsys.exit(1)\n", ": low battery"),
        ("import sys\nsys.exit('x' * 500)\n", f": {'x' * 200}"),
    ],
)
def test_failure_has_the_last_line_of_the_standard_error(tmp_path: Path, source: str, said: str) -> None:
    assert failure_of(tmp_path, source).text == f"exit status 1 (node /NODE){said}"


def test_other_values_are_the_same_failure_and_other_words_another(tmp_path: Path) -> None:
    first, second, third = (
        failure_of(tmp_path, f"import sys\nsys.exit({said!r})\n")
        for said in ("saved [1, 2] of 3 'b'", "saved [(1, 'a')] of 4 'c'", "lost [1, 2] of 3")
    )
    assert first.group == second.group
    assert first.group != third.group
