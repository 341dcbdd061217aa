"""OS_mkfs, OS_mount, OS_TranslatePath and related functions: file systems for C."""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.osal_values import BAD
from cfepy.osal import OS_MAX_LOCAL_PATH_LEN
from cfepy.reading.texts import to_bytes
from cfepy.status import OS_FS_ERR_PATH_TOO_LONG, OsalError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

VOLUME_STAT = Struct("<QQQ")
"""OS_statvfs_t: bytes of a block, blocks, free blocks."""
FILE_SYSTEM_INFO = Struct("<IIII")
"""os_fsinfo_t: most and free descriptors, most and free volumes."""
PHYSICAL_NAME = 64
"""Characters of a drive's name, with a NUL (OS_FS_PHYS_NAME_LEN)."""


def declare(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def make(address: int, device: str, volume: str, block_size: int, blocks: int) -> None:
        os.mkfs(device, volume, block_size, blocks, in_memory=bool(address))

    def init(address: int, device: str, volume: str, block_size: int, blocks: int) -> None:
        os.initfs(device, volume, block_size, blocks, in_memory=bool(address))

    def add_fixed_map(physical: str, virtual: str) -> int:
        if len(to_bytes(physical)) >= OS_MAX_LOCAL_PATH_LEN:
            raise OsalError(OS_FS_ERR_PATH_TOO_LONG, "the physical path is too long")
        return os.file_sys_add_fixed_map(physical, virtual)

    def stat_volume(path: str, at: int) -> None:
        memory.poke(at, VOLUME_STAT.pack(*os.file_sys_stat_volume(path)))

    def drive_name(name: int, path: str) -> None:
        memory.put_text(name, os.fs_get_phys_drive_name(path), PHYSICAL_NAME)

    def translate(virtual: str, local: int) -> None:
        path = os.translate_path(virtual)
        if len(to_bytes(path)) >= OS_MAX_LOCAL_PATH_LEN:
            raise OsalError(OS_FS_ERR_PATH_TOO_LONG, f"{path} is too long")
        memory.poke(local, to_bytes(path) + b"\0")

    def get_info(at: int) -> None:
        memory.poke(at, FILE_SYSTEM_INFO.pack(*os.get_fs_info()))

    api.add("OS_mkfs", "pSSQQ", make, BAD)
    api.add("OS_initfs", "pSSQQ", init, BAD)
    api.add("OS_rmfs", "S", os.rmfs, BAD)
    api.add("OS_mount", "SS", os.mount, BAD)
    api.add("OS_unmount", "S", os.unmount, BAD)
    api.add("OS_FileSysAddFixedMap", "4SS", add_fixed_map, BAD)
    api.add("OS_FileSysStatVolume", "SP", stat_volume, BAD)
    api.add("OS_chkfs", "Sb", os.chkfs, BAD)
    api.add("OS_FS_GetPhysDriveName", "PS", drive_name, BAD)
    api.add("OS_TranslatePath", "SP", translate, BAD)
    api.add("OS_GetFsInfo", "P", get_info, BAD)
