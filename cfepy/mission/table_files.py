"""`TableFiles`: the file system as Table Services use it, with a descriptor of OSAL for each file that they open.

They leave the file of every load from the ground open, so a processor that loads fifty tables opens no file any more.
"""

from __future__ import annotations

from cfepy.osal import OS_FILE_FLAG_CREATE, OS_FILE_FLAG_TRUNCATE, OS_READ_ONLY, OS_WRITE_ONLY, Osal


class TableFiles:
    """See `cfepy.tbl.table_file.TableStorage`.

    Args:
        osal: of the processor.
    """

    def __init__(self, osal: Osal) -> None:
        self._osal = osal

    def read_file(self, path: str) -> bytes:
        """The whole content of a file."""
        self._osal.close(self._osal.open_create(path, access_mode=OS_READ_ONLY))
        return self._osal.files.read_file(path)

    def leave_open(self, path: str) -> None:
        """Open a file and lose its descriptor."""
        self._osal.open_create(path, access_mode=OS_READ_ONLY)

    def write_file(self, path: str, data: bytes) -> None:
        """Make or replace a file."""
        flags = OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE
        self._osal.close(self._osal.open_create(path, flags, OS_WRITE_ONLY))
        self._osal.files.write_file(path, data)

    def exists(self, path: str) -> bool:
        """Whether there is such a file."""
        return self._osal.files.exists(path)
