"""CFE_FS_*: File Services for C."""

from __future__ import annotations

import struct
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING

from cfepy.extra.c.api.pointers import need
from cfepy.extra.c.memory import CMemory
from cfepy.fs import DESCRIPTION_SIZE, HEADER_SIZE, FileHeader, FileNameError
from cfepy.osal import OS_SEEK_SET
from cfepy.reading.texts import from_bytes, to_bytes
from cfepy.status import (
    CFE_FS_BAD_ARGUMENT,
    CFE_FS_INVALID_PATH,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CfeError,
    OsalError,
)

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

BAD = CFE_FS_BAD_ARGUMENT
HEADER = struct.Struct("<8I32s")
"""CFE_FS_Header_t."""


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_headers(api, c)
    _declare_names(api, c)
    _declare_dumps(api, c)


# -- headers -----------------------------------------------------------------------------------------------------------


def _put_header(memory: CMemory, at: int, header: FileHeader) -> None:
    raw = HEADER.pack(
        header.content_type,
        header.subtype,
        header.length,
        header.spacecraft_id,
        header.processor_id,
        header.application_id,
        header.time_seconds,
        header.time_subseconds,
        to_bytes(header.description)[:DESCRIPTION_SIZE],
    )
    memory.poke(at, raw)


def _header_at(memory: CMemory, at: int) -> FileHeader:
    content, subtype, length, spacecraft, processor, app, seconds, subseconds, description = HEADER.unpack(
        memory.peek(at, HEADER_SIZE)
    )
    return FileHeader(
        from_bytes(description), subtype, content, length, spacecraft, processor, app, seconds, subseconds
    )


def _declare_headers(api: Declarations, c: CRuntime) -> None:
    fs, os, memory = c.handle.fs, c.cfe.os, c.memory

    def init_header(at: int, description: str | None, subtype: int) -> None:
        if not at or description is None:
            c.handle.es.write_to_sys_log("CFE_FS_InitHeader: Failed invalid arguments")
        else:
            _put_header(memory, at, fs.init_header(description, subtype))

    def read_header(at: int, filedes: int) -> int:
        try:
            header = fs.read_header(filedes)
        except CfeError:
            with suppress(OsalError):  # what there is goes into the caller's structure, as in the file
                os.lseek(filedes, 0, OS_SEEK_SET)
                memory.poke(at, os.read(filedes, HEADER_SIZE))
            raise
        _put_header(memory, at, header)
        return HEADER_SIZE

    def write_header(filedes: int, at: int) -> int:
        header = _header_at(memory, at)
        try:
            os.lseek(filedes, 0, OS_SEEK_SET)
        except OsalError as error:
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, str(error)) from error
        _put_header(memory, at, c.cfe.fs.stamp_header(header))  # the caller sees it even if the write fails
        return fs.write_header(filedes, header)

    api.add("CFE_FS_InitHeader", "psI", init_header)
    api.add("CFE_FS_ReadHeader", "PI", read_header, BAD)
    api.add("CFE_FS_WriteHeader", "IP", write_header, BAD)
    api.add("CFE_FS_SetTimestamp", "It", fs.set_timestamp)


# -- names -------------------------------------------------------------------------------------------------------------


def _declare_names(api: Declarations, c: CRuntime) -> None:
    fs, memory, constants = c.handle.fs, c.memory, c.constants

    def constant(get: Callable[[int], str | None]) -> Callable[[int], int]:
        def tell(category: int) -> int:
            text = get(category)
            return 0 if text is None else constants.text(text)

        return tell

    def put_made(to: int, size: int, make: Callable[[], str]) -> None:
        need(BAD, to, size)
        try:
            memory.poke(to, to_bytes(make()) + b"\0")
        except FileNameError as error:
            memory.poke(to, to_bytes(error.made) + b"\0")
            raise

    def nothing() -> str:
        raise FileNameError(CFE_FS_INVALID_PATH, "missing file name, and no default name", "")

    def parse(to: int, name: str | None, size: int, category: int) -> None:
        put_made(to, size, nothing if name is None else lambda: fs.parse_input_file_name(name, category, size))

    def parse_ex(
        to: int, name: int, size: int, name_size: int, default: str | None, path: str | None, extension: str | None
    ) -> None:
        text = from_bytes(_text_within(memory, name, name_size)) if name and name_size else ""
        make = partial(fs.parse_input_file_name_ex, text, default, path, extension, size)
        put_made(to, size, make if text or default is not None else nothing)

    def extract(path: str, to: int) -> None:
        memory.poke(to, to_bytes(fs.extract_filename_from_path(path)) + b"\0")

    api.add("CFE_FS_GetDefaultMountPoint", "I", constant(fs.get_default_mount_point))
    api.add("CFE_FS_GetDefaultExtension", "I", constant(fs.get_default_extension))
    api.add("CFE_FS_ParseInputFileName", "psQI", parse)
    api.add("CFE_FS_ParseInputFileNameEx", "ppQQsss", parse_ex)
    api.add("CFE_FS_ExtractFilenameFromPath", "SP", extract, BAD)


