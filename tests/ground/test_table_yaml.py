"""Table files as YAML: lossless conversion both ways, layouts in the file, and errors with their location."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.fs import FileHeader, TableHeader
from cfepy.fs.header import SUBTYPE_TBL_IMG
from cfepy.ground.cfe_files import table_yaml
from cfepy.ground.cfe_files.table_file import TableContents, document, take_apart
from cfepy.ground.dictionary import table_types
from cfepy.msg import Layout
from cfepy.status import UsageError
from cfepy.tbl import TableType

DATA = Path(__file__).parents[1] / "data"
GOLDEN = sorted(path.name for path in DATA.glob("*.tbl"))
KINDS = table_types(None, [])

POINT = Layout("Point", [("X", "i16"), ("Y", "f32")])
ROW = Layout(
    "Row", [("MsgId", "u16"), ("Name", "char[6]"), ("Flag", "bool"), ("Points", (POINT, 2)), ("Bytes", "u8[5]")]
)
PLAN = TableType("APP.Plan", ROW, rows=8)
LINES = TableType("APP.Lines", Layout("Lines", [("row", "u8"), ("Value", "u16")]), rows=4)


def find(name: str) -> TableType | None:
    return {"APP.Plan": PLAN, "APP.Lines": LINES}.get(name) or KINDS.get(name)


def through_yaml(file: TableContents, folder: Path) -> TableContents:
    path = folder / "table.yaml"
    path.write_text(table_yaml.write(document(file)), encoding="utf-8")
    return table_yaml.read(path, find)


def file_of(kind: TableType, image: bytes, offset: int = 0) -> TableContents:
    header = FileHeader("a description", SUBTYPE_TBL_IMG, spacecraft_id=66, processor_id=1)
    return TableContents(header, TableHeader(kind.name, len(image), offset), image, b"", kind)


@pytest.mark.parametrize("name", GOLDEN)
def test_golden_tables_survive_conversion_to_yaml(name: str, tmp_path: Path) -> None:
    data = (DATA / name).read_bytes()
    assert through_yaml(take_apart(data, find, name), tmp_path).pack() == data


def test_all_golden_tables_are_tested() -> None:
    assert len(GOLDEN) == 5


@settings(max_examples=60, deadline=None)
@given(image=st.binary(min_size=PLAN.size, max_size=PLAN.size))
def test_any_image_survives_conversion_to_yaml(image: bytes, tmp_path_factory: pytest.TempPathFactory) -> None:
    file = file_of(PLAN, image)
    assert through_yaml(file, tmp_path_factory.mktemp("any")).pack() == file.pack()


@settings(max_examples=25, deadline=None)
@given(
    used=st.dictionaries(
        st.integers(0, 7),
        st.fixed_dictionaries(
            {
                "MsgId": st.integers(0, 0xFFFF),
                "Name": st.text(st.characters(exclude_characters="\0", codec="ascii"), max_size=6),
                "Bytes": st.lists(st.integers(0, 255), max_size=5),
                "Points": st.lists(
                    st.fixed_dictionaries({"X": st.integers(-9, 9), "Y": st.floats(width=32)}), max_size=2
                ),
            }
        ),
        max_size=4,
    ),
    offset=st.integers(0, PLAN.size - 1),
)
def test_rows_and_parts_of_tables_survive_conversion_to_yaml(
    used: dict[int, dict[str, object]], offset: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    file = file_of(PLAN, PLAN.pack(used)[offset:], offset)
    assert through_yaml(file, tmp_path_factory.mktemp("rows")).pack() == file.pack()


def test_header_fields_survive_conversion_to_yaml(tmp_path: Path) -> None:
    header = FileHeader("d", SUBTYPE_TBL_IMG, spacecraft_id=7, processor_id=8, application_id=9, time_seconds=10)
    header = dataclasses.replace(header, time_subseconds=0xFFFFFFFF)
    file = TableContents(header, TableHeader("APP.Plan", 4, 8, 0x1234), b"abcd", b"behind", PLAN)
    assert through_yaml(file, tmp_path) == file


def test_empty_rows_are_omitted_and_the_next_row_has_its_number() -> None:
    values = document(file_of(PLAN, PLAN.pack({1: {"MsgId": 1}, 2: {"MsgId": 2}, 6: {"Bytes": [0, 5]}})))
    assert [row.get("row") for row in values["rows"]] == [1, None, 6]
    assert values["rows"][2]["Bytes"] == [0, 5]
    assert values["rows"][0]["Points"] == []


def test_field_named_row_is_a_field(tmp_path: Path) -> None:
    file = file_of(LINES, LINES.pack([{"row": 9}, {}, {"row": 1, "Value": 2}]))
    assert document(file)["rows"] == [{"row": 9, "Value": 0}, {}, {"row": 1, "Value": 2}]
    assert through_yaml(file, tmp_path).pack() == file.pack()


def test_bytes_between_fields_are_kept_as_data() -> None:
    image = bytearray(LINES.size)
    image[1] = 0xFF  # C's padding
    assert document(file_of(LINES, bytes(image)))["data"].startswith("00ff")


def test_message_ids_are_in_hexadecimal() -> None:
    text = table_yaml.write(document(file_of(PLAN, PLAN.pack([{"MsgId": 0x1882}]))))
    assert "- {MsgId: 0x1882, Name: '', Flag: false, Points: [], Bytes: []}" in text


def test_mark_of_a_changed_file_is_renewed(tmp_path: Path) -> None:
    file = file_of(PLAN, PLAN.pack([{"MsgId": 1}])).marked()
    assert document(file)["mark"] is True
    path = tmp_path / "table.yaml"
    path.write_text(table_yaml.write(document(file)).replace("MsgId: 0x0001", "MsgId: 0x0002"), encoding="utf-8")
    changed = table_yaml.read(path, find)
    assert changed.is_marked
    assert changed.table.reserved != file.table.reserved


def test_layout_may_be_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "own.yaml"
    path.write_text(
        """
        table: MINE.Gains   # a comment
        layout:
          Id: u8
          Gains: f32[2]
          Limits: {Low: i16, High: i16}
          Steps: [{At: u8, Go: u16}, 3]
        count: 2
        rows:
        - {Id: 1, Gains: [0.5], Limits: {Low: -1}, Steps: [{At: 1, Go: 2}]}
    """,
        encoding="utf-8",
    )
    file = table_yaml.read(path, find)
    step = Layout("Step", [("At", "u8"), ("Go", "u16")])
    limits = Layout("Limits", [("Low", "i16"), ("High", "i16")])
    row = Layout("Row", [("Id", "u8"), ("Gains", "f32[2]"), ("Limits", limits), ("Steps", (step, 3))])
    first = row.pack(Id=1, Gains=[0.5], Limits={"Low": -1}, Steps=[{"At": 1, "Go": 2}])
    assert file.image == first + bytes(row.size)
    assert (file.header.spacecraft_id, file.header.processor_id) == (66, 1)


def test_all_mistakes_of_a_table_are_raised_together(tmp_path: Path) -> None:
    path = tmp_path / "bad.yaml"
    text = """\
