"""File names by kind, and files that the background task writes (fs_util_test.c)."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cfepy.app import Cfe
from cfepy.fs.background import FileWriteMetaData
from cfepy.fs.filename import MAX_PATH_LEN, FileCategory
from cfepy.status import (
    CFE_FS_BAD_ARGUMENT,
    CFE_FS_FNAME_TOO_LONG,
    CFE_FS_INVALID_PATH,
    CFE_STATUS_REQUEST_ALREADY_PENDING,
    CFE_SUCCESS,
)
from tests.functional.harness import status_of

PARTS = ("FileName", "/func", ".test")


@pytest.mark.parametrize(
    ("category", "mount_point", "extension"),
    [
        (FileCategory.UNKNOWN, None, None),
        (FileCategory.DYNAMIC_MODULE, "/cf", ".so"),
        (FileCategory.BINARY_DATA_DUMP, "/ram", None),
        (FileCategory.TEXT_LOG, "/ram", ".log"),
        (FileCategory.SCRIPT, "/cf", ".scr"),
        (FileCategory.TEMP, "/ram", ".tmp"),
        (FileCategory.TEMP + 1, None, None),
    ],
)
def test_file_category(cfe: Cfe, category: int, mount_point: str | None, extension: str | None) -> None:
    assert cfe.fs.get_default_mount_point(category) == mount_point
    assert cfe.fs.get_default_extension(category) == extension


def test_input_file(cfe: Cfe) -> None:
    parse, complete = cfe.fs.parse_input_file_name, cfe.fs.parse_input_file_name_ex
    assert parse("FileName", FileCategory.SCRIPT) == "/cf/FileName.scr"
    assert status_of(parse, "", FileCategory.SCRIPT) == CFE_FS_INVALID_PATH
    assert status_of(parse, "FileName", FileCategory.SCRIPT, 0) == CFE_FS_BAD_ARGUMENT
    assert complete("BufferName", *PARTS) == "/func/BufferName.test"
    assert complete("", *PARTS) == "/func/FileName.test"
    assert complete("BufferName", None, *PARTS[1:]) == "/func/BufferName.test"
    assert status_of(complete, "", None, *PARTS[1:]) == CFE_FS_INVALID_PATH
    assert status_of(complete, "BufferName", *PARTS, 0) == CFE_FS_BAD_ARGUMENT
    assert status_of(complete, "BufferName", *PARTS, 8) == CFE_FS_FNAME_TOO_LONG


def test_file_name(cfe: Cfe) -> None:
    extract = cfe.fs.extract_filename_from_path
    assert extract("/func/FileName.test") == "FileName.test"
    assert status_of(extract, "/" + "x" * (MAX_PATH_LEN + 2)) == CFE_FS_FNAME_TOO_LONG
    assert status_of(extract, "x" * (MAX_PATH_LEN - 1)) == CFE_FS_INVALID_PATH


def test_file_dump(cfe: Cfe) -> None:
    ends: list[object] = []
    request, is_pending = cfe.fs.background_file_dump_request, cfe.fs.background_file_dump_is_pending

    def on_event(*event: int) -> None:
        ends.append(event)
        cfe.os.task_delay(100)

    meta = FileWriteMetaData("/ram/FT.bin", 2, "FT", lambda record: (b"", True), on_event)
    assert is_pending(meta) is False
    assert status_of(request, replace(meta, file_name="")) == CFE_FS_INVALID_PATH
    assert status_of(request, replace(meta, get_data=None)) == CFE_FS_BAD_ARGUMENT
    assert status_of(request, replace(meta, on_event=None)) == CFE_FS_BAD_ARGUMENT
    assert status_of(request, meta) == CFE_SUCCESS
    assert is_pending(meta) is True
    assert status_of(request, meta) == CFE_STATUS_REQUEST_ALREADY_PENDING
    cfe.os.task_delay(2000)
    assert is_pending(meta) is False
    assert len(ends) == 1
    file = cfe.os.open_create(meta.file_name)
    assert cfe.fs.read_header(file).description == "FT"
