"""OSAL's functions on whole file systems (osapi-filesys.h): create, mount and measure disks.

/cf, the mission's folder, is a fixed map. The RAM disk at /ram exists from the start as "/ramdev0", as after
CFE_ES_InitializeFileSystems.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from cfepy.ids import OS_FILESYS_BASE, OS_STREAM_BASE
from cfepy.osal.core import Core, OsObject, OsObjectTable, Setup
from cfepy.osal.filesystem import RAM_BLOCK_BYTES, FileSystem
from cfepy.osal.limits import (
    OS_FS_DEV_NAME_LEN,
    OS_FS_VOL_NAME_LEN,
    OS_MAX_PATH_LEN,
)
from cfepy.osal.volumes import LAST_OF_EXT4, Volume
from cfepy.reading.texts import to_bytes
from cfepy.status import (
    OS_ERR_NAME_NOT_FOUND,
    OS_ERR_NO_FREE_IDS,
    OS_ERR_NOT_IMPLEMENTED,
    OS_FS_ERR_DEVICE_NOT_FREE,
    OS_FS_ERR_DRIVE_NOT_CREATED,
    OS_FS_ERR_PATH_INVALID,
    OS_FS_ERR_PATH_TOO_LONG,
    OsalError,
)

RAM_DEVICE = "/ramdev0"
UNLIMITED_BLOCKS = 0xFFFFFFFF


class VolumeStat(NamedTuple):
    """The result of `file_sys_stat_volume` (OS_statvfs_t)."""

    block_size: int
    total_blocks: int
    blocks_free: int


class FileSystemInfo(NamedTuple):
    """The result of `get_fs_info` (os_fsinfo_t)."""

    max_fds: int
    free_fds: int
    max_volumes: int
    free_volumes: int


class OsDisk(OsObject):
    """The record of a file system, named after its device, or after the virtual path of a fixed map.

    Attributes:
        volume: its files.
        physical: the result of OS_FS_GetPhysDriveName.
        mount_point: where it is mounted; None if it is not.
        is_known: whether NASA's Linux OSAL would recognize the kind of disk and mount it.
    """

    __slots__ = ("block_size", "is_known", "mount_point", "physical", "volume")

    def __init__(
        self, name: str, volume: Volume, block_size: int, physical: str = "", mount_point: str | None = None
    ) -> None:
        super().__init__(name)
        self.volume = volume
        self.block_size = block_size
        self.physical = physical or f"RAM:{name}"
        self.mount_point = mount_point
        self.is_known = True


class DiskApi(Core):
    """The functions of osapi-filesys.h."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._mounts: FileSystem = setup.files
        self._mounts.forget_guests()
        self._disks: OsObjectTable[OsDisk] = self._table(
            "file system", OS_FILESYS_BASE, setup.config.os_max_file_systems, OS_MAX_PATH_LEN
        )
        self._folder = Path()
        """The base of relative host paths: the folder behind /cf."""
        for point in setup.files.mount_points():
            volume = setup.files.volume(point)
            if point == "/cf" and volume.host is not None:
                self._folder = volume.host
            device = RAM_DEVICE if point == "/ram" else point
            self._disks.add(OsDisk(device, volume, RAM_BLOCK_BYTES, str(volume.host or ""), point))

    def mkfs(self, devname: str, volname: str, blocksize: int, numblocks: int, *, in_memory: bool = False) -> None:
        """Create an empty, unmounted RAM disk (OS_mkfs).

        Args:
            devname: the device, e.g. "/ramdev1".
            volname: the volume; only one whose name begins with "RAM" can be mounted.
            blocksize: bytes of a block.
            numblocks: number of blocks.
            in_memory: the caller provides its memory address, so it can be mounted under any name.

        Raises:
            OsalError: OS_FS_ERR_PATH_TOO_LONG, OS_FS_ERR_PATH_INVALID (an empty name), OS_ERR_NAME_TAKEN,
                OS_FS_ERR_DEVICE_NOT_FREE.
        """
        self._check(devname, OS_FS_DEV_NAME_LEN)
        self._check(volname, OS_FS_VOL_NAME_LEN)
        if not devname or not volname:
            raise OsalError(OS_FS_ERR_PATH_INVALID, "a file system requires names for its device and its volume")
        size = blocksize * numblocks
        disk = OsDisk(devname, Volume(capacity=size), blocksize, f"{volname}:{devname}")
        disk.is_known = in_memory or volname.startswith("RAM")
        try:  # the board's own disk does not count as RAM
            self._register(self._disks, disk, "disk", 0 if devname == RAM_DEVICE else size)
        except OsalError as error:
            status = OS_FS_ERR_DEVICE_NOT_FREE if error.status == OS_ERR_NO_FREE_IDS else error.status
            raise OsalError(status, error.text) from error

    def initfs(self, devname: str, volname: str, blocksize: int, numblocks: int, *, in_memory: bool = False) -> None:
        """Initialize a RAM disk like `mkfs`; a new one is always empty (OS_initfs)."""
        self.mkfs(devname, volname, blocksize, numblocks, in_memory=in_memory)

    def rmfs(self, devname: str) -> None:
        """Remove a file system with all its files, mounted or not (OS_rmfs).

        Raises:
            OsalError: OS_FS_ERR_PATH_TOO_LONG, OS_ERR_NAME_NOT_FOUND.
        """
        self._check(devname, OS_MAX_PATH_LEN)
        disk = self._disk(devname)
        self._leave_mount(disk)
        self._unregister(self._disks, disk)

    def mount(self, devname: str, mountpoint: str) -> None:
        """Mount a disk at a virtual path (OS_mount).

        Args:
            devname: the device.
            mountpoint: the path. OSAL accepts any text, but only files behind one such as "/scratch" can be reached.

        Raises:
            OsalError: OS_FS_ERR_PATH_TOO_LONG; OS_ERR_NAME_NOT_FOUND if the disk does not exist, its volume is not a
                RAM disk ("RAM..."), it is already mounted, or another disk is mounted there.
        """
        self._check(devname, OS_FS_DEV_NAME_LEN)
        self._check(mountpoint, OS_MAX_PATH_LEN)
        disk = self._disk(devname)
        taken = mountpoint in self._mounts.mount_points()
        if disk.mount_point is not None or taken or not disk.is_known:
            raise OsalError(OS_ERR_NAME_NOT_FOUND, f"{devname} cannot be mounted at {mountpoint}")
        self._enter_mount(disk, mountpoint)

    def unmount(self, mountpoint: str) -> None:
        """Unmount a disk, which keeps its files (OS_unmount).

        Raises:
            OsalError: OS_FS_ERR_PATH_TOO_LONG, OS_ERR_NAME_NOT_FOUND.
        """
        self._leave_mount(self._mounted(mountpoint))

    def file_sys_add_fixed_map(self, phys_path: str | Path, virt_path: str) -> int:
        """Map a folder of the host permanently to a virtual path (OS_FileSysAddFixedMap). The folder is only read.

        Args:
            phys_path: the folder, relative to the mission's folder; a missing folder appears empty.
            virt_path: the virtual path, e.g. "/data"; see `mount`.

        Returns:
            The id of the file system.

        Raises:
            OsalError: OS_FS_ERR_PATH_TOO_LONG, OS_ERR_NAME_TAKEN, OS_ERR_NO_FREE_IDS; OS_FS_ERR_DRIVE_NOT_CREATED
                without phys_path.
        """
        self._check(virt_path, OS_MAX_PATH_LEN)
        volume = Volume(self._folder / phys_path, last_position=LAST_OF_EXT4)
        disk = OsDisk(virt_path, volume, RAM_BLOCK_BYTES, str(phys_path))
        disk_id = self._register(self._disks, disk, "disk", 0)
        if not str(phys_path):
            self._unregister(self._disks, disk)
            raise OsalError(OS_FS_ERR_DRIVE_NOT_CREATED, f"fixed map {virt_path} requires a folder")
        self._enter_mount(disk, virt_path)
        return disk_id

    def file_sys_stat_volume(self, name: str) -> VolumeStat:
        """Return the size and free space of the volume of a path (OS_FileSysStatVolume).

        Raises:
            OsalError: OS_FS_ERR_PATH_TOO_LONG, OS_ERR_NAME_NOT_FOUND.
        """
        disk = self._mounted(name)
        volume = disk.volume
        if volume.capacity is None:
            return VolumeStat(disk.block_size, UNLIMITED_BLOCKS, UNLIMITED_BLOCKS)
        free = max(0, volume.capacity - volume.used())
        return VolumeStat(disk.block_size, volume.capacity // disk.block_size, free // disk.block_size)

    def chkfs(self, name: str, repair: bool = False) -> None:
        """Refuse to check a file system (OS_chkfs), as on NASA's Linux.

        Args:
            name: a path on it.
            repair: has no effect.

        Raises:
            OsalError: OS_FS_ERR_PATH_TOO_LONG, OS_ERR_NAME_NOT_FOUND, otherwise OS_ERR_NOT_IMPLEMENTED.
        """
        self._mounted(name)
        raise OsalError(OS_ERR_NOT_IMPLEMENTED, f"file system {name} cannot be checked on Linux")

    def fs_get_phys_drive_name(self, mount_point: str) -> str:
        """Return the name of the volume mounted at a path: a folder of the host, or a RAM volume
        (OS_FS_GetPhysDriveName).

        Raises:
            OsalError: OS_FS_ERR_PATH_TOO_LONG, OS_ERR_NAME_NOT_FOUND.
        """
        return self._mounted(mount_point).physical

    def get_fs_info(self) -> FileSystemInfo:
        """Return the total and free numbers of descriptors and volumes (OS_GetFsInfo)."""
        open_files = len(self._tables[OS_STREAM_BASE])
        return FileSystemInfo(
            self.config.os_max_num_open_files,
            self.config.os_max_num_open_files - open_files,
            self.config.os_max_file_systems,
            self.config.os_max_file_systems - len(self._disks),
        )

    def translate_path(self, virtual_path: str) -> str:
        """Return the path behind a virtual path: a path of the host, or "RAM:device/..." in memory (OS_TranslatePath).

        Raises:
            OsalError: see `FileSystem.translate`.
        """
        place = self._mounts.translate(virtual_path)
        physical = next((disk.physical for disk in self._disks if disk.volume is place.volume), "")
        return f"{physical}/{place.path}" if place.path else physical

    def _forget_disks(self) -> None:
        """Unmount and remove all file systems."""
        for _, disk in self._disks.items():
            self._leave_mount(disk)
            self._unregister(self._disks, disk)

    def _enter_mount(self, disk: OsDisk, mount_point: str) -> None:
        disk.mount_point = mount_point
        if mount_point:
            self._mounts.mount(mount_point, disk.volume, guest=True)

    def _leave_mount(self, disk: OsDisk) -> None:
        point, disk.mount_point = disk.mount_point, None
        if point and self._mounts.volume(point) is disk.volume:
            self._mounts.unmount(point)

    def _check(self, name: str, limit: int) -> None:
        if len(to_bytes(name)) >= limit:
            raise OsalError(OS_FS_ERR_PATH_TOO_LONG, f"{name!r} must have fewer than {limit} characters")

    def _disk(self, devname: str) -> OsDisk:
        for disk in self._disks:
            if disk.name == devname:
                return disk
        raise OsalError(OS_ERR_NAME_NOT_FOUND, f"unknown file system {devname}")

    def _mounted(self, path: str) -> OsDisk:
        self._check(path, OS_MAX_PATH_LEN)
        for disk in self._disks:
            if disk.mount_point and (path == disk.mount_point or path.startswith(disk.mount_point + "/")):
                return disk
        raise OsalError(OS_ERR_NAME_NOT_FOUND, f"no file system is mounted at {path}")
