"""The headers at the front of cFE's files: the 64-byte cFE file header and the 52-byte table header after it.

Both are big-endian on every processor (CFE_FS_Header_t, CFE_TBL_File_Hdr_t). The functions work on bytes; the caller
opens the files.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, replace

from cfepy.reading.texts import from_bytes, to_bytes
from cfepy.status import (
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CFE_TBL_ERR_BAD_CONTENT_ID,
    CFE_TBL_ERR_BAD_SUBTYPE_ID,
    CFE_TBL_ERR_LOAD_INCOMPLETE,
    CFE_TBL_ERR_NO_STD_HEADER,
    CFE_TBL_ERR_NO_TBL_HEADER,
    CfeError,
    UsageError,
)

CONTENT_ID = 0x63464531
"""The bytes "cFE1" (CFE_FS_FILE_CONTENT_ID)."""

HEADER_SIZE = 64
TABLE_HEADER_SIZE = 52
DESCRIPTION_SIZE = 32
TABLE_NAME_SIZE = 40
TIMESTAMP_OFFSET = 24

SUBTYPE_ES_ERLOG = 1
SUBTYPE_ES_SYSLOG = 2
SUBTYPE_ES_QUERYALL = 3
SUBTYPE_ES_PERFDATA = 4
SUBTYPE_ES_CDS_REG = 6
SUBTYPE_TBL_REG = 9
SUBTYPE_TBL_IMG = 8
SUBTYPE_EVS_APPDATA = 15
SUBTYPE_EVS_EVENTLOG = 16
SUBTYPE_SB_PIPEDATA = 20
SUBTYPE_SB_ROUTEDATA = 21
SUBTYPE_SB_MAPDATA = 22
SUBTYPE_ES_QUERYALLTASKS = 23

_FILE = struct.Struct(">8I32s")
_TABLE = struct.Struct(">3I40s")


def _text(data: bytes) -> str:
    return from_bytes(data)


def _fixed(text: str, size: int) -> bytes:
    """Return the bytes of a text for a field of `size` bytes; the last byte stays NUL, as after strncpy(size - 1)."""
    return to_bytes(text)[: size - 1]


@dataclass(frozen=True, slots=True)
class FileHeader:
    """CFE_FS_Header_t; times are seconds and 2**-32 s, ids are as in the file."""

    description: str = ""
    subtype: int = 0
    content_type: int = CONTENT_ID
    length: int = HEADER_SIZE
    spacecraft_id: int = 0
    processor_id: int = 0
    application_id: int = 0
    time_seconds: int = 0
    time_subseconds: int = 0

    def pack(self) -> bytes:
        """Return the 64 bytes.

        Raises:
            UsageError: if a number does not fit 32 bits.
        """
        numbers = (
            self.content_type,
            self.subtype,
            self.length,
            self.spacecraft_id,
            self.processor_id,
            self.application_id,
            self.time_seconds,
            self.time_subseconds,
        )
        try:
            return _FILE.pack(*numbers, _fixed(self.description, DESCRIPTION_SIZE))
        except struct.error:
            raise UsageError(f"the numbers of the file header must fit 32 bits: {self}") from None


@dataclass(frozen=True, slots=True)
class TableHeader:
    """CFE_TBL_File_Hdr_t: the table, the offset of the first byte, and the number of bytes that follow."""

    table_name: str
    num_bytes: int
    offset: int = 0
    reserved: int = 0

    def pack(self) -> bytes:
        """Return the 52 bytes.

        Raises:
            UsageError: if a number does not fit 32 bits.
        """
        try:
            return _TABLE.pack(self.reserved, self.offset, self.num_bytes, _fixed(self.table_name, TABLE_NAME_SIZE))
        except struct.error:
            raise UsageError(f"the numbers of the table header must fit 32 bits: {self}") from None


def init_header(description: str, subtype: int) -> FileHeader:
    """Return a header with all other fields zero, as after CFE_FS_InitHeader; `stamp_header` fills them in before
    writing.
    """
    return FileHeader(_text(_fixed(description, DESCRIPTION_SIZE)), subtype, content_type=0, length=0)


def stamp_header(
    header: FileHeader, *, spacecraft_id: int, processor_id: int, application_id: int, time: tuple[int, int]
) -> FileHeader:
    """Return the header as CFE_FS_WriteHeader writes it: with content type, length, ids and time.

    Args:
        header: provides description and subtype.
        spacecraft_id: the PSP's spacecraft id.
        processor_id: the PSP's processor id.
        application_id: AppId of the writer.
        time: spacecraft time, (seconds, subseconds).
    """
    return replace(
        header,
        content_type=CONTENT_ID,
        length=HEADER_SIZE,
        spacecraft_id=spacecraft_id,
        processor_id=processor_id,
        application_id=application_id,
        time_seconds=time[0],
        time_subseconds=time[1],
    )


def read_header(data: bytes) -> FileHeader:
    """Return the cFE header that data starts with; its content type is not checked (CFE_FS_ReadHeader).

    Raises:
        CfeError: CFE_STATUS_EXTERNAL_RESOURCE_FAIL if there are not 64 bytes.
    """
    if len(data) < HEADER_SIZE:
        text = f"a cFE file must have a header of {HEADER_SIZE} bytes; the file has {len(data)} bytes"
        raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, text)
    content, subtype, length, scid, cpu, app, seconds, subseconds, description = _FILE.unpack_from(data)
    return FileHeader(_text(description), subtype, content, length, scid, cpu, app, seconds, subseconds)


def read_table_header(data: bytes, at: int = HEADER_SIZE) -> TableHeader:
    """Return the table header at an offset of a table file. A name that fills its field loses its last character.

    Raises:
        CfeError: CFE_TBL_ERR_NO_TBL_HEADER if the file ends before it.
    """
    if len(data) < at + TABLE_HEADER_SIZE:
        text = f"the file ends within the table header, {TABLE_HEADER_SIZE} bytes after the {at} of the file header"
        raise CfeError(CFE_TBL_ERR_NO_TBL_HEADER, text)
    reserved, offset, num_bytes, name = _TABLE.unpack_from(data, at)
    return TableHeader(_text(name[:-1]), num_bytes, offset, reserved)


def read_table_file(data: bytes) -> tuple[FileHeader, TableHeader, bytes]:
    """Return both headers and the image of a table file, after the checks that cFE makes before a load.

    Raises:
        CfeError: CFE_TBL_ERR_NO_STD_HEADER, _BAD_CONTENT_ID, _BAD_SUBTYPE_ID, _NO_TBL_HEADER, or _LOAD_INCOMPLETE if
            the image is shorter than its header says.
    """
    if len(data) < HEADER_SIZE:
        text = f"a table file must have a header of {HEADER_SIZE} bytes; this file has {len(data)} bytes"
        raise CfeError(CFE_TBL_ERR_NO_STD_HEADER, text)
    header = read_header(data)
    if header.content_type != CONTENT_ID:
        text = f'the content type of a cFE file must be 0x{CONTENT_ID:08X} ("cFE1"), not 0x{header.content_type:08X}'
        raise CfeError(CFE_TBL_ERR_BAD_CONTENT_ID, text)
    if header.subtype != SUBTYPE_TBL_IMG:
        text = f"the subtype of a table file must be {SUBTYPE_TBL_IMG}, not {header.subtype}"
        raise CfeError(CFE_TBL_ERR_BAD_SUBTYPE_ID, text)
    table = read_table_header(data)
    image = bytes(data[HEADER_SIZE + TABLE_HEADER_SIZE :])
    if len(image) < table.num_bytes:
        text = f"the header of {table.table_name!r} specifies {table.num_bytes} bytes, but the file has {len(image)}"
        raise CfeError(CFE_TBL_ERR_LOAD_INCOMPLETE, text)
    return header, table, image


def write_table_file(header: FileHeader, table_name: str, image: bytes, offset: int = 0) -> bytes:
    """Return a whole table file.

    Args:
        header: its subtype is set to that of a table image.
        table_name: full name, "APP.Table".
        image: the table's bytes, native byte order.
        offset: offset of these bytes in the table.
    """
    table = TableHeader(table_name, len(image), offset)
    return replace(header, subtype=SUBTYPE_TBL_IMG).pack() + table.pack() + image
