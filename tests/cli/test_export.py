"""`cfepy export`. tests/ground/test_xtce.py tests the content of XTCE documents, and test_series.py that of series."""

from __future__ import annotations

import csv
import io
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from cfepy.cli.csv_cells import write_rows
from cfepy.cli.main import main
from tests.cli.conftest import Write

CAPTURE = ("capture", "--for", "1")


def test_xtce_to_a_file_and_to_standard_output(
    make_mission: Write, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, file = str(make_mission("Quiet")), tmp_path / "mission.xml"
    assert main(["export", "xtce", folder, "-o", str(file)]) == 0
    assert capsys.readouterr().out == ""
    assert main(["export", "xtce", folder]) == 0
    assert capsys.readouterr().out == file.read_text(encoding="utf-8")
    assert ElementTree.parse(file).getroot().attrib["name"] == "mission"


def test_topics_are_found_by_flying(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "xtce", "rx64m_pubsub"]) == 0
    assert 'SequenceContainer name="left_to_right"' in capsys.readouterr().out


def test_bad_usage_of_xtce(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "xtce", "no_such_mission"]) == 2
    assert main(["export", "xtce", str(make_mission("Quiet")), "-o", "/no/such/x.xml"]) == 2
    assert "/no/such/x.xml: --output: cannot be written" in capsys.readouterr().err


# -- values over time --------------------------------------------------------------------------------------------------


def rows_of(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(text.splitlines()))


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[str]]:
    """The same run as a mission, a journal and a bag."""
    folder = tmp_path_factory.mktemp("sources")
    journal, bag = str(folder / "run.cfepy"), str(folder / "run.bag")
    assert main(["run", *CAPTURE, "--quiet", "--record", journal, "--bag", bag]) == 0
    return {"mission": list(CAPTURE), "journal": [journal], "bag": [bag]}


@pytest.mark.parametrize("source", ["mission", "journal", "bag"])
def test_csv_of_a_mission_a_journal_and_a_bag(
    source: str, sources: dict[str, list[str]], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", "csv", *sources[source], "/joint_states.position[1:3]", "/joint_states.header.seq"]) == 0
    rows = rows_of(capsys.readouterr().out)
    assert list(rows[0]) == ["time", "stamp", "position[1:3][0]", "position[1:3][1]", "header.seq"]
    assert rows[0]["stamp"] == "316533800.550016000"
    assert [row["header.seq"] for row in rows] == [str(number) for number in range(len(rows))]
    if source != "bag":  # whose times begin with the first message
        assert rows[0]["time"] == "0.550016000"


def test_a_part_of_the_run(sources: dict[str, list[str]], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "csv", *sources["journal"], "/joint_states", "--from", "600ms", "--until", "0.7"]) == 0
    times = [float(row["time"]) for row in rows_of(capsys.readouterr().out)]
    assert 0.6 <= times[0] < times[-1] <= 0.7


