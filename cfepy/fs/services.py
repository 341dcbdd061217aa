"""`FileServices`: the object behind `cfe.fs` (cFE's File Services).

It has the functions of cfe_fs.h. Those on open files and the background writes are methods here; the others are the
pure functions of this package.
"""

from __future__ import annotations

import struct
from collections.abc import Callable

from cfepy.config.platform import PlatformConfig
from cfepy.fs import filename, header
from cfepy.fs.background import BackgroundWriter, FileWrite
from cfepy.fs.header import HEADER_SIZE, TIMESTAMP_OFFSET, FileHeader
from cfepy.osal import OS_SEEK_SET, Osal
from cfepy.ports import Ports
from cfepy.status import CFE_FS_BAD_ARGUMENT, CFE_STATUS_EXTERNAL_RESOURCE_FAIL, CfeError, OsalError, UsageError


class FileServices:
    """The File Services of one processor.

    Args:
        osal: reads and writes files.
        ports: provides the time and the writer's AppId.
        config: provides the ids in headers.
        wake: wakes the background task of Executive Services.
    """

    init_header = staticmethod(header.init_header)
    get_default_mount_point = staticmethod(filename.get_default_mount_point)
    get_default_extension = staticmethod(filename.get_default_extension)
    parse_input_file_name = staticmethod(filename.parse_input_file_name)
    parse_input_file_name_ex = staticmethod(filename.parse_input_file_name_ex)
    extract_filename_from_path = staticmethod(filename.extract_filename_from_path)

    def __init__(self, osal: Osal, ports: Ports, config: PlatformConfig, wake: Callable[[], object]) -> None:
        self._osal = osal
        self._ports = ports
        self._config = config
        self._background = BackgroundWriter(osal, self.write_whole_header, wake)
        self.run_background_file_dump = self._background.run

    def read_header(self, filedes: int) -> FileHeader:
        """Return the cFE header of an open file, and move its position past the header (CFE_FS_ReadHeader).

        Args:
            filedes: descriptor from `cfe.os.open_create`.

        Raises:
            CfeError: CFE_STATUS_EXTERNAL_RESOURCE_FAIL if it is not open for reading or is shorter than 64 bytes.
        """
        try:
            self._osal.lseek(filedes, 0, OS_SEEK_SET)
            data = self._osal.read(filedes, HEADER_SIZE)
        except OsalError as error:
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, str(error)) from error
        return header.read_header(data)

    def stamp_header(self, file_header: FileHeader) -> FileHeader:
        """Return a header as `write_header` writes it: with this processor's ids, the caller's AppId, and the time."""
        return header.stamp_header(
            file_header,
            spacecraft_id=self._config.spacecraft_id,
            processor_id=self._config.processor_id,
            application_id=self._caller(),
            time=self._ports.time.now(),
        )

    def write_header(self, filedes: int, file_header: FileHeader) -> int:
        """Write a header at the start of an open file; ids, length and time are filled in (CFE_FS_WriteHeader).

        Args:
            filedes: descriptor from `cfe.os.open_create`.
            file_header: provides description and subtype; from `init_header`.

        Returns:
            The bytes written: 64, or fewer on a disk that is full after them.

        Raises:
            CfeError: CFE_STATUS_EXTERNAL_RESOURCE_FAIL (not open for writing, or the disk is full), CFE_FS_BAD_ARGUMENT
                (a subtype of more than 32 bits).
        """
        try:
            data = self.stamp_header(file_header).pack()
            self._osal.lseek(filedes, 0, OS_SEEK_SET)
            return self._osal.write(filedes, data)
        except OsalError as error:
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, str(error)) from error
        except UsageError as error:
            raise CfeError(CFE_FS_BAD_ARGUMENT, error.text) from error

    def write_whole_header(self, filedes: int, file_header: FileHeader) -> None:
        """Write a header like `write_header`; a short write is an error, with the number of bytes as its status."""
        count = self.write_header(filedes, file_header)
        if count != HEADER_SIZE:
            raise CfeError(count, f"only {count} bytes of the header were written")

    def set_timestamp(self, filedes: int, new_timestamp: tuple[int, int]) -> None:
        """Change the time in the header of an open file (CFE_FS_SetTimestamp).

        Args:
            filedes: descriptor from `cfe.os.open_create`.
            new_timestamp: seconds, and subseconds of 2**-32 s.

        Raises:
            CfeError: CFE_STATUS_EXTERNAL_RESOURCE_FAIL (not open for writing), CFE_FS_BAD_ARGUMENT (more than 32 bits).
        """
        try:
            data = struct.pack(">II", *new_timestamp)
        except struct.error as error:
            raise CfeError(CFE_FS_BAD_ARGUMENT, f"invalid time {new_timestamp}: {error}") from error
        what = "lseek time fields"
        try:
            self._osal.lseek(filedes, TIMESTAMP_OFFSET, OS_SEEK_SET)
            what = "write timestamp"
            self._osal.write_whole(filedes, data)
        except OsalError as error:
            self._ports.syslog.write_to_sys_log(f"CFE_FS_SetTimestamp: Failed to {what} (Status={error.status})")
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, str(error)) from error

    def background_file_dump_request(self, meta: FileWrite) -> None:
        """Request that the background task writes a file (CFE_FS_BackgroundFileDumpRequest).

        Args:
            meta: the file to write; do not change it until `is_pending` is False again.

        Raises:
            CfeError: CFE_FS_BAD_ARGUMENT (a function is missing), CFE_FS_INVALID_PATH (no file name),
                CFE_STATUS_REQUEST_ALREADY_PENDING (this one, or too many).
        """
        self._background.request(meta)

    def background_file_dump_is_pending(self, meta: FileWrite) -> bool:
        """Return whether a background write has not ended yet (CFE_FS_BackgroundFileDumpIsPending)."""
        return meta.is_pending

    def _caller(self) -> int:
        """Return the AppId of the caller, or 0 outside any application."""
        try:
            return self._ports.es.get_app_id()
        except CfeError:
            return 0
