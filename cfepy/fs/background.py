"""Files that a background task writes in small parts (CFE_FS_BackgroundFileDump*).

Code with much to write describes it in a `FileWriteMetaData` and continues. The background task of Executive Services
requests one record after another, within a limit of bytes per second, and reports the result.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol

from cfepy.fs.header import HEADER_SIZE, FileHeader, init_header
from cfepy.osal import OS_FILE_FLAG_CREATE, OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY, Osal
from cfepy.status import (
    CFE_FS_BAD_ARGUMENT,
    CFE_FS_INVALID_PATH,
    CFE_STATUS_REQUEST_ALREADY_PENDING,
    CFE_SUCCESS,
    CfeError,
)

MAX_REQUESTS = 3  # CFE_FS_MAX_BACKGROUND_FILE_WRITES minus the entry of its ring that stays empty
BYTES_PER_SECOND = 10_000
MAX_CREDIT = 10_000


class FileWriteEvent(IntEnum):
    """The result of a background write (CFE_FS_FileWriteEvent_t)."""

    COMPLETE = 1
    CREATE_ERROR = 2
    HEADER_WRITE_ERROR = 3
    RECORD_WRITE_ERROR = 4


class FileWrite(Protocol):
    """A file to write, as the queue sees it; see `FileWriteMetaData`."""

    is_pending: bool

    @property
    def file_name(self) -> str:
        """Full path."""

    @property
    def file_subtype(self) -> int:
        """SUBTYPE_* of its header."""

    @property
    def description(self) -> str:
        """Text of its header."""

    @property
    def get_data(self) -> Callable[[int], tuple[bytes, bool]]:
        """Returns a record by its number, and whether it is the last one."""

    @property
    def on_event(self) -> Callable[[FileWriteEvent, int, int, int, int], object]:
        """Called with the result."""


@dataclass(eq=False)
class FileWriteMetaData:
    """A file to write (CFE_FS_FileWriteMetaData_t).

    Attributes:
        file_name: full path.
        file_subtype: SUBTYPE_* of its header.
        description: text of its header.
        get_data: returns a record by its number, from 0, and whether it is the last one; empty records are not written.
        on_event: called with the result: event, status, number of the record, its size in bytes, bytes of the file.
        is_pending: whether it is waiting or being written.
    """

    file_name: str
    file_subtype: int
    description: str
    get_data: Callable[[int], tuple[bytes, bool]]
    on_event: Callable[[FileWriteEvent, int, int, int, int], object]
    is_pending: bool = False


class BackgroundWriter:
    """The queue of files to write.

    Args:
        osal: writes the files.
        write_header: writes the whole header to a descriptor; CFE_FS_WriteHeader.
        wake: wakes the background task.
    """

    def __init__(
        self, osal: Osal, write_header: Callable[[int, FileHeader], object], wake: Callable[[], object]
    ) -> None:
        self._osal = osal
        self._write_header = write_header
        self._wake = wake
        self._waiting: list[FileWrite] = []
        self._filedes = 0
        self._credit = 0
        self._record = 0
        self._size = 0

    def request(self, meta: FileWrite) -> None:
        """Add a file to the queue; see `FileServices.background_file_dump_request`."""
        if not callable(meta.get_data) or not callable(meta.on_event):
            raise CfeError(
                CFE_FS_BAD_ARGUMENT, "a background write requires a function for its data and one for its end"
            )
        if not meta.file_name:
            raise CfeError(CFE_FS_INVALID_PATH, "a background write requires a file name")
        if meta.is_pending or len(self._waiting) >= MAX_REQUESTS:
            raise CfeError(
                CFE_STATUS_REQUEST_ALREADY_PENDING,
                f"{meta.file_name}: this write or too many others are already waiting",
            )
        meta.is_pending = True
        self._waiting.append(meta)
        self._wake()

    def run(self, elapsed_ms: int) -> bool:
        """Write as much as the elapsed time allows (CFE_FS_RunBackgroundFileDump); return whether more is left."""
        self._credit = min(MAX_CREDIT, self._credit + elapsed_ms * BYTES_PER_SECOND // 1000)
        if not self._waiting:
            return False
        meta = self._waiting[0]
        finished = not self._filedes and not self._begin(meta)
        while not finished and self._credit > 0:
            finished = self._write_record(meta)
        if finished:
            self._waiting.pop(0)
            meta.is_pending = False
        return bool(self._waiting)

    def _begin(self, meta: FileWrite) -> bool:
        """Create the file with its header; return False after an error."""
        try:
            flags = OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE
            self._filedes = self._osal.open_create(meta.file_name, flags, OS_WRITE_ONLY)
        except CfeError as error:
            meta.on_event(FileWriteEvent.CREATE_ERROR, error.status, 0, 0, 0)
            return False
        self._record, self._size = 0, HEADER_SIZE
        try:
            self._write_header(self._filedes, init_header(meta.description, meta.file_subtype))
        except CfeError as error:
            self._close()
            meta.on_event(FileWriteEvent.HEADER_WRITE_ERROR, error.status, 0, HEADER_SIZE, 0)
            return False
        self._credit -= HEADER_SIZE
        return True

    def _write_record(self, meta: FileWrite) -> bool:
        """Write the next record; return True after the last one or an error."""
        data, is_last = meta.get_data(self._record)
        try:
            if data:
                self._osal.write_whole(self._filedes, data)
        except CfeError as error:
            self._close()
            meta.on_event(FileWriteEvent.RECORD_WRITE_ERROR, error.status, self._record, len(data), self._size)
            return True
        self._credit -= len(data)
        self._size += len(data)
        self._record += 1
        if is_last:
            self._close()
            meta.on_event(FileWriteEvent.COMPLETE, CFE_SUCCESS, self._record, 0, self._size)
        return is_last

    def _close(self) -> None:
        self._osal.close(self._filedes)
        self._filedes = 0