def test_several_series_in_one_file_and_in_a_folder(
    sources: dict[str, list[str]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [*sources["mission"], "/phase", "CFE_EVS_LONG_EVENT_MSG.PacketID", "/joint_states.name"]
    file, folder = tmp_path / "all.csv", tmp_path / "each"
    assert main(["export", "csv", *words, "-o", str(file)]) == 0
    rows = rows_of(file.read_text(encoding="utf-8"))
    assert [float(row["time"]) for row in rows] == sorted(float(row["time"]) for row in rows)
    assert {row["CFE_EVS_LONG_EVENT_MSG.PacketID.AppName"] for row in rows} >= {"", "CFE_EVS", "HK"}
    assert [row["/phase.data"] for row in rows if row["/phase.data"]] == ["approach"]
    assert main(["export", "csv", *words, "-o", f"{folder}/"]) == 0
    names = {each.name for each in folder.iterdir()}
    assert names == {"phase.csv", "CFE_EVS_LONG_EVENT_MSG.csv", "joint_states.csv"}
    assert list(rows_of((folder / "phase.csv").read_text(encoding="utf-8"))[0]) == ["time", "stamp", "data"]
    assert capsys.readouterr().out == ""


@pytest.mark.slow
def test_parquet_has_the_same_values(
    sources: dict[str, list[str]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    parquet: Any = pytest.importorskip("pyarrow.parquet")
    file = str(tmp_path / "values.parquet")
    words = [*sources["bag"], "/joint_states"]
    assert main(["export", "parquet", *words, "-o", file]) == 0
    assert main(["export", "csv", *words]) == 0
    rows, table = rows_of(capsys.readouterr().out), parquet.read_table(file)
    assert table.column_names == list(rows[0])
    assert table.column("position[3]").to_pylist() == [float(row["position[3]"]) for row in rows]
    assert table.column("name[0]").to_pylist()[0] == "shoulder_roll"


def test_a_text_a_truth_and_bytes_in_csv(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script = (
        "import rospy\nfrom std_msgs.msg import Bool, String, UInt8MultiArray\nrospy.init_node('n')\n"
        "on, said = rospy.Publisher('on', Bool, queue_size=1), rospy.Publisher('said', String, queue_size=1)\n"
        "blob = rospy.Publisher('blob', UInt8MultiArray, queue_size=1)\n"
        "on.publish(True)\nsaid.publish('a, \"b\"')\nblob.publish(data=b'\\x00\\xff')\nrospy.sleep(0.1)\n"
    )
    (tmp_path / "node.py").write_text(f"#!/usr/bin/env python3\n{script}", encoding="utf-8")
    assert main(["export", "csv", str(tmp_path / "node.py"), "/on", "/said", "/blob.data"]) == 0
    rows = rows_of(capsys.readouterr().out)
    assert [row["/on.data"] for row in rows] == ["1", "", ""]
    assert [row["/said.data"] for row in rows] == ["", 'a, "b"', ""]
    assert [row["/blob.data"] for row in rows] == ["", "", "00ff"]


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (
            ["csv", *CAPTURE, "/joint_state"],
            "unknown topic or packet; did you mean /joint_states?",
        ),
        (["csv", *CAPTURE, "/joint_states.nose"], "nose: unknown field of /joint_states; "),
        (["csv", *CAPTURE, "CFE_ES_HK_TIM"], "unknown telemetry packet CFE_ES_HK_TIM"),
        (["csv", *CAPTURE, "CFE_ES_MEMSTATS_TLM"], "CFE_ES_MEMSTATS_TLM: no message was sent there"),
        (["csv", *CAPTURE, "/phase", "-o", "/no/such/file.csv"], "/no/such/file.csv: --output: cannot be written"),
        (["csv", *CAPTURE, "/phase", "--from-disk"], "--from-disk: only valid for a journal"),
        (["parquet", *CAPTURE, "/phase", "-o", "-"], "--output: Parquet cannot be written to standard output"),
    ],
)
def test_bad_usage(words: list[str], why: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", *words]) == 2
    assert why in capsys.readouterr().err


def test_a_bag_is_not_flown_and_has_no_packets(
    sources: dict[str, list[str]], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", "csv", *sources["bag"], "CFE_ES_HK_TLM"]) == 2
    assert "CFE_ES_HK_TLM is not a topic" in capsys.readouterr().err
    assert main(["export", "csv", *sources["bag"], "/joint_stats"]) == 2
    assert "did you mean /joint_states?" in capsys.readouterr().err
    assert main(["export", "csv", *sources["bag"], "/phase", "--seed", "3"]) == 2
    assert "--seed: " in capsys.readouterr().err


def test_parquet_without_pyarrow(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    assert main(["export", "parquet", "capture", "/phase"]) == 2
    assert "pip install 'cfepy[parquet]'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("cell", "quoted"),
    [
        ("=cmd|' /C calc'!A0", "'=cmd|' /C calc'!A0"),
        ("+1+1", "'+1+1"),
        ("-2+3", "'-2+3"),
        ("@SUM(A1)", "'@SUM(A1)"),
        ("\t=1", "'\t=1"),
        ("-1.5e3", "-1.5e3"),
        (-1.5, "-1.5"),
        ("a=b", "a=b"),
        ("", ""),
    ],
)
def test_quote_formulas_marks_texts_that_a_spreadsheet_would_compute(cell: object, quoted: str) -> None:
    plain, marked = io.StringIO(), io.StringIO()
    write_rows(plain, [["head", cell]], quotes=False)
    write_rows(marked, [["head", cell]], quotes=True)
    assert next(csv.reader([plain.getvalue()])) == ["head", str(cell)]
    assert next(csv.reader([marked.getvalue()])) == ["head", quoted]


def test_csv_with_quote_formulas(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    node = tmp_path / "n.py"
    node.write_text(
        "import rospy\nfrom std_msgs.msg import String\nrospy.init_node('n')\n"
        "out = rospy.Publisher('/t', String, queue_size=1)\n"
        "while not rospy.is_shutdown():\n    out.publish('=1+1')\n    rospy.sleep(0.1)\n",
        encoding="utf-8",
    )
    for options, text in ((["--quote-formulas"], "'=1+1"), ([], "=1+1")):
        assert main(["export", "csv", str(node), "/t.data", "--for", "1", *options]) == 0
        assert rows_of(capsys.readouterr().out)[0]["data"] == text
