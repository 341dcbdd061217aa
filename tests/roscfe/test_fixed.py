"""Strings and vectors of fixed capacity: used like std's, with an error if data does not fit."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from dev.roscfe.building import compile_program, needs_cpp
from tests.roscfe.test_fuzz import SANITIZERS

pytestmark = [pytest.mark.slow, needs_cpp]
TEXT, ARRAY = (f"{what} is too long for a field of a message" for what in ("a text", "an array"))
REFUSED = {
    1: f"{TEXT}: 4 at most, 5 wanted",
    2: f"{TEXT}: 4 at most, 5 wanted",
    3: f"{TEXT}: 4 at most, 5 wanted",
    4: f"{TEXT}: 4 at most, 5 wanted",
    5: f"{TEXT}: 4 at most, 70000 wanted",
    6: f"{TEXT}: 4 at most, 5 wanted",
    7: f"{ARRAY}: 2 at most, 3 wanted",
    8: f"{ARRAY}: 2 at most, 3 wanted",
    9: f"{ARRAY}: 2 at most, 3 wanted",
    10: f"{ARRAY}: 2 at most, 3 wanted",
    11: f"{ARRAY}: 2 at most, 3 wanted",
    12: f"{ARRAY}: 2 at most, 3 wanted",
    13: "exception: FixedString: index out of range",
    14: "exception: FixedVector: index out of range",
    15: "exception: FixedString: place out of range",
}


def test_fixed_containers_act_like_std_and_refuse_too_much_data(tmp_path: Path) -> None:
    source = Path(__file__).with_name("fixed.cpp")
    program = compile_program(tmp_path / "fixed", [source], "-O1", "-g", *SANITIZERS)
    done = subprocess.run([program, "0"], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr, done.returncode) == ("", "", 0)
    for case, said in REFUSED.items():
        done = subprocess.run([program, str(case)], capture_output=True, text=True, check=False)
        assert (done.stdout, done.returncode) == (said + "\n", 3), case
