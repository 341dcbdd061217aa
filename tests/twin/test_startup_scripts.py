"""Startup scripts with bad lines give the system log of NASA's cFE; `python -m dev.twin.startup_scripts` records it."""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.twin import real
from dev.twin.startup_scripts import load, play, play_real, write_script

RELEASES = ("7.0.0", "7.0.1")
RECORDS = {release: load(release) for release in RELEASES}
COUNT = len(RECORDS["7.0.1"])
QUICK = 3


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("number", range(QUICK))
def test_script_has_the_log_of_nasas_cfe(release: str, number: int) -> None:
    script, lines = RECORDS[release][number]
    assert play(script, release) == lines


@pytest.mark.slow
@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("number", range(QUICK, COUNT))
def test_further_script_has_the_log_of_nasas_cfe(release: str, number: int) -> None:
    script, lines = RECORDS[release][number]
    assert play(script, release) == lines


@pytest.mark.parametrize("release", RELEASES)
def test_scripts_depend_only_on_the_seed_and_have_good_and_bad_lines(release: str) -> None:
    assert [write_script(seed) for seed in range(1, COUNT + 1)] == [script for script, _ in RECORDS[release]]
    text = "\n".join(line for _, lines in RECORDS[release] for line in lines)
    for part in ("Invalid ES Startup", "Unexpected EntryType", "Could not load file", "Duplicate Lib name", "APP: "):
        assert part in text


@pytest.mark.slow
def test_new_script_has_the_log_of_nasas_cfe() -> None:
    built = real.installed()
    if built is None:
        pytest.skip(f"{real.VARIABLE} names no real cFE")
    script = write_script(4711)
    assert play(script, real.release_of(built)) == play_real(built, script)


def test_release_of_an_executable_is_the_newest_that_it_names(tmp_path: Path) -> None:
    (tmp_path / real.EXECUTABLE).write_bytes(b"\0v7.0.0+dev0\0v7.0.1+dev0\0v7.0.0\0")
    assert real.release_of(tmp_path) == "7.0.1"
    (tmp_path / real.EXECUTABLE).write_bytes(b"\0v7.0.0+dev0\0")
    assert real.release_of(tmp_path) == "7.0.0"
    (tmp_path / real.EXECUTABLE).write_bytes(b"\0v6.8.0\0")
    with pytest.raises(ValueError, match=r"names no release of 7\.0\.0"):
        real.release_of(tmp_path)
