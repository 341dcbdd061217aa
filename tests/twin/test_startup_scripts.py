"""Startup scripts with bad lines give the system log of NASA's cFE; `python -m dev.twin.startup_scripts` records it."""

from __future__ import annotations

import pytest

from dev.twin import real
from dev.twin.startup_scripts import load, play, play_real, write_script

RECORDS = load()
QUICK = 3


@pytest.mark.parametrize("number", range(QUICK))
def test_script_has_the_log_of_nasas_cfe(number: int) -> None:
    script, lines = RECORDS[number]
    assert play(script) == lines


@pytest.mark.slow
@pytest.mark.parametrize("number", range(QUICK, len(RECORDS)))
def test_further_script_has_the_log_of_nasas_cfe(number: int) -> None:
    script, lines = RECORDS[number]
    assert play(script) == lines


def test_scripts_depend_only_on_the_seed_and_have_good_and_bad_lines() -> None:
    assert [write_script(seed) for seed in range(1, len(RECORDS) + 1)] == [script for script, _ in RECORDS]
    text = "\n".join(line for _, lines in RECORDS for line in lines)
    for part in ("Invalid ES Startup", "Unexpected EntryType", "Could not load file", "Duplicate Lib name", "APP: "):
        assert part in text


@pytest.mark.slow
def test_new_script_has_the_log_of_nasas_cfe() -> None:
    built = real.installed()
    if built is None:
        pytest.skip(f"{real.VARIABLE} names no real cFE")
    script = write_script(4711)
    assert play(script) == play_real(built, script)
