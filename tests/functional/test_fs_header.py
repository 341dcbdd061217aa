"""Headers of files: writing, reading, and changing their time (fs_header_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.fs.header import CONTENT_ID, HEADER_SIZE, SUBTYPE_ES_ERLOG, TIMESTAMP_OFFSET
from cfepy.ids import UNDEFINED
from cfepy.osal.limits import OS_FILE_FLAG_CREATE, OS_READ_WRITE, OS_SEEK_CUR
from cfepy.status import CFE_STATUS_EXTERNAL_RESOURCE_FAIL
from tests.functional.harness import status_of

DESCRIPTION = "TEST_HEADER"


def open_file(cfe: Cfe) -> int:
    return cfe.os.open_create("/ram/header_test.txt", OS_FILE_FLAG_CREATE, OS_READ_WRITE)


def place_in(cfe: Cfe, file: int) -> int:
    return cfe.os.lseek(file, 0, OS_SEEK_CUR)


def test_create_header(cfe: Cfe) -> None:
    file, header = open_file(cfe), cfe.fs.init_header(DESCRIPTION, SUBTYPE_ES_ERLOG)
    assert cfe.fs.write_header(file, header) == HEADER_SIZE
    assert place_in(cfe, file) == HEADER_SIZE
    assert status_of(cfe.fs.write_header, UNDEFINED, header) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL
    assert cfe.fs.write_header(file, cfe.fs.init_header(DESCRIPTION, 256)) == HEADER_SIZE, "any subtype will do"


def test_read_header(cfe: Cfe) -> None:
    file = open_file(cfe)
    cfe.fs.write_header(file, cfe.fs.init_header(DESCRIPTION, SUBTYPE_ES_ERLOG))
    header = cfe.fs.read_header(file)
    assert place_in(cfe, file) == HEADER_SIZE
    assert (header.content_type, header.subtype) == (CONTENT_ID, SUBTYPE_ES_ERLOG)
    assert header.description == DESCRIPTION
    assert header.application_id == cfe.es.get_app_id()
    assert status_of(cfe.fs.read_header, UNDEFINED) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL


def test_time_stamp(cfe: Cfe) -> None:
    file, latest = open_file(cfe), (0xFFFFFFFF, 0xFFFFFFFF)
    cfe.fs.write_header(file, cfe.fs.init_header(DESCRIPTION, SUBTYPE_ES_ERLOG))
    cfe.fs.set_timestamp(file, latest)
    assert place_in(cfe, file) == TIMESTAMP_OFFSET + 8
    header = cfe.fs.read_header(file)
    assert (header.time_seconds, header.time_subseconds) == latest
    assert (header.subtype, header.description) == (SUBTYPE_ES_ERLOG, DESCRIPTION)
    assert status_of(cfe.fs.set_timestamp, UNDEFINED, latest) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL
