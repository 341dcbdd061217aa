"""A table file to be loaded: the checks on it, and the event for each failed check.

It replaces the first half of cfe_tbl_load.c. A refusal carries its event; the code that requested the load sends it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol

from cfepy.config.platform import PlatformConfig
from cfepy.fs import (
    CONTENT_ID,
    HEADER_SIZE,
    SUBTYPE_TBL_IMG,
    TABLE_HEADER_SIZE,
    FileHeader,
    TableHeader,
    read_header,
    read_table_header,
)
from cfepy.status import (
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CFE_STATUS_VALIDATION_FAILURE,
    CFE_SUCCESS,
    CFE_TBL_ERR_ACCESS,
    CFE_TBL_ERR_BAD_CONTENT_ID,
    CFE_TBL_ERR_BAD_PROCESSOR_ID,
    CFE_TBL_ERR_BAD_SPACECRAFT_ID,
    CFE_TBL_ERR_BAD_SUBTYPE_ID,
    CFE_TBL_ERR_FILE_FOR_WRONG_TABLE,
    CFE_TBL_ERR_FILE_TOO_LARGE,
    CFE_TBL_ERR_FILENAME_TOO_LONG,
    CFE_TBL_ERR_NO_STD_HEADER,
    CFE_TBL_ERR_NO_TBL_HEADER,
    CFE_TBL_ERR_PARTIAL_LOAD,
    CFE_TBL_WARN_PARTIAL_LOAD,
    CFE_TBL_WARN_SHORT_FILE,
    OS_FS_ERR_PATH_TOO_LONG,
    CfeError,
    OsalError,
    to_signed,
)
from cfepy.tbl import events as ev
from cfepy.tbl.image import is_intact, mark_for, mark_in
from cfepy.tbl.packets import FULL_NAME_SIZE
from cfepy.tbl.registry import TableRecord


class TableStorage(Protocol):
    """The file system as Table Services use it; failures raise OsalError."""

    def read_file(self, path: str) -> bytes:
        """Return the whole content of a file."""

    def leave_open(self, path: str) -> None:
        """Open a file and lose its descriptor."""

    def write_file(self, path: str, data: bytes) -> None:
        """Create or replace a file."""

    def exists(self, path: str) -> bool:
        """Return whether the file exists."""


class Refused(CfeError):
    """Exception for a refused load.

    Args:
        status: the result of CFE_TBL_Load.
        event_id: the event for the ground.
        text: the reason in the text of the event.
        names_file: whether the event also names the file.
    """

    def __init__(self, status: int, event_id: int, text: str, names_file: bool = True) -> None:
        super().__init__(status, text)
        self.event_id = event_id
        self.names_file = names_file


class LoadFile:
    """A table file as far as it could be read; `table_name` is "[unknown]" until both headers are valid.

    Args:
        path: its path.
        config: the accepted spacecraft and processors.
        stays_open: whether the file is never closed, as after a load from the ground.
    """

    def __init__(self, path: str, config: PlatformConfig, stays_open: bool = False) -> None:
        self.path = path
        self._stays_open = stays_open
        self._config = config
        self.table_name = "[unknown]"
        self.header = FileHeader()
        self.table = TableHeader("", 0)
        self.image = b""

    def open(self, files: TableStorage) -> None:
        """Read the file and check its headers (CFE_TBL_TxnOpenTableLoadFile).

        Raises:
            Refused: if it cannot be opened, is not a cFE file or a table image, is for another spacecraft or processor,
                or is damaged according to its integrity mark.
        """
        try:
            data = files.read_file(self.path)
        except OsalError as error:
            if error.status == OS_FS_ERR_PATH_TOO_LONG:
                status, event_id = CFE_TBL_ERR_FILENAME_TOO_LONG, ev.LOAD_FILENAME_LONG_ERR_EID
                raise Refused(status, event_id, "Filename invalid") from None
            text = f"Unable to open, Status = {error.status}"
            raise Refused(CFE_TBL_ERR_ACCESS, ev.FILE_ACCESS_ERR_EID, text) from None
        self._read_headers(data)
        if self._stays_open:
            files.leave_open(self.path)

    def _read_headers(self, data: bytes) -> None:
        if len(data) < HEADER_SIZE:
            text = f"Unable to read std header, Status = 0x{CFE_STATUS_EXTERNAL_RESOURCE_FAIL & 0xFFFFFFFF:08x}"
            raise Refused(CFE_TBL_ERR_NO_STD_HEADER, ev.FILE_STD_HDR_ERR_EID, text)
        self.header = header = read_header(data)
        if header.content_type != CONTENT_ID:
            text = f"not a cFE file type, ContentType = 0x{header.content_type:08x}"
            raise Refused(CFE_TBL_ERR_BAD_CONTENT_ID, ev.FILE_TYPE_ERR_EID, text)
        if header.subtype != SUBTYPE_TBL_IMG:
            text = f"File subtype is wrong. Subtype = 0x{header.subtype:08x}"
            raise Refused(CFE_TBL_ERR_BAD_SUBTYPE_ID, ev.FILE_SUBTYPE_ERR_EID, text)
        self._check_ids(header)
        if len(data) < HEADER_SIZE + TABLE_HEADER_SIZE:
            text = f"Unable to read tbl header, Status = 0x{len(data) - HEADER_SIZE:08x}"
            raise Refused(CFE_TBL_ERR_NO_TBL_HEADER, ev.FILE_TBL_HDR_ERR_EID, text)
        header_in_file = read_table_header(data)
        self.table = replace(header_in_file, table_name=header_in_file.table_name[: FULL_NAME_SIZE - 1])
        self.table_name = self.table.table_name or self.table_name
        if not is_intact(data):
            text = f"File is damaged, mark = 0x{mark_in(data):08x}, expected 0x{mark_for(data):08x}"
            raise Refused(CFE_STATUS_VALIDATION_FAILURE, ev.CODEC_ERROR_ERR_EID, text)
        self.image = data[HEADER_SIZE + TABLE_HEADER_SIZE :]

    def _check_ids(self, header: FileHeader) -> None:
        """Check the spacecraft and processor in the header (CFE_TBL_ValidateTableHeaderId); an empty list
        accepts all.
        """
        spacecraft, processors = self._config.tbl_valid_scid, self._config.tbl_valid_prid
        if spacecraft and header.spacecraft_id not in spacecraft:
            text = f"Invalid Spacecraft ID (0x{header.spacecraft_id:08X})"
            raise Refused(CFE_TBL_ERR_BAD_SPACECRAFT_ID, ev.SPACECRAFT_ID_ERR_EID, text)
        if processors and header.processor_id not in processors:
            text = f"Invalid Processor ID (0x{header.processor_id:08X})"
            raise Refused(CFE_TBL_ERR_BAD_PROCESSOR_ID, ev.PROCESSOR_ID_ERR_EID, text)

    def check_fits(self, table: TableRecord) -> None:
        """Check that the content fits a table (CFE_TBL_ValidateFileIsLoadable).

        Raises:
            Refused: for another table's file, no data, partial data for a table never loaded, or data that does not
                fit.
        """
        name, offset, size = self.table.table_name, self.table.offset, self.table.num_bytes
        if name != table.name:
            text = f"File for wrong table '{name}'"
            raise Refused(CFE_TBL_ERR_FILE_FOR_WRONG_TABLE, ev.LOAD_TBLNAME_MISMATCH_ERR_EID, text)
        if size == 0:
            text = "Table header indicates no data in file"
            raise Refused(CFE_TBL_ERR_NO_TBL_HEADER, ev.ZERO_LENGTH_LOAD_ERR_EID, text)
        if offset > 0 and not table.is_loaded:
            text = "partial load for uninitialized table"
            raise Refused(CFE_TBL_ERR_PARTIAL_LOAD, ev.PARTIAL_LOAD_ERR_EID, text)
        end = offset + size
        if (end & 0xFFFFFFFF if self._config.release.sizes_of_32_bits else end) > table.size:
            text = f"Cannot load {size} at off {offset}"
            raise Refused(CFE_TBL_ERR_FILE_TOO_LARGE, ev.LOAD_EXCEEDS_SIZE_ERR_EID, text)

    def too_big(self) -> Refused:
        """Return the refusal of a file with more data than there is room for, or than its header declares."""
        text = f"File has more data than Tbl Hdr indicates ({to_signed(self.table.num_bytes)})"
        return Refused(CFE_TBL_ERR_FILE_TOO_LARGE, ev.FILE_TOO_BIG_ERR_EID, text)

    def completeness(self, table: TableRecord) -> int:
        """Return CFE_SUCCESS, or the warning that the file has only a part of the table."""
        if self.table.offset > 0:
            return CFE_TBL_WARN_PARTIAL_LOAD
        return CFE_TBL_WARN_SHORT_FILE if self.table.num_bytes < table.size else CFE_SUCCESS
