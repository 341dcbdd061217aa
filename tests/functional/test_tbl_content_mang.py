"""Loading tables from files and memory, and an owner's actions on its table (tbl_content_mang_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.fs.header import HEADER_SIZE, TABLE_HEADER_SIZE
from cfepy.mission import Mission
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_ERR_ACCESS,
    CFE_TBL_ERR_BAD_CONTENT_ID,
    CFE_TBL_ERR_BAD_SUBTYPE_ID,
    CFE_TBL_ERR_DUMP_ONLY,
    CFE_TBL_ERR_FILE_FOR_WRONG_TABLE,
    CFE_TBL_ERR_FILE_TOO_LARGE,
    CFE_TBL_ERR_ILLEGAL_SRC_TYPE,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_ERR_LOAD_INCOMPLETE,
    CFE_TBL_ERR_NO_STD_HEADER,
    CFE_TBL_ERR_NO_TBL_HEADER,
    CFE_TBL_ERR_PARTIAL_LOAD,
    CFE_TBL_INFO_NO_DUMP_PENDING,
    CFE_TBL_INFO_NO_UPDATE_PENDING,
    CFE_TBL_INFO_NO_VALIDATION_PENDING,
    CFE_TBL_WARN_PARTIAL_LOAD,
    CFE_TBL_WARN_SHORT_FILE,
)
from cfepy.tbl import OPT_DBL_BUFFER, OPT_DUMP_ONLY, TableImage, build
from tests.functional.harness import APP, answer_of, status_of
from tests.functional.tables import BAD_HANDLE, FILE, FULL_NAME, IN_FILE, NUMBERS, content, register

OTHER = "OtherTbl"
HEADERS = FILE[: HEADER_SIZE + TABLE_HEADER_SIZE]
WRONG = b"\x09\xab\xcd\xef"
ALTERNATE = (0xDEAD, 0xBEEF)
FILES = {
    "nominal": FILE,
    "no_header": b"\x12\x34\x56\x78",
    "no_table_header": FILE[:HEADER_SIZE] + b"\x12\x34\x56\x78",
    "content_id": WRONG + FILE[4:],
    "subtype": FILE[:4] + WRONG + FILE[8:],
    "alternate": HEADERS + NUMBERS.pack(*ALTERNATE),
    "long": HEADERS + NUMBERS.pack(0x1111, 0x2222) + b"\x33",
    "truncated": HEADERS + b"\x44",
    "other": build(TableImage(f"{APP}.{OTHER}", NUMBERS.pack(0xB0A7, 0x10AD))),
    "short": build(TableImage(FULL_NAME, b"\x55\x55")),
    "partial": build(TableImage(FULL_NAME, b"\x66\x66", offset=2)),
}


def path(name: str) -> str:
    return f"/ram/{name}.tbl"


def test_table_load(cfe: Cfe, mission: Mission) -> None:
    for name, data in FILES.items():
        mission.files.write_file(path(name), data)
    handle = register(cfe)
    refuse_before_a_first_load(cfe, handle)
    load_one_file_after_the_other(cfe, handle)
    load_parts(cfe, handle)
    load_into_other_tables(cfe, handle)
    load_from_memory(cfe, handle)
    shared = cfe.tbl.share(FULL_NAME)
    assert cfe.tbl.load(shared, path("nominal")) == CFE_SUCCESS, "the owner has two handles"
    for each in (shared, handle):
        cfe.tbl.unregister(each)


def load(cfe: Cfe, handle: int, name: str) -> int:
    """Return the result of loading a file."""
    return answer_of(cfe.tbl.load, handle, path(name))


def refuse_before_a_first_load(cfe: Cfe, handle: int) -> None:
    assert load(cfe, handle, "no_header") == CFE_TBL_ERR_NO_STD_HEADER
    assert load(cfe, handle, "no_table_header") == CFE_TBL_ERR_NO_TBL_HEADER
    assert load(cfe, handle, "content_id") == CFE_TBL_ERR_BAD_CONTENT_ID
    assert load(cfe, handle, "subtype") == CFE_TBL_ERR_BAD_SUBTYPE_ID
    assert answer_of(cfe.tbl.load, handle, 5) == CFE_TBL_ERR_ILLEGAL_SRC_TYPE
    assert load(cfe, handle, "partial") == CFE_TBL_ERR_PARTIAL_LOAD
    assert load(cfe, handle, "short") == CFE_TBL_WARN_SHORT_FILE


def load_one_file_after_the_other(cfe: Cfe, handle: int) -> None:
    assert load(cfe, handle, "nominal") == CFE_SUCCESS
    assert content(cfe, handle) == (IN_FILE, True)
    assert load(cfe, handle, "long") == CFE_TBL_ERR_FILE_TOO_LARGE
    assert content(cfe, handle) == (IN_FILE, False)
    assert load(cfe, handle, "alternate") == CFE_SUCCESS
    assert content(cfe, handle) == (ALTERNATE, True)
    assert load(cfe, handle, "truncated") == CFE_TBL_ERR_LOAD_INCOMPLETE
    assert content(cfe, handle) == (ALTERNATE, False)


def load_parts(cfe: Cfe, handle: int) -> None:
    assert load(cfe, handle, "short") == CFE_TBL_WARN_SHORT_FILE
    assert content(cfe, handle) == ((0x5555, ALTERNATE[1]), True)
    assert load(cfe, handle, "partial") == CFE_TBL_WARN_PARTIAL_LOAD
    assert content(cfe, handle) == ((0x5555, 0x6666), True)


def load_into_other_tables(cfe: Cfe, handle: int) -> None:
    other, double = register(cfe, OTHER), register(cfe, "BadTableName", OPT_DBL_BUFFER)
    assert load(cfe, other, "other") == CFE_SUCCESS
    assert content(cfe, other) == ((0xB0A7, 0x10AD), True)
    assert content(cfe, handle) == ((0x5555, 0x6666), False)
    assert load(cfe, double, "nominal") == CFE_TBL_ERR_FILE_FOR_WRONG_TABLE
    assert load(cfe, handle, "other") == CFE_TBL_ERR_FILE_FOR_WRONG_TABLE
    assert load(cfe, handle, "no such file") == CFE_TBL_ERR_ACCESS
    assert load(cfe, BAD_HANDLE, "nominal") == CFE_TBL_ERR_INVALID_HANDLE
    dumped = register(cfe, "DumpOnlyTable", OPT_DUMP_ONLY)
    assert load(cfe, dumped, "nominal") == CFE_TBL_ERR_DUMP_ONLY


def load_from_memory(cfe: Cfe, handle: int) -> None:
    image = NUMBERS.pack(0xD00D, 0xDAD)
    assert cfe.tbl.load(handle, image) == CFE_SUCCESS
    assert content(cfe, handle) == ((0xD00D, 0xDAD), True)
    assert status_of(cfe.tbl.load, BAD_HANDLE, image) == CFE_TBL_ERR_INVALID_HANDLE


def test_table_update(cfe: Cfe) -> None:
    assert cfe.tbl.update(register(cfe)) == CFE_TBL_INFO_NO_UPDATE_PENDING
    assert answer_of(cfe.tbl.update, BAD_HANDLE) == CFE_TBL_ERR_INVALID_HANDLE


def test_table_validate(cfe: Cfe) -> None:
    assert cfe.tbl.validate(register(cfe)) == CFE_TBL_INFO_NO_VALIDATION_PENDING
    assert answer_of(cfe.tbl.validate, BAD_HANDLE) == CFE_TBL_ERR_INVALID_HANDLE


def test_table_manage(cfe: Cfe) -> None:
    assert cfe.tbl.manage(register(cfe)) == CFE_SUCCESS
    assert answer_of(cfe.tbl.manage, BAD_HANDLE) == CFE_TBL_ERR_INVALID_HANDLE


def test_table_dump_to_buffer(cfe: Cfe) -> None:
    assert cfe.tbl.dump_to_buffer(register(cfe)) == CFE_TBL_INFO_NO_DUMP_PENDING
    assert answer_of(cfe.tbl.dump_to_buffer, BAD_HANDLE) == CFE_TBL_ERR_INVALID_HANDLE


def test_table_modified(cfe: Cfe) -> None:
    assert status_of(cfe.tbl.modified, register(cfe)) == CFE_SUCCESS
    assert status_of(cfe.tbl.modified, BAD_HANDLE) == CFE_TBL_ERR_INVALID_HANDLE
