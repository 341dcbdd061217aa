"""`cfepy tbl`: build, show, diff, verify, and its error messages."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from cfepy.cli.main import main
from cfepy.ground.dictionary import table_type
from cfepy.tbl import TableImage, build, read
from cfepy.tbl.image import with_mark

DATA = Path(__file__).parents[1] / "data"
SAMPLE = DATA / "sample_app_tbl.tbl"

OWN = """
table: MINE.Gains
description: Gains of mine
spacecraft_id: 42
layout: {Kind: u8, Value: u16}
count: 3
rows:
- {Kind: 1, Value: 500}
- {row: 2, Kind: 3}
"""

APP = """
from cfepy.msg import Layout
from cfepy.tbl import TableType

TABLES = (TableType("LIMITS.Points", Layout("Point", [("Low", "i16"), ("High", "i16")]), rows=4),)


def Main(cfe):
    raise AssertionError("a tool starts no app")
"""


def test_show_then_build_gives_the_same_bytes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tbl", "show", "--yaml", "-", str(SAMPLE)]) == 0
    source = tmp_path / "sample.yaml"
    source.write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(["tbl", "build", str(source)]) == 0
    assert (tmp_path / "sample.tbl").read_bytes() == SAMPLE.read_bytes()
    assert capsys.readouterr().out.endswith("sample.tbl: SAMPLE_APP.ExampleTable, 4 bytes, CRC 0x9C00\n")


def test_show_for_people(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tbl", "show", str(SAMPLE)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[:3] == [
        "SAMPLE_APP.ExampleTable: Table Utility Test Table",
        "  spacecraft 66, processor 1, application 0, time 0.00000 s",
        "  4 bytes, CRC 0x9C00",
    ]
    assert [line.split() for line in lines[5:]] == [["field", "value"], ["Int1", "1"], ["Int2", "2"]]


def test_show_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tbl", "show", "--json", "-", str(DATA / "sch_lab_table.tbl")]) == 0
    values = json.loads(capsys.readouterr().out)
    assert values["crc"] == 0x70D5
    assert values["rows"][0]["TickRate"] == 100
    assert [row["MessageID"] for row in values["rows"][0]["Config"]][:2] == [0x1808, 0x180C]


def test_layout_in_a_file_of_ones_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source, target = tmp_path / "gains.yaml", tmp_path / "out.tbl"
    source.write_text(OWN, encoding="utf-8")
    assert main(["tbl", "build", str(source), "-o", str(target)]) == 0
    image = read(target.read_bytes())
    assert (image.name, image.spacecraft_id, image.description) == ("MINE.Gains", 42, "Gains of mine")
    assert image.data == bytes.fromhex("0100f401 00000000 03000000")
    capsys.readouterr()
    assert main(["tbl", "show", str(target), "--yaml", "-", "--layout", str(source)]) == 0
    again = tmp_path / "again.yaml"
    again.write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(["tbl", "build", str(again), "-o", str(tmp_path / "again.tbl")]) == 0
    assert (tmp_path / "again.tbl").read_bytes() == target.read_bytes()
    assert main(["tbl", "show", str(target), "--layout", str(source)]) == 0
    assert ["2", "3", "0"] in [line.split() for line in capsys.readouterr().out.splitlines()]


def test_tables_of_a_missions_own_apps(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission = tmp_path / "mission"
    mission.mkdir()
    (mission / "limits.py").write_text(APP, encoding="utf-8")
    (mission / "startup.scr").write_text("CFE_APP, limits, Main, LIMITS, 50, 8192, 0, 0;\n!\n", encoding="utf-8")
    source = tmp_path / "points.yaml"
    source.write_text("table: LIMITS.Points\nrows:\n- {Low: -1, High: 1}\n", encoding="utf-8")
    assert main(["tbl", "build", str(source)]) == 2
    assert main(["tbl", "build", str(source), "--mission", str(mission)]) == 0
    assert read((tmp_path / "points.tbl").read_bytes()).data == bytes.fromhex("ffff0100") + bytes(12)
    assert "unknown table LIMITS.Points" in capsys.readouterr().err


def test_file_in_a_missions_folder_needs_no_mission_option(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "limits.py").write_text(APP, encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, limits, Main, LIMITS, 50, 8192, 0, 0;\n!\n", encoding="utf-8")
    source = tmp_path / "points.yaml"
    source.write_text("table: LIMITS.Points\nrows:\n- {Low: -1, High: 1}\n", encoding="utf-8")
    assert main(["tbl", "build", str(source)]) == 0
    assert main(["tbl", "show", str(tmp_path / "points.tbl")]) == 0
    assert re.search(r"^ +0 +-1 +1$", capsys.readouterr().out, re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    assert main(["tbl", "diff", "points.tbl", "points.yaml"]) == 0


def test_an_unknown_table_gets_the_nearest_known_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "copy.yaml"
    source.write_text("table: HK.CopyTabel\nrows: []\n", encoding="utf-8")
    assert main(["tbl", "build", str(source)]) == 2
    said = "unknown table HK.CopyTabel; did you mean HK.CopyTable? Otherwise name its mission with --mission, or add"
    assert said in capsys.readouterr().err


def test_an_app_that_cannot_be_read_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "limits.py").write_text(APP + "\nraise ValueError('boom')\n", encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, limits, Main, LIMITS, 50, 8192, 0, 0;\n!\n", encoding="utf-8")
    assert main(["tbl", "show", str(SAMPLE), "--mission", str(tmp_path)]) == 0
    assert "limits.py could not be read: ValueError: boom" in capsys.readouterr().err


def test_diff_names_fields_and_rows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    other = tmp_path / "other.tbl"
    image = read(SAMPLE.read_bytes())
    other.write_bytes(build(image._replace(data=bytes([1, 0, 9, 0]), processor_id=2)))
    assert main(["tbl", "diff", str(SAMPLE), str(other)]) == 1
    assert capsys.readouterr().out == "processor_id: 1 -> 2\nrows[0].Int2: 2 -> 9\n"
    assert main(["tbl", "diff", str(SAMPLE), str(SAMPLE)]) == 0
    assert capsys.readouterr().out == ""


def test_diff_of_unknown_layouts_shows_bytes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first, second = tmp_path / "a.tbl", tmp_path / "b.tbl"
    first.write_bytes(build(TableImage("WHO.Knows", bytes(20))))
    second.write_bytes(build(TableImage("WHO.Knows", bytes(18) + b"\1\2")))
    assert main(["tbl", "diff", str(first), str(second)]) == 1
    assert capsys.readouterr().out == "data[0x0010]: 00 00 00 00 -> 00 00 01 02\n"


def test_diff_takes_yaml_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["tbl", "show", "--yaml", "-", str(SAMPLE)])
    source = tmp_path / "sample.yaml"
    source.write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(["tbl", "diff", str(SAMPLE), str(source)]) == 0


def test_verify_takes_all_golden_tables(capsys: pytest.CaptureFixture[str]) -> None:
    files = [str(path) for path in sorted(DATA.glob("*.tbl"))]
    assert main(["tbl", "verify", *files]) == 0
    assert capsys.readouterr().out.count(", good") == len(files) == 5


def changed(at: int, *values: int) -> bytes:
    data = bytearray(SAMPLE.read_bytes())
    data[at : at + len(values)] = values
    return bytes(data)


@pytest.mark.parametrize(
    ("data", "offset", "field"),
    [
        (b"", 0, "file header"),
        (SAMPLE.read_bytes()[:100], 100, "table header"),
        (changed(0, 0), 0, "content type"),
        (changed(7, 9), 4, "subtype"),
        (changed(11, 65), 8, "length"),
        (changed(60, 1), 57, "description"),
        (changed(32, *b"x" * 32), 63, "description"),
        (changed(67, 1), 64, "integrity mark"),
        (changed(71, 4), 68, "offset"),
        (changed(75, 5), 72, "number of bytes"),
        (changed(72, 0, 0, 0, 0), 72, "number of bytes"),
        (changed(76, *b"SAMPLE_APP_"), 76, "table name"),
        (changed(76, *b"x" * 40), 115, "table name"),
        (SAMPLE.read_bytes()[:-1], 119, "data"),
        (SAMPLE.read_bytes() + b"x", 120, "data"),
        (with_mark(SAMPLE.read_bytes())[:-1] + b"x", 64, "integrity mark"),
    ],
)
def test_verify_reports_offset_and_field(
    data: bytes, offset: int, field: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "bad.tbl"
    path.write_bytes(data)
    assert main(["tbl", "verify", str(path), str(SAMPLE)]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith(f"{path}: byte {offset}: {field}: ") for line in lines)
    assert lines[-1].endswith("good")


@pytest.mark.parametrize(
    ("table", "row", "fault"),
    [
        ("SAMPLE_APP.ExampleTable", {"Int1": 11}, "Int1 is 11, at most 10 is allowed"),
        ("HK.CopyTable", {"InputMid": 0x0901, "NumBytes": 1}, "Invalid Output MID: 0x0 at entry index 0"),
        ("SCH.MSG_DEFS", {"MessageBuffer": [0, 1]}, "idx[0] mid[0x1] len[7] buf[0]"),
    ],
)
def test_verify_asks_the_application(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], table: str, row: dict[str, Any], fault: str
) -> None:
    kind = table_type(table, None)
    path = tmp_path / "t.tbl"
    path.write_bytes(build(kind.image([row])))
    assert main(["tbl", "verify", str(path)]) == 1
    assert f"{path}: byte 116: data: the application refuses it: {fault}" in capsys.readouterr().out
    path.write_bytes(build(TableImage(table, kind.pack([row])[:-1])))
    assert main(["tbl", "verify", str(path)]) == 0, "of a part it cannot be asked"


def test_verify_reports_every_fault(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "bad.tbl"
    path.write_bytes(changed(71, 4) + b"x")
    assert main(["tbl", "verify", str(path)]) == 1
    assert [line.split(": ")[1] for line in capsys.readouterr().out.splitlines()] == ["byte 68", "byte 120"]


def test_mark(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source, target = tmp_path / "gains.yaml", tmp_path / "gains.tbl"
    source.write_text(OWN, encoding="utf-8")
    assert main(["tbl", "build", str(source)]) == 0
    data = target.read_bytes()
    assert data == with_mark(data)
    assert main(["tbl", "verify", str(target)]) == 0
    assert "marked, good" in capsys.readouterr().out


def test_no_mark_when_the_yaml_says_so(tmp_path: Path) -> None:
    source, target = tmp_path / "gains.yaml", tmp_path / "gains.tbl"
    source.write_text(OWN + "mark: false\n", encoding="utf-8")
    assert main(["tbl", "build", str(source)]) == 0
    assert target.read_bytes()[64:68] == bytes(4)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["show", "nowhere.tbl"], "nowhere.tbl: cannot be read: No such file"),
        (["show", str(DATA / "cfe_evs.log")], "is not a table file: the subtype of a table file must be 8, not 16"),
        (["build", "nowhere.yaml"], "nowhere.yaml: cannot be read"),
        (["show", str(SAMPLE), "--mission", "nowhere"], "unknown mission"),
        (["show", str(SAMPLE), "--layout", "nowhere.yaml"], "nowhere.yaml: cannot be read"),
    ],
)
def test_errors(arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tbl", *arguments]) == 2
    assert words in capsys.readouterr().err


def test_output_that_cannot_be_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "gains.yaml"
    source.write_text(OWN, encoding="utf-8")
    assert main(["tbl", "build", str(source), "-o", str(tmp_path / "no" / "x.tbl")]) == 2
    assert "cannot be written" in capsys.readouterr().err


def test_layout_file_without_layout(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "rows.yaml"
    source.write_text("table: A.B\nrows: []\n", encoding="utf-8")
    assert main(["tbl", "show", str(SAMPLE), "--layout", str(source)]) == 2
    assert f"{source}:1: missing layout" in capsys.readouterr().err


def test_the_yaml_of_the_documentation_is_good(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (DATA.parents[1] / "docs/how_to/tables_and_parameters.md").read_text(encoding="utf-8")
    blocks = [block for block in re.findall(r"```yaml\n(.*?)```", text, re.DOTALL) if block.startswith("table:")]
    assert len(blocks) == 2
    for number, block in enumerate(blocks):
        source = tmp_path / f"{number}.yaml"
        source.write_text(block, encoding="utf-8")
        assert main(["tbl", "build", str(source)]) == 0, capsys.readouterr().err
    hk = read((tmp_path / "0.tbl").read_bytes())
    assert (hk.name, len(hk.data), hk.data[9 * 16 : 9 * 16 + 2]) == ("HK.CopyTable", 2048, b"\x83\x08")