def _text_within(memory: CMemory, at: int, size: int) -> bytes:
    """Return the bytes of a text up to its NUL, at most `size`; nothing beyond is read."""
    found = bytearray()
    while len(found) < size:
        piece = memory.peek(at + len(found), min(size - len(found), 64 - (at + len(found)) % 64))
        end = piece.find(0)
        if end >= 0:
            return bytes(found + piece[:end])
        found += piece
    return bytes(found)


# -- background writes -------------------------------------------------------------------------------------------------


class CFileWrite:
    """A `FileWrite` for a background write that C describes (CFE_FS_FileWriteMetaData_t). All data is in C's memory.

    Args:
        c: the C side of the processor.
        at: the structure.
        outputs: a place for the outputs of GetData.
    """

    _NAME_AT, _NAME_SIZE = 1, 64
    _SUBTYPE_AT, _DESCRIPTION_AT, _GET_DATA_AT, _ON_EVENT_AT = 68, 72, 104, 112

    def __init__(self, c: CRuntime, at: int, outputs: int) -> None:
        self._c = c
        self._at = at
        self._outputs = outputs
        self._memory = c.memory

    def has_functions(self) -> bool:
        """Return True if both functions are there; C code may pass NULL."""
        at = self._at
        return bool(self._memory.u64(at + self._GET_DATA_AT) and self._memory.u64(at + self._ON_EVENT_AT))

    @property
    def is_pending(self) -> bool:
        """IsPending of the structure, which C code may read itself."""
        return bool(self._memory.u8(self._at))

    @is_pending.setter
    def is_pending(self, value: bool) -> None:
        self._memory.poke(self._at, bytes([value]))

    @property
    def file_name(self) -> str:
        """The path."""
        return from_bytes(self._memory.peek(self._at + self._NAME_AT, self._NAME_SIZE))

    @property
    def description(self) -> str:
        """The description in the header of the file."""
        return from_bytes(self._memory.peek(self._at + self._DESCRIPTION_AT, DESCRIPTION_SIZE))

    @property
    def file_subtype(self) -> int:
        """The subtype in the header of the file."""
        return self._memory.u32(self._at + self._SUBTYPE_AT)

    @property
    def get_data(self) -> Callable[[int], tuple[bytes, bool]]:
        """GetData(Meta, RecordNum, &Buffer, &BufSize), which returns whether the record is the last one."""
        function = self._memory.u64(self._at + self._GET_DATA_AT)
        return lambda record: self._ask(function, record)

    @property
    def on_event(self) -> Callable[..., object]:
        """OnEvent(Meta, Event, Status, RecordNum, BlockSize, Position)."""
        function = self._memory.u64(self._at + self._ON_EVENT_AT)
        return lambda *arguments: self._c.run(function, self._at, *arguments)

    def _ask(self, function: int, record: int) -> tuple[bytes, bool]:
        outputs = self._outputs
        self._memory.poke(outputs, bytes(16))
        is_last = self._c.run(function, self._at, record, outputs, outputs + 8) & 0xFF
        size = self._memory.u64(outputs + 8)
        return self._memory.peek(self._memory.u64(outputs), size) if size else b"", bool(is_last)


def _declare_dumps(api: Declarations, c: CRuntime) -> None:
    fs, outputs = c.handle.fs, c.arena.map(16)

    def request(at: int) -> None:
        meta = CFileWrite(c, at, outputs)
        if not meta.has_functions():
            raise CfeError(BAD, "a background write requires a function for its data and one for its end")
        fs.background_file_dump_request(meta)

    def is_pending(at: int) -> bool:
        return bool(at) and CFileWrite(c, at, outputs).is_pending

    api.add("CFE_FS_BackgroundFileDumpRequest", "P", request, BAD)
    api.add("CFE_FS_BackgroundFileDumpIsPending", "p", is_pending)
