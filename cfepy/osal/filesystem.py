"""The virtual file system behind OSAL's file functions: mount points and what is below them (osapi-filesys.c).

`/cf` is the mission's folder, `/ram` a disk in memory. Files are read and written as a whole here; `cfepy.osal.files`
adds OSAL's file descriptors.
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
    """Where a virtual path leads: a volume and a path in it."""

    volume: Volume
    path: str


class FileSystem:
    """Mounted volumes by virtual path.

    Args:
        cf: folder of the host that `/cf` shows, None for an empty one.
        ram_bytes: size of the disk at `/ram`, None for no limit.
    """

    def __init__(self, cf: Path | None = None, ram_bytes: int | None = RAM_BLOCK_BYTES * RAM_BLOCKS) -> None:
        self._mounts: dict[str, Volume] = {"/cf": Volume(cf), "/ram": Volume(capacity=ram_bytes)}
        self._own = dict(self._mounts)  # what is there again after a reset

    def mount(self, mount_point: str, volume: Volume, guest: bool = False) -> None:
        """Let a volume appear at a path such as "/data".

        Args:
            mount_point: the path.
            volume: what appears there.
            guest: flight software mounts it, so a reset takes it away, unless it took the place of one that stays.

        Raises:
            OsalError: OS_FS_ERR_PATH_INVALID.
        """
        if not mount_point.startswith("/") or mount_point.endswith("/"):
            raise OsalError(OS_FS_ERR_PATH_INVALID, f"invalid mount point {mount_point!r}; expected /NAME")
        self._mounts[mount_point] = volume
        if not guest or mount_point in self._own:
            self._own[mount_point] = volume

    def forget_guests(self) -> None:
        """The processor starts anew: what flight software mounted is gone, what it unmounted is back."""
        self._mounts = dict(self._own)

    def unmount(self, mount_point: str) -> Volume:
        """Take a volume out; its files stay in it.

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND.
        """
        if mount_point not in self._mounts:
            raise OsalError(OS_ERR_NAME_NOT_FOUND, f"no file system is mounted at {mount_point}")
        return self._mounts.pop(mount_point)

    def volume(self, mount_point: str) -> Volume:
        """The volume at a mount point.

        Raises:
            OsalError: OS_ERR_NAME_NOT_FOUND.
        """
        if mount_point not in self._mounts:
            raise OsalError(OS_ERR_NAME_NOT_FOUND, f"no file system is mounted at {mount_point}")
        return self._mounts[mount_point]

    def written(self) -> dict[str, bytes]:
        """Every file that the mission wrote and did not remove: virtual path to content."""
        return {
            f"{mount_point}/{path}": bytes(node.data)
            for mount_point, volume in sorted(self._mounts.items())
            for path in volume.written()
            if (node := volume.node(path)) is not None
        }

    def mount_points(self) -> list[str]:
        """The paths at which volumes are mounted, sorted."""
        return sorted(self._mounts)

    def translate(self, path: str) -> FilePlace:
        """Where a virtual path leads (OS_TranslatePath).

        Raises:
            OsalError: OS_FS_ERR_PATH_TOO_LONG (64 characters or more), OS_FS_ERR_NAME_TOO_LONG (a last part of 20 or
                more), OS_FS_ERR_PATH_INVALID (not absolute, not below a mount point, or with "..").
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
        """The file at a path, None when there is none.

        Raises:
            OsalError: as `translate`.
        """
        volume, rest = self.translate(path)
        return volume.node(rest)

    def read_file(self, path: str) -> bytes:
        """The whole content of a file.

        Raises:
            OsalError: OS_ERROR when there is none; as `translate`.
        """
        node = self.find(path)
        if node is None:
            raise OsalError(OS_ERROR, f"file {path} does not exist")
        return bytes(node.data)

    def write_file(self, path: str, data: bytes | bytearray | memoryview, now_ns: int = 0) -> None:
        """Make a file with this content, or replace what is in it.

        Args:
            path: its folder must exist.
            data: the content.
            now_ns: virtual time of the change.

        Raises:
            OsalError: OS_ERROR when there is no such folder or no room; as `translate`.
        """
        node = self.open_node(path)
        self.check_room(path, len(data) - len(node.data))
        node.data[:] = data
        node.modified_ns = now_ns

    def open_node(self, path: str) -> FileNode:
        """The file at a path, an empty new one when there was none.

        Raises:
            OsalError: OS_ERROR when its folder does not exist or it is a folder; as `translate`.
        """
        volume, rest = self.translate(path)
        if volume.is_folder(rest) or not volume.is_folder(rest.rpartition("/")[0]):
            raise OsalError(OS_ERROR, f"{path} is a folder, or its folder does not exist")
        return volume.node(rest) or volume.create(rest)

    def check_room(self, path: str, size: int) -> None:
        """Raise OS_ERROR when the volume of a path has no room for `size` more bytes."""
        if not self.translate(path).volume.has_room(size):
            raise OsalError(OS_ERROR, f"the volume of {path} has no room for {size} more bytes")

    def exists(self, path: str) -> bool:
        """Whether there is a file or folder at a path; False for a path that cannot be.

        Never raises.
        """
        try:
            volume, rest = self.translate(path)
        except OsalError:
            return False
        return volume.node(rest) is not None or volume.is_folder(rest)

    def is_folder(self, path: str) -> bool:
        """Whether there is a folder at a path.

        Raises:
            OsalError: as `translate`.
        """
        volume, rest = self.translate(path)
        return volume.is_folder(rest)

    def remove(self, path: str) -> None:
        """Remove a file, or an empty folder (OS_remove).

        Raises:
            OsalError: OS_ERROR when there is neither; as `translate`.
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
            OsalError: OS_ERROR when there is neither, the volume is another, or something else is in the way; as
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
            OsalError: OS_ERROR when a file or no folder is in the way; as `translate`.
        """
        volume, rest = self.translate(path)
        if volume.node(rest) is not None or not volume.is_folder(rest.rpartition("/")[0]):
            raise OsalError(OS_ERROR, f"{path} is a file, or its folder does not exist")
        volume.make_folder(rest)

    def remove_folder(self, path: str) -> None:
        """Remove an empty folder (OS_rmdir).

        Raises:
            OsalError: OS_ERROR when there is none, when it is not empty or a mount point; as `translate`.
        """
        volume, rest = self.translate(path)
        if not rest or not volume.is_folder(rest) or volume.names(rest):
            raise OsalError(OS_ERROR, f"{path} is not an empty folder")
        volume.remove_folder(rest)

    def list_dir(self, path: str) -> list[str]:
        """Names in a folder, sorted.

        Raises:
            OsalError: OS_ERROR when there is no such folder; as `translate`.
        """
        volume, rest = self.translate(path)
        if not volume.is_folder(rest):
            raise OsalError(OS_ERROR, f"folder {path} does not exist")
        return volume.names(rest)


def _can_be_file(volume: Volume, path: str) -> bool:
    """Whether a path is in a folder, and none itself."""
    return not volume.is_folder(path) and volume.is_folder(path.rpartition("/")[0])


def _can_move_folder(volume: Volume, old: str, new: str) -> bool:
    """Whether `old` is a folder that can become `new`: a path in a folder, with nothing or an empty folder there."""
    if not old or not volume.is_folder(old) or f"{new}/".startswith(f"{old}/"):
        return False
    is_free = not volume.names(new) if volume.is_folder(new) else volume.node(new) is None
    return is_free and bool(new) and volume.is_folder(new.rpartition("/")[0])
