"""`cfepy sweep`: its tables, its files, and errors in a command line."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from cfepy.cli.main import main

WORDS = ["sweep", "rx64m_pubsub", "--for", "2", "--quiet"]


@pytest.mark.slow
def test_a_sweep_writes_what_it_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table, numbers, picture = tmp_path / "a.csv", tmp_path / "a.json", tmp_path / "a.png"
    files = ["--csv", str(table), "--json", str(numbers), "--picture", str(picture)]
    assert main([*WORDS, "--rate", "100,160", "--set", "/left/report_period=1", *files, "--jobs", "2"]) == 0
    out = capsys.readouterr().out
    assert "/left/report_period" in out
    assert "rx64m, /left/report_period=1: clean up to 100 Hz; at 160 Hz /left_to_right came at 100.0 Hz" in out
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    assert [(each["rate_hz"], each["topic"], each["lost"], each["clean"]) for each in rows] == [
        ("100", "/left_to_right", "0", "yes"),
        ("100", "/right_to_left", "0", "yes"),
        ("160", "/left_to_right", "0", "no"),
        ("160", "/right_to_left", "0", "no"),
    ]
    assert json.loads(numbers.read_text(encoding="utf-8"))["knees"][0]["clean_hz"] == 100
    assert picture.read_bytes().startswith(b"\x89PNG")
    again = tmp_path / "b.csv"
    assert (
        main([*WORDS, "--rate", "100,160", "--set", "/left/report_period=1", "--csv", str(again), "--jobs", "1"]) == 0
    )
    assert again.read_bytes() == table.read_bytes()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--rate", "0..10"], "--rate: invalid range '0..10'; it must rise from a number greater than 0"),
        (["--set", "rate"], "invalid parameter setting 'rate'; expected /NAME=VALUES, such as /arm/rate=20,50"),
        (["--set", "/left/rate=1..2:0"], "--set: invalid range '1..2:0'; it must rise in steps"),
        (
            ["--rate", "50", "--set", "/left/rate=10"],
            "--set: /left/rate is already set by --rate; leave one of them out",
        ),
        (["--picture", "a.txt"], "--picture: must be a picture"),
        (["--jobs", "1", "--cluster", "local:1"], "--jobs: cannot be combined with --cluster"),
    ],
)
def test_what_cannot_be_swept(words: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        status: object = main([*WORDS, *words])
    except SystemExit as ended:
        status = ended.code
    assert status == 2
    assert told in capsys.readouterr().err
