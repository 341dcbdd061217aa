"""OSAL's directory functions (osapi-dir.h) on the virtual file system.

May import cfepy.ids, status and its neighbours in cfepy.osal.
"""

from __future__ import annotations

from cfepy.ids import OS_DIR_BASE
from cfepy.osal.core import Core, ObjectTable, OsObject, Setup
from cfepy.osal.filesystem import FileSystem
from cfepy.osal.limits import OS_MAX_NUM_OPEN_DIRS, OS_READ_WRITE


class OsDirectory(OsObject):
    """The record of an open folder."""

    __slots__ = ("entries", "position")

    def __init__(self, name: str, entries: list[str]) -> None:
        super().__init__(name)
        self.entries = entries
        self.position = 0


class DirectoryApi(Core):
    """The functions on folders."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self.files: FileSystem = setup.files
        self._directories: ObjectTable[OsDirectory] = self._table("directory", OS_DIR_BASE, OS_MAX_NUM_OPEN_DIRS)
        self._directories_opened = 0

    def mkdir(self, path: str, access: int = OS_READ_WRITE) -> None:
        """Make a folder (OS_mkdir); OS_ERROR when that cannot be, OS_FS_ERR_* for the path.

        Args:
            path: virtual path; a folder that is there already stays as it is.
            access: without effect, as in NASA's.
        """
        self.files.make_folder(path)

    def rmdir(self, path: str) -> None:
        """Remove an empty folder (OS_rmdir); OS_ERROR when it is none, OS_FS_ERR_* for the path."""
        self.files.remove_folder(path)

    def directory_open(self, path: str) -> int:
        """Open a folder to read its names, sorted (OS_DirectoryOpen).

        Raises:
            OsalError: OS_ERROR when there is none; OS_FS_ERR_* for the path; OS_ERR_NO_FREE_IDS.
        """
        self._directories_opened += 1  # open folders have no names in OSAL, records here do
        record = OsDirectory(f"#{self._directories_opened}", self.files.list_dir(path))
        return self._register(self._directories, record, "directory", 0)

    def directory_close(self, dir_id: int) -> None:
        """Close a folder (OS_DirectoryClose), or OS_ERR_INVALID_ID."""
        self._unregister(self._directories, self._directory(dir_id))

    def directory_read(self, dir_id: int) -> str | None:
        """The next name, None after the last one, where NASA's returns OS_ERROR (OS_DirectoryRead).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        directory = self._directory(dir_id)
        if directory.position >= len(directory.entries):
            return None
        directory.position += 1
        return directory.entries[directory.position - 1]

    def directory_rewind(self, dir_id: int) -> None:
        """Begin again with the first name (OS_DirectoryRewind), or OS_ERR_INVALID_ID."""
        self._directory(dir_id).position = 0

    def _directory(self, dir_id: int) -> OsDirectory:
        directory = self._directories.lookup(dir_id)
        if directory is None:
            raise self._directories.missing(dir_id)
        return directory
