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


@pytest.mark.slow
def test_drawn_runs_are_the_same_from_any_number_of_processes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    draws = ["--draws", "6", "--draw", "/left/rate=uniform:60,180", "--draw", "/left/report_period=choice:1,2"]
    measures = ["--measure", "/left_to_right", "--measure", "last:/left_to_right.data"]
    outs = []
    for jobs in ("1", "2"):
        files = ["--csv", f"{jobs}.csv", "--json", f"{jobs}.json", "--picture", f"{jobs}.svg"]
        assert main([*WORDS, *draws, *measures, *files, "--jobs", jobs]) == 0
        outs.append(capsys.readouterr().out.replace(f"{jobs}.svg", "PICTURE"))
    assert outs[0] == outs[1]
    for suffix in ("csv", "json", "svg"):
        assert Path(f"1.{suffix}").read_bytes() == Path(f"2.{suffix}").read_bytes()
    rows = list(csv.DictReader(Path("1.csv").read_text(encoding="utf-8").splitlines()))
    assert [each["run"] for each in rows] == list("012345") == [each["seed"] for each in rows]
    (group,) = json.loads(Path("1.json").read_text(encoding="utf-8"))["groups"]
    assert group["runs"] == 6
    assert "last:/left_to_right.data" in [each["measure"] for each in group["measures"]]
    worst = rows[group["worst"]["run"]]
    words = group["worst"]["command"].split()
    assert words[:2] == ["cfepy", "run"]
    assert f"/left/rate={worst['/left/rate']}" in words
    assert main([*words[1:], "--quiet", "--json", "again.json"]) == 0
    assert json.loads(Path("again.json").read_text(encoding="utf-8"))["trace"] == worst["trace"]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--draw", "/left/rate"], "invalid drawn parameter '/left/rate'; expected /NAME=KIND:NUMBERS"),
        (["--draw", "/left/rate=normal:1,-1"], "/left/rate: invalid distribution 'normal:1,-1'; DEVIATION must"),
        (["--draw", "/left/rate=normal:1,1", "--draw", "/left/rate=normal:1,2"], "--draw: /left/rate is given twice"),
        (["--draw", "/left/rate=normal:1,1", "--set", "/left/rate=5"], "--draw: /left/rate is already set by --set"),
        (["--draw", "/left/rate=normal:1,1", "--rate", "50"], "--draw: /left/rate is already set by --rate"),
        (["--draw-seed", "1"], "--draw-seed: requires --draw or --draws"),
        (["--draws", "100001"], "more than 100,000 points"),
        (["--measure", "most:/left_to_right.data"], "--measure: unknown measure 'most'"),
    ],
)
def test_draws_that_are_refused(words: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        status: object = main([*WORDS, *words])
    except SystemExit as ended:
        status = ended.code
    assert status == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--set", "--draw"])
def test_parameter_of_an_unknown_node_is_reported_once(option: str, capsys: pytest.CaptureFixture[str]) -> None:
    values = "1,2" if option == "--set" else "uniform:1,2"
    assert main([*WORDS, option, f"/lef/rate={values}", "--jobs", "1", "--for", "0.7"]) == 0
    text = f"{option} /lef/rate: unknown node /lef; did you mean /left?"
    assert capsys.readouterr().err.count(text) == 1
