"""`cfepy graph --mids`: the table, and the same as JSON."""

from __future__ import annotations

import json

import pytest

from cfepy.cli.main import main
from tests.cli.conftest import Write


def test_the_table(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["graph", "--mids", str(make_mission("Chatty"))]) == 0
    lines = capsys.readouterr().out.splitlines()
    row = next(line for line in lines if "0x0890" in line)
    assert row.split() == ["0x0890", "0x0890", "telemetry", "CHATTY", "CHATTY"]


def test_as_json(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_mission("Chatty")
    assert main(["graph", "--mids", str(folder), "--json", "-"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert rows == sorted(rows, key=lambda row: row["msg_id"])
    assert main(["graph", "--mids", str(folder), "--json", str(folder / "x.json")]) == 0
    assert json.loads((folder / "x.json").read_text(encoding="utf-8")) == rows


def test_a_file_that_cannot_be_written(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["graph", "--mids", str(make_mission("Quiet")), "--json", "/no/such/file"]) == 2
    assert "/no/such/file: --json: cannot be written" in capsys.readouterr().err
