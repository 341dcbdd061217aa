"""Table files made from Python values."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.fs import crc16
from cfepy.msg import Layout
from cfepy.status import UsageError
from cfepy.tbl import TableImage, build, is_intact, mark_in, pack_rows, read, unpack_rows, with_mark, write_beside
from cfepy.tbl.image import MARK_TAG
from tests.layouts import DATA

ROW = Layout("Row", [("A", "u8"), ("B", "u32")])


def test_rows_are_filled_up_with_zeros() -> None:
    data = pack_rows(ROW, [{"A": 1, "B": 2}], capacity=3)
    assert len(data) == 3 * ROW.size
    assert unpack_rows(ROW, data) == [{"A": 1, "B": 2}, {"A": 0, "B": 0}, {"A": 0, "B": 0}]


def test_faults_of_rows_name_row_and_field() -> None:
    with pytest.raises(UsageError, match="must have at most 1"):
        pack_rows(ROW, [{}, {}], capacity=1)
    with pytest.raises(UsageError) as caught:
        pack_rows(ROW, [{}, {"A": 256}], capacity=2)
    assert caught.value.field == "rows[1].A"


@pytest.mark.parametrize("name", ["", "Table", "APP." + "x" * 36])
def test_invalid_table_names_are_refused(name: str) -> None:
    with pytest.raises(UsageError) as caught:
        build(TableImage(name, b"1"))
    assert caught.value.field == "name"


def test_image_without_data() -> None:
    with pytest.raises(UsageError):
        build(TableImage("APP.T", b""))


def test_table_file_is_written_next_to_its_definition(tmp_path: Path) -> None:
    image = TableImage("APP.T", b"1234", "a table")
    path = write_beside(str(tmp_path / "t.py"), image)
    assert path == tmp_path / "t.tbl"
    assert read(path.read_bytes()) == image


@pytest.mark.parametrize("name", ["hk_cpy_tbl", "sample_app_tbl", "sch_lab_table", "to_lab_sub"])
def test_files_equal_files_of_elf2cfetbl(name: str) -> None:
    data = (DATA / f"{name}.tbl").read_bytes()
    assert build(read(data)) == data


def test_mark_changes_only_the_reserved_word() -> None:
    plain = build(TableImage("APP.T", b"1234", "a table"))
    marked = with_mark(plain)
    assert (mark_in(plain), mark_in(marked)) == (0, MARK_TAG | crc16(plain))
    assert marked[:64] + bytes(4) + marked[68:] == plain
    assert read(marked) == read(plain)
    assert with_mark(marked) == marked


def test_intact_files_are_distinguished_from_damaged_ones() -> None:
    marked = with_mark(build(TableImage("APP.T", b"1234")))
    assert is_intact(build(TableImage("APP.T", b"1234")))
    assert is_intact(marked)
    assert not is_intact(marked[:-1] + b"5")
    assert not is_intact(marked + b"5")
    with pytest.raises(UsageError):
        with_mark(b"no table file")


def test_files_of_elf2cfetbl_have_no_mark() -> None:
    assert mark_in((DATA / "sample_app_tbl.tbl").read_bytes()) == 0
