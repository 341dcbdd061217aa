"""NASA's requirements for File Services (cES1600-1606)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.app import Cfe
from cfepy.fs import FileCategory, read_header
from cfepy.fs.background import FileWriteEvent, FileWriteMetaData
from cfepy.fs.header import CONTENT_ID
from cfepy.osal.limits import OS_FILE_FLAG_CREATE, OS_READ_ONLY, OS_READ_WRITE
from cfepy.status import (
    CFE_FS_INVALID_PATH,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CFE_STATUS_REQUEST_ALREADY_PENDING,
)
from tests.es.harness import Lab
from tests.statuses import status_of

Question = Callable[[Cfe], Any]
PATH = "/ram/file.dat"


@pytest.fixture
def ask(tmp_path: Path) -> Iterator[Callable[..., Any]]:
    """Asks a question in the name of an application."""
    labs: list[Lab] = []

    def ask(question: Question, seconds: float = 1) -> Any:
        found: list[Any] = []
        lab = Lab(tmp_path, one=lambda cfe: found.append(question(cfe)))
        labs.append(lab)
        lab.start("one")
        lab.mission.run_for(seconds)
        assert found, "the application died"
        return found[0]

    yield ask
    for lab in labs:
        lab.mission.close()


def open_new(cfe: Cfe, mode: int = OS_READ_WRITE) -> int:
    return cfe.os.open_create(PATH, OS_FILE_FLAG_CREATE, mode)


def test_cES1600_the_header_of_a_file_is_read(ask: Callable[..., Any]) -> None:
    def question(cfe: Cfe) -> Any:
        filedes = open_new(cfe)
        assert status_of(cfe.fs.read_header, filedes) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL  # empty
        cfe.fs.write_header(filedes, cfe.fs.init_header("my file", 77))
        cfe.os.write(filedes, b"data")
        header = cfe.fs.read_header(filedes)
        assert cfe.os.read(filedes, 9) == b"data"
        assert status_of(cfe.fs.read_header, 0) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL
        return header, cfe.es.get_app_id()

    header, app_id = ask(question)
    assert (header.content_type, header.subtype, header.length) == (CONTENT_ID, 77, 64)
    assert (header.spacecraft_id, header.processor_id, header.application_id) == (66, 1, app_id)
    assert (header.description, header.time_seconds) == ("my file", 1001001)


def test_cES1601_a_header_is_prepared(ask: Callable[..., Any]) -> None:
    header = ask(lambda cfe: cfe.fs.init_header("a description that is longer than its field", 3))
    assert (header.description, header.subtype) == ("a description that is longer th", 3)
    assert (header.content_type, header.length, header.application_id, header.time_seconds) == (0, 0, 0, 0)


def test_cES1602_a_header_is_written_at_the_start_of_a_file(ask: Callable[..., Any]) -> None:
    def question(cfe: Cfe) -> bytes:
        filedes = open_new(cfe)
        cfe.os.write(filedes, b"x" * 100)
        assert cfe.fs.write_header(filedes, cfe.fs.init_header("my description", 0x01020304)) == 64
        cfe.os.close(filedes)
        filedes = cfe.os.open_create(PATH, 0, OS_READ_ONLY)
        assert status_of(cfe.fs.write_header, filedes, cfe.fs.init_header("h", 1)) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL
        return cfe.os.files.read_file(PATH)

    data = ask(question)
    header = read_header(data)
    assert data[:4] == b"cFE1"
    assert (header.description, header.subtype, header.length) == ("my description", 0x01020304, 64)
    assert (header.spacecraft_id, header.processor_id, header.application_id >> 16) == (66, 1, 0x11)
    assert header.time_seconds == 1001001
    assert data[64:] == b"x" * 36


def test_cES1603_the_time_of_a_file_is_set(ask: Callable[..., Any]) -> None:
    def question(cfe: Cfe) -> Any:
        filedes = open_new(cfe)
        cfe.fs.write_header(filedes, cfe.fs.init_header("h", 1))
        cfe.fs.set_timestamp(filedes, (0x01020304, 0x05060708))
        header = cfe.fs.read_header(filedes)
        assert status_of(cfe.fs.set_timestamp, 0, (1, 2)) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL
        return header, cfe.es.syslog.read()

    header, log = ask(question)
    assert (header.time_seconds, header.time_subseconds) == (0x01020304, 0x05060708)
    assert header.description == "h"
    assert b"CFE_FS_SetTimestamp: Failed to lseek time fields (Status=-16)\n" in log


def test_cES1604_the_name_of_a_file_is_extracted_from_its_path(ask: Callable[..., Any]) -> None:
    def question(cfe: Cfe) -> str:
        assert status_of(cfe.fs.extract_filename_from_path, "name") == CFE_FS_INVALID_PATH
        return cfe.fs.extract_filename_from_path("/cf/apps/hk.so")

    assert ask(question) == "hk.so"


def test_cES1605_names_of_files_are_completed(ask: Callable[..., Any]) -> None:
    def question(cfe: Cfe) -> list[str | None]:
        fs = cfe.fs
        return [
            fs.parse_input_file_name("hk", FileCategory.DYNAMIC_MODULE),
            fs.parse_input_file_name("dump", FileCategory.TEXT_LOG),
            fs.parse_input_file_name_ex("", "default.dat", "/ram"),
            fs.get_default_mount_point(FileCategory.SCRIPT),
            fs.get_default_extension(FileCategory.SCRIPT),
        ]

    assert ask(question) == ["/cf/hk.so", "/ram/dump.log", "/ram/default.dat", "/cf", ".scr"]


def test_cES1606_files_are_written_in_the_background(ask: Callable[..., Any]) -> None:
    """It writes 10000 bytes per second: a file of 20064 bytes takes more than a second, while the application
    continues."""
    events: list[tuple[int, ...]] = []

    def question(cfe: Cfe) -> Any:
        meta = FileWriteMetaData(
            PATH, 99, "in parts", lambda number: (bytes([number]) * 1000, number == 19), lambda *got: events.append(got)
        )
        cfe.fs.background_file_dump_request(meta)
        assert cfe.fs.background_file_dump_is_pending(meta)
        assert status_of(cfe.fs.background_file_dump_request, meta) == CFE_STATUS_REQUEST_ALREADY_PENDING
        cfe.os.task_delay(1500)
        sizes = [len(cfe.os.files.read_file(PATH))]
        cfe.os.task_delay(3000)
        sizes.append(len(cfe.os.files.read_file(PATH)))
        assert not cfe.fs.background_file_dump_is_pending(meta)
        assert status_of(cfe.fs.background_file_dump_request, _nameless()) == CFE_FS_INVALID_PATH
        return sizes, cfe.os.files.read_file(PATH)

    sizes, data = ask(question, 6)
    assert 64 < sizes[0] < sizes[1] == 20064
    assert data[64:] == b"".join(bytes([number]) * 1000 for number in range(20))
    assert events == [(FileWriteEvent.COMPLETE, 0, 20, 0, 20064)]


def _nameless() -> FileWriteMetaData:
    return FileWriteMetaData("", 99, "x", lambda number: (b"", True), print)


def test_cES1606_three_files_may_wait_and_errors_are_reported(ask: Callable[..., Any]) -> None:
    events: list[tuple[int, ...]] = []

    def meta(path: str, size: int = 10) -> FileWriteMetaData:
        return FileWriteMetaData(path, 99, "x", lambda number: (bytes(size), True), lambda *got: events.append(got))

    def question(cfe: Cfe) -> None:
        for path, size in (("/nowhere/a", 10), ("/ram/b", 3_000_000), ("/ram/c", 10)):
            cfe.fs.background_file_dump_request(meta(path, size))
        assert status_of(cfe.fs.background_file_dump_request, meta("/ram/d")) == CFE_STATUS_REQUEST_ALREADY_PENDING
        cfe.os.task_delay(5000)

    ask(question, 6)
    assert events == [
        (FileWriteEvent.CREATE_ERROR, -108, 0, 0, 0),
        (FileWriteEvent.RECORD_WRITE_ERROR, 4096 * 512 - 64, 0, 3_000_000, 64),
        (FileWriteEvent.HEADER_WRITE_ERROR, CFE_STATUS_EXTERNAL_RESOURCE_FAIL, 0, 64, 0),  # the disk is full now
    ]


def test_cES1606_a_disk_without_room_for_a_header_is_reported(ask: Callable[..., Any]) -> None:
    events: list[tuple[int, ...]] = []

    def question(cfe: Cfe) -> None:
        cfe.os.files.write_file("/ram/big", bytes(4096 * 512 - 30))
        meta = FileWriteMetaData(PATH, 99, "x", lambda number: (b"", True), lambda *got: events.append(got))
        cfe.fs.background_file_dump_request(meta)
        cfe.os.task_delay(2000)

    ask(question, 4)
    assert events == [(FileWriteEvent.HEADER_WRITE_ERROR, 30, 0, 64, 0)]
