"""The virtual file system behind OSAL's file functions: mount points and the files below them (osapi-filesys.c).

`/cf` is the mission's folder, and `/ram` is a disk in memory. This module reads and writes files as a whole;
`cfepy.osal.files` adds OSAL's file descriptors.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from cfepy.osal.limits import OS_MAX_FILE_NAME, OS_MAX_PATH_LEN
from cfepy.osal.volumes import LAST_OF_EXT4, FileNode, Volume
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


LONGEST_FILE = 1 << 30
"""Bytes of the longest file, because files are in the host's memory."""


class FilePlace(NamedTuple):
    """The place of a virtual path: a volume and a path in it.

    Attributes:
        volume: the volume.
        path: without empty parts and ".".
        ending: "/" or "." if the virtual path ends so, which only a folder may; otherwise "".
    """

    volume: Volume
    path: str
    ending: str

    def node(self) -> FileNode | None:
        """Return the file there, or None if there is none."""
        return None if self.ending else self.volume.node(self.path)


class FileSystem:
    """Mounted volumes by virtual path.

    Args:
        cf: folder of the host shown at `/cf`; None for an empty one.
        ram_bytes: size of the disk at `/ram` in bytes; None for no limit.
    """

    def __init__(self, cf: Path | None = None, ram_bytes: int | None = RAM_BLOCK_BYTES * RAM_BLOCKS) -> None:
        disk = Volume(cf, last_position=LAST_OF_EXT4)
        self._mounts: dict[str, Volume] = {"/cf": disk, "/ram": Volume(capacity=ram_bytes)}
        self._own = dict(self._mounts)  # the mounts after a reset

    def mount(self, mount_point: str, volume: Volume, guest: bool = False) -> None:
        """Mount a volume at a path such as "/data".

        OSAL accepts any text. Files behind "data" cannot be reached, and those behind "/data/" as "/data//file" only.

        Args:
            mount_point: the path.
            volume: the volume.
            guest: flight software mounts it, so a reset removes it, unless it replaced a permanent volume. While
                another volume is mounted there, it cannot be reached.
        """
        if guest:
            volume = self._mounts.setdefault(mount_point, volume)
        self._mounts[mount_point] = volume
        if not guest or mount_point in self._own:
            self._own[mount_point] = volume

    def forget_guests(self) -> None:
        """Restore the mounts for a processor reset: undo the mounts and unmounts of flight software."""
        self._mounts = dict(self._own)
        for volume in self._mounts.values():
            volume.make_folder("")

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
        place = self.place_of(path)
        if place is None:
            points = ", ".join(self.mount_points())
            raise OsalError(OS_FS_ERR_PATH_INVALID, f"{path!r} is not below a mount point; expected one of {points}")
        return place

    def place_of(self, path: str) -> FilePlace | None:
        """Return the volume and path behind an absolute path, with names of any length; None if it is outside."""
        for mount_point, volume in self._mounts.items():
            if path == mount_point or path.startswith(mount_point + "/"):
                rest = path[len(mount_point) :]
                if rest.endswith("/") or "/." in rest or "//" in rest:
                    return _plain_place(volume, rest)
                return FilePlace(volume, rest[1:], "")
        return None

    def find(self, path: str) -> FileNode | None:
        """Return the file at a path, or None if there is none.

        Raises:
            OsalError: see `translate`.
        """
        return self.translate(path).node()

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
        if self.fitting(self.translate(path).volume, len(node.data), len(data)) < len(data):
            raise OsalError(OS_ERROR, f"the volume of {path} has no room for {len(data)} bytes")
        node.data[:] = data
        node.modified_ns = now_ns

    def open_node(self, path: str) -> FileNode:
        """Return the file at a path, or a new empty file if it does not exist.

        Raises:
            OsalError: OS_ERROR if its folder does not exist or it is a folder; see `translate`.
        """
        volume, rest, ending = self.translate(path)
        if ending or volume.is_folder(rest) or not volume.is_folder(rest.rpartition("/")[0]):
            raise OsalError(OS_ERROR, f"{path} is a folder, or its folder does not exist")
        return volume.node(rest) or volume.create(rest)

    def fitting(self, volume: Volume, size: int, wanted: int) -> int:
        """Return the bytes, at most `wanted`, to which a file of `size` bytes can grow in a volume."""
        room = volume.room()
        return min(wanted, LONGEST_FILE if room is None else min(size + room, LONGEST_FILE))

    def exists(self, path: str) -> bool:
        """Return whether a file or folder exists at a path; False for an invalid path.

        It never raises.
        """
        try:
            place = self.translate(path)
        except OsalError:
            return False
        return place.node() is not None or place.volume.is_folder(place.path)

    def is_folder(self, path: str) -> bool:
        """Return whether there is a folder at a path.

        Raises:
            OsalError: see `translate`.
        """
        volume, rest, _ = self.translate(path)
        return volume.is_folder(rest)

    def remove(self, path: str) -> None:
        """Remove a file, or an empty folder (OS_remove).

        Raises:
            OsalError: OS_ERROR if neither exists; see `translate`.
        """
        place = self.translate(path)
        if place.node() is not None:
            place.volume.remove(place.path)
        elif place.volume.is_folder(place.path):
            self.remove_folder(path)
        else:
            raise OsalError(OS_ERROR, f"file {path} does not exist")

    def rename(self, old: str, new: str) -> None:
        """Give a file or folder another path in the same volume (OS_rename).

        Raises:
            OsalError: OS_ERROR if neither exists, the volume is different, or another file or folder is in the way; see
                `translate`.
        """
        source, target = self.translate(old), self.translate(new)
        volume = source.volume
        if volume is target.volume and source.node() is not None and _can_be_file(target):
            volume.rename(source.path, target.path)
        elif volume is target.volume and _can_move_folder(source, target):
            if source.path != target.path:
                volume.rename_folder(source.path, target.path)
        else:
            raise OsalError(OS_ERROR, f"cannot rename {old} to {new}")

    def make_folder(self, path: str) -> None:
        """Add a folder (OS_mkdir); one that exists stays as it is.

        Raises:
            OsalError: OS_ERROR if a file is in the way or the parent folder does not exist; see `translate`.
        """
        volume, rest, ending = self.translate(path)
        if volume.is_folder(rest):
            return
        has_parent = not rest or volume.is_folder(rest.rpartition("/")[0])
        if ending == "." or volume.node(rest) is not None or not has_parent:
            raise OsalError(OS_ERROR, f"{path} is a file, or its folder does not exist")
        volume.make_folder(rest)

    def remove_folder(self, path: str) -> None:
        """Remove an empty folder (OS_rmdir), also the folder of a whole volume, which then takes no file until
        `make_folder` or a reset.

        Raises:
            OsalError: OS_ERROR if it does not exist or is not empty, or if the path ends in "."; see `translate`.
        """
        volume, rest, ending = self.translate(path)
        if ending == "." or not volume.is_folder(rest) or volume.names(rest):
            raise OsalError(OS_ERROR, f"{path} is not an empty folder")
        volume.remove_folder(rest)

    def list_dir(self, path: str) -> list[str]:
        """Return the names in a folder, sorted.

        Raises:
            OsalError: OS_ERROR if the folder does not exist; see `translate`.
        """
        volume, rest, _ = self.translate(path)
        if not volume.is_folder(rest):
            raise OsalError(OS_ERROR, f"folder {path} does not exist")
        return volume.names(rest)


def _plain_place(volume: Volume, rest: str) -> FilePlace:
    """Return the place behind the rest of a path that may have empty parts and "."."""
    named = [part for part in rest.split("/") if part]
    ending = "." if named and named[-1] == "." else "/" if rest.endswith("/") else ""
    return FilePlace(volume, "/".join(part for part in named if part != "."), ending)


def _can_be_file(place: FilePlace) -> bool:
    """Return whether a file may have this place: it is inside a folder and not a folder itself."""
    volume, path, ending = place
    return not ending and not volume.is_folder(path) and volume.is_folder(path.rpartition("/")[0])


def _can_move_folder(source: FilePlace, target: FilePlace) -> bool:
    """Return whether a folder can be renamed to a place in a folder, which is the same, or has nothing or an empty
    folder.
    """
    (volume, old, _), (_, new, _) = source, target
    if "." in (source.ending, target.ending) or not volume.is_folder(old):
        return False
    if new == old:
        return True
    if not old or f"{new}/".startswith(f"{old}/"):
        return False
    is_free = not volume.names(new) if volume.is_folder(new) else volume.node(new) is None
    return is_free and bool(new) and volume.is_folder(new.rpartition("/")[0])
