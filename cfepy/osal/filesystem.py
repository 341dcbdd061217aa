"""The virtual file system behind OSAL's file functions: mount points and the files below them (osapi-filesys.c).

`/cf` is the mission's folder, and `/ram` is a disk in memory. This module reads and writes files as a whole;
`cfepy.osal.files` adds OSAL's file descriptors.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from cfepy.osal.limits import OS_MAX_FILE_NAME, OS_MAX_PATH_LEN
from cfepy.osal.volumes import FileNode, Volume
from cfepy.reading.texts import to_bytes
from cfepy.status import (
    OS_ERR_NAME_NOT_FOUND,
    OS_ERROR,
    OS_FS_ERR_NAME_TOO_LONG,
    OS_FS_ERR_PATH_INVALID,
    OS_FS_ERR_PATH_TOO_LONG,
    OsalError,
)

RAM_BLOCK_BYTES = 512  # CFE_PLATFORM_ES_RAM_DISK_SECTOR_SIZE
RAM_BLOCKS = 4096  # CFE_PLATFORM_ES_RAM_DISK_NUM_SECTORS


class FilePlace(NamedTuple):
    """The place of a virtual path: a volume and a path in it."""

    volume: Volume
    path: str


class FileSystem:
    """Mounted volumes by virtual path.

    Args:
        cf: folder of the host shown at `/cf`; None for an empty one.
        ram_bytes: size of the disk at `/ram` in bytes; None for no limit.
    """

    def __init__(self, cf: Path | None = None, ram_bytes: int | None = RAM_BLOCK_BYTES * RAM_BLOCKS) -> None:
        self._mounts: dict[str, Volume] = {"/cf": Volume(cf), "/ram": Volume(capacity=ram_bytes)}
        self._own = dict(self._mounts)  # the mounts after a reset

    def mount(self, mount_point: str, volume: Volume, guest: bool = False) -> None:
        """Mount a volume at a path such as "/data".

        Args:
            mount_point: the path.
            volume: the volume.
            guest: flight software mounts it, so a reset removes it, unless it replaced a permanent volume.

        Raises:
            OsalError: OS_FS_ERR_PATH_INVALID.
        """
        if not mount_point.startswith("/") or mount_point.endswith("/"):
            raise OsalError(OS_FS_ERR_PATH_INVALID, f"invalid mount point {mount_point!r}; expected /NAME")
        self._mounts[mount_point] = volume
        if not guest or mount_point in self._own:
            self._own[mount_point] = volume

    def forget_guests(self) -> None:
        """Restore the mounts for a processor reset: undo the mounts and unmounts of flight software."""
        self._mounts = dict(self._own)

    def unmount(self, mount_point: str) -> Volume:
        """Unmount a volume, which keeps its files, and return it.

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND.
        """
        if mount_point not in self._mounts:
            raise OsalError(OS_ERR_NAME_NOT_FOUND, f"no file system is mounted at {mount_point}")
        return self._mounts.pop(mount_point)

    def volume(self, mount_point: str) -> Volume:
        """Return the volume at a mount point.

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND.
        """
        if mount_point not in self._mounts:
            raise OsalError(OS_ERR_NAME_NOT_FOUND, f"no file system is mounted at {mount_point}")
        return self._mounts[mount_point]

    def written(self) -> dict[str, bytes]:
        """Return the contents of every file that the mission wrote and did not remove, by virtual path."""
        return {
            f"{mount_point}/{path}": bytes(node.data)
            for mount_point, volume in sorted(self._mounts.items())
            for path in volume.written()
            if (node := volume.node(path)) is not None
        }

    def mount_points(self) -> list[str]:
        """Return the mount points, sorted."""
        return sorted(self._mounts)

    def translate(self, path: str) -> FilePlace:
        """Return the volume and path behind a virtual path (OS_TranslatePath).

        Raises:
            OsalError: OS_FS_ERR_PATH_TOO_LONG (64 characters or more), OS_FS_ERR_NAME_TOO_LONG (a last part of 20
                characters or more), OS_FS_ERR_PATH_INVALID (not absolute, not below a mount point, or with "..").
        """
        if len(to_bytes(path)) >= OS_MAX_PATH_LEN:
            raise OsalError(OS_FS_ERR_PATH_TOO_LONG, f"{path!r} must have fewer than {OS_MAX_PATH_LEN} characters")
        if "/" in path and len(to_bytes(path.rpartition("/")[2])) >= OS_MAX_FILE_NAME:
            raise OsalError(
                OS_FS_ERR_NAME_TOO_LONG, f"the file name in {path!r} must have fewer than {OS_MAX_FILE_NAME} characters"
            )
        if not path.startswith("/") or ".." in path:
            raise OsalError(OS_FS_ERR_PATH_INVALID, f'{path!r} must begin with "/" and must not contain ".."')
        for mount_point, volume in self._mounts.items():
            if path == mount_point or path.startswith(mount_point + "/"):
                rest = [part for part in path[len(mount_point) :].split("/") if part not in ("", ".")]
                return FilePlace(volume, "/".join(rest))
        raise OsalError(
            OS_FS_ERR_PATH_INVALID,
            f"{path!r} is not below a mount point; expected one of {', '.join(self.mount_points())}",
        )

    def find(self, path: str) -> FileNode | None:
        """Return the file at a path, or None if there is none.

        Raises:
            OsalError: see `translate`.
        """
        volume, rest = self.translate(path)
        return volume.node(rest)

    def read_file(self, path: str) -> bytes:
        """Return the whole content of a file.

        Raises:
            OsalError: OS_ERROR if the file does not exist; see `translate`.
        """
        node = self.find(path)
        if node is None:
            raise OsalError(OS_ERROR, f"file {path} does not exist")
        return bytes(node.data)

    def write_file(self, path: str, data: bytes | bytearray | memoryview, now_ns: int = 0) -> None:
        """Write a file, replacing its content if it exists.

        Args:
            path: its folder must exist.
            data: the content.
            now_ns: virtual time of the change in ns.

        Raises:
            OsalError: OS_ERROR if there is no such folder or no room; see `translate`.
        """
        node = self.open_node(path)
        self.check_room(path, len(data) - len(node.data))
        node.data[:] = data
        node.modified_ns = now_ns

    def open_node(self, path: str) -> FileNode:
        """Return the file at a path, or a new empty file if it does not exist.

        Raises:
            OsalError: OS_ERROR if its folder does not exist or it is a folder; see `translate`.
        """
        volume, rest = self.translate(path)
        if volume.is_folder(rest) or not volume.is_folder(rest.rpartition("/")[0]):
            raise OsalError(OS_ERROR, f"{path} is a folder, or its folder does not exist")
        return volume.node(rest) or volume.create(rest)

    def check_room(self, path: str, size: int) -> None:
        """Raise OS_ERROR if the volume of a path has no room for `size` more bytes."""
        if not self.translate(path).volume.has_room(size):
            raise OsalError(OS_ERROR, f"the volume of {path} has no room for {size} more bytes")

    def exists(self, path: str) -> bool:
        """Return whether a file or folder exists at a path; False for an invalid path.

        It never raises.
        """
        try:
            volume, rest = self.translate(path)
        except OsalError:
            return False
        return volume.node(rest) is not None or volume.is_folder(rest)

    def is_folder(self, path: str) -> bool:
        """Return whether there is a folder at a path.

        Raises:
            OsalError: see `translate`.
        """
        volume, rest = self.translate(path)
        return volume.is_folder(rest)

    def remove(self, path: str) -> None:
        """Remove a file, or an empty folder (OS_remove).

        Raises:
            OsalError: OS_ERROR if neither exists; see `translate`.
        """
        volume, rest = self.translate(path)
        if volume.node(rest) is not None:
            volume.remove(rest)
        elif volume.is_folder(rest):
            self.remove_folder(path)
        else:
            raise OsalError(OS_ERROR, f"file {path} does not exist")

    def rename(self, old: str, new: str) -> None:
        """Give a file or folder another path in the same volume (OS_rename).

        Raises:
            OsalError: OS_ERROR if neither exists, the volume is different, or another file or folder is in the way; see
                `translate`.
        """
        (source, source_path), (target, target_path) = self.translate(old), self.translate(new)
        if source is target and source.node(source_path) is not None and _can_be_file(target, target_path):
            source.rename(source_path, target_path)
        elif source is target and _can_move_folder(source, source_path, target_path):
            source.rename_folder(source_path, target_path)
        else:
            raise OsalError(OS_ERROR, f"cannot rename {old} to {new}")

    def make_folder(self, path: str) -> None:
        """Add a folder (OS_mkdir); one that exists stays as it is.

        Raises:
            OsalError: OS_ERROR if a file is in the way or the parent folder does not exist; see `translate`.
        """
        volume, rest = self.translate(path)
        if volume.node(rest) is not None or not volume.is_folder(rest.rpartition("/")[0]):
            raise OsalError(OS_ERROR, f"{path} is a file, or its folder does not exist")
        volume.make_folder(rest)

    def remove_folder(self, path: str) -> None:
        """Remove an empty folder (OS_rmdir).

        Raises:
            OsalError: OS_ERROR if it does not exist, is not empty or is a mount point; see `translate`.
        """
        volume, rest = self.translate(path)
        if not rest or not volume.is_folder(rest) or volume.names(rest):
            raise OsalError(OS_ERROR, f"{path} is not an empty folder")
        volume.remove_folder(rest)

    def list_dir(self, path: str) -> list[str]:
        """Return the names in a folder, sorted.

        Raises:
            OsalError: OS_ERROR if the folder does not exist; see `translate`.
        """
        volume, rest = self.translate(path)
        if not volume.is_folder(rest):
            raise OsalError(OS_ERROR, f"folder {path} does not exist")
        return volume.names(rest)


def _can_be_file(volume: Volume, path: str) -> bool:
    """Return whether a file may have this path: it is inside a folder and not a folder itself."""
    return not volume.is_folder(path) and volume.is_folder(path.rpartition("/")[0])


def _can_move_folder(volume: Volume, old: str, new: str) -> bool:
    """Return whether the folder `old` can be renamed to `new`, a path in a folder with nothing or an empty folder
    there.
    """
    if not old or not volume.is_folder(old) or f"{new}/".startswith(f"{old}/"):
        return False
    is_free = not volume.names(new) if volume.is_folder(new) else volume.node(new) is None
    return is_free and bool(new) and volume.is_folder(new.rpartition("/")[0])
