"""File and table headers against files that NASA's cFE wrote and its table tool made."""

from __future__ import annotations

import pytest

from cfepy import fs, status
from cfepy.fs import FileHeader, TableHeader
from cfepy.reading.texts import to_bytes
from cfepy.status import CfeError, UsageError
from tests.layouts import DATA, c_structs


def test_header_sizes_match_c() -> None:
    assert c_structs()["CFE_FS_Header_t"].size == fs.HEADER_SIZE
    assert c_structs()["CFE_TBL_File_Hdr_t"].size == fs.TABLE_HEADER_SIZE
    offsets = {field.name: field.offset for field in c_structs()["CFE_FS_Header_t"].fields}
    assert offsets["TimeSeconds"] == fs.TIMESTAMP_OFFSET


def test_a_real_log_header() -> None:
    data = (DATA / "cfe_evs.log").read_bytes()
    header = fs.read_header(data)
    assert (header.description, header.subtype) == ("cFE EVS Log File", 16)
    assert (header.spacecraft_id, header.processor_id, header.application_id) == (66, 1, 0x110001)
    assert header.pack() == data[: fs.HEADER_SIZE]


@pytest.mark.parametrize(
    ("file", "table", "size"),
    [
        ("hk_cpy_tbl.tbl", "HK.CopyTable", 2048),
        ("sample_app_tbl.tbl", "SAMPLE_APP.ExampleTable", 4),
        ("sch_lab_table.tbl", "SCH_LAB.ScheduleTable", 2436),
    ],
)
def test_real_table_files(file: str, table: str, size: int) -> None:
    data = (DATA / file).read_bytes()
    header, table_header, image = fs.read_table_file(data)
    assert table_header.table_name == table
    assert table_header.num_bytes == len(image) == size
    assert fs.write_table_file(header, table, image) == data


def test_init_and_stamp() -> None:
    blank = fs.init_header("x" * 40, 16)
    assert blank == FileHeader("x" * 31, 16, content_type=0, length=0)
    stamped = fs.stamp_header(blank, spacecraft_id=66, processor_id=1, application_id=5, time=(7, 8))
    assert stamped == FileHeader("x" * 31, 16, fs.CONTENT_ID, 64, 66, 1, 5, 7, 8)
    assert fs.read_header(stamped.pack()) == stamped


def test_short_and_wrong_files() -> None:
    good = fs.write_table_file(FileHeader("d"), "APP.T", b"1234")
    wrong = {
        b"": status.CFE_TBL_ERR_NO_STD_HEADER,
        good[:63]: status.CFE_TBL_ERR_NO_STD_HEADER,
        b"XXXX" + good[4:]: status.CFE_TBL_ERR_BAD_CONTENT_ID,
        good[:7] + b"\x09" + good[8:]: status.CFE_TBL_ERR_BAD_SUBTYPE_ID,
        good[:100]: status.CFE_TBL_ERR_NO_TBL_HEADER,
        good[:-1]: status.CFE_TBL_ERR_LOAD_INCOMPLETE,
    }
    for data, expected in wrong.items():
        with pytest.raises(CfeError) as caught:
            fs.read_table_file(data)
        assert caught.value.status == expected
    with pytest.raises(CfeError, match="CFE_STATUS_EXTERNAL_RESOURCE_FAIL"):
        fs.read_header(good[:63])


def test_numbers_beyond_32_bits_are_refused() -> None:
    with pytest.raises(UsageError, match="32 bits"):
        FileHeader("d", subtype=1 << 32).pack()
    with pytest.raises(UsageError, match="32 bits"):
        TableHeader("t", -1).pack()


def test_table_name_that_fills_its_field_loses_its_last_character() -> None:
    """NASA's puts a NUL there before it looks the name up (CFE_TBL_DecodeInputData)."""
    header = bytes(12) + b"T" * 40
    assert fs.read_table_header(header, 0).table_name == "T" * 39


def test_header_bytes_that_are_not_utf8_are_kept() -> None:
    header = bytes(12) + b"A.\xff\xe9".ljust(40, b"\0")
    assert to_bytes(fs.read_table_header(header, 0).table_name) == b"A.\xff\xe9"