table: APP.Plan
spacecraft_id: -1
markk: true
mark: 3
rows:
- {MsgId: 70000, Bit: 3}
- {row: x, MsgId: 1}
- {row: 0}
- {MsgId: {}}
"""
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        table_yaml.read(path, find)
    fields = "spacecraft_id markk mark rows[0].MsgId rows[0].Bit rows[1].row rows[2].row rows[3].MsgId"
    assert [error.field for error in caught.value.each] == fields.split()


def test_all_wrong_types_of_a_layout_are_raised_together(tmp_path: Path) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text("table: X.Y\nlayout: {A: u24, B: flaot, C: u8, D: [{E: i3}, 2]}\nrows: []", encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        table_yaml.read(path, find)
    assert [error.field for error in caught.value.each] == ["layout.A", "layout.B", "layout.D[0].E"]


def test_misspelt_keys_of_a_table_are_not_missing_too(tmp_path: Path) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text("tabel: APP.Plan\nrow: []", encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        table_yaml.read(path, find)
    assert [error.text for error in caught.value.each] == [
        "unknown field; did you mean table?",
        "unknown field; did you mean rows?",
    ]


@pytest.mark.parametrize(
    ("text", "line", "field", "words"),
    [
        ("description: x", 1, None, "missing table"),
        ("table: Plan", 1, "table", "must be APP.Table"),
        ("table: APP.Unknown\nrows: []", 1, "table", "--mission"),
        ("table: APP.Plan\nrow: []", 2, "row", "unknown field"),
        ("table: APP.Plan\nspacecraft_id: -1", 2, "spacecraft_id", "whole number"),
        ("table: APP.Plan\ndescription: " + "x" * 32, 2, "description", "31 characters"),
        ("table: APP.Plan\nrows:\n- {MsgId: 1}\n- MsgId: 2\n  Bits: 3", 5, "rows[1].Bits", "unknown field"),
        ("table: APP.Plan\nrows:\n- MsgId: 70000", 3, "rows[0].MsgId", "does not fit u16"),
        ("table: APP.Plan\nrows:\n- Points:\n  - {X: 1}\n  - {X: high}", 5, "rows[0].Points[1].X", "must be a number"),
        ("table: APP.Plan\nrows:\n- {row: 3}\n- {row: 2}", 4, "rows[1].row", "sort the rows"),
        ("table: APP.Plan\nrows:\n- {row: 8}", 3, "rows[0]", "APP.Plan has 8"),
        ("table: APP.Plan\nbytes: 500", 2, "bytes", "past the end"),
        ("table: APP.Plan\ndata: 0g", 2, "data", "hexadecimal"),
        ("table: APP.Plan\nrows: []\ndata: '00'", 3, "data", "combined with `rows`"),
        ("table: APP.Plan\nmark: 1", 2, "mark", "true or false"),
        ("table: APP.Plan\ncount: 2", 2, "count", "requires a `layout`"),
        ("table: X.Y\nlayout: {}", 2, "layout", "no fields"),
        ("table: X.Y\nlayout:\n  A: u8\n  B: u24", 4, "layout.B", "invalid type"),
        ("table: X.Y\nlayout: {A: [{B: u8}]}", 2, "layout.A", "a list of two items"),
        ("table: APP.Plan\noffset: 500", 1, "table", "has no data"),
    ],
)
def test_errors_have_their_line_and_field(text: str, line: int, field: str | None, words: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match=words) as caught:
        table_yaml.read(path, find)
    assert (caught.value.line, caught.value.field) == (line, field)
