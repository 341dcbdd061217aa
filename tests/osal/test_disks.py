"""OS_mkfs, OS_mount and their kin."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.osal import FileSystem, Volume
from cfepy.status import (
    OS_ERR_INCORRECT_OBJ_STATE,
    OS_ERR_NAME_NOT_FOUND,
    OS_ERR_NAME_TAKEN,
    OS_ERROR,
    OS_FS_ERR_DEVICE_NOT_FREE,
    OS_FS_ERR_PATH_INVALID,
    OS_FS_ERR_PATH_TOO_LONG,
)
from tests.osal.helpers import Bench
from tests.osal.test_queues import status_of


def test_the_life_of_a_ram_disk(bench: Bench) -> None:
    os = bench.os
    os.mkfs("/ramdev1", "RAM1", 512, 4)
    os.mount("/ramdev1", "/scratch")
    os.files.write_file("/scratch/x", bytes(600))
    assert os.file_sys_stat_volume("/scratch") == (512, 4, 2)
    assert status_of(os.files.write_file, "/scratch/y", bytes(1500)) == OS_ERROR
    assert status_of(os.rmfs, "/ramdev1") == OS_ERR_INCORRECT_OBJ_STATE
    os.chkfs("/scratch")
    os.unmount("/scratch")
    assert status_of(os.files.read_file, "/scratch/x") == OS_FS_ERR_PATH_INVALID
    os.mount("/ramdev1", "/again")
    assert len(os.files.read_file("/again/x")) == 600
    os.unmount("/again")
    os.rmfs("/ramdev1")
    assert status_of(os.mount, "/ramdev1", "/again") == OS_ERR_NAME_NOT_FOUND


def test_the_disks_that_are_there_from_the_start(tmp_path: Path) -> None:
    bench = Bench(files=FileSystem(tmp_path))
    os = bench.os
    assert os.fs_get_phys_drive_name("/cf") == str(tmp_path)
    assert os.translate_path("/cf/sub/x.tbl") == f"{tmp_path}/sub/x.tbl"
    assert os.translate_path("/ram/x") == "RAM:/ramdev0/x"
    assert os.file_sys_stat_volume("/ram/any") == (512, 4096, 4096)
    assert os.file_sys_stat_volume("/cf").blocks_free == 0xFFFFFFFF
    assert os.get_fs_info() == (50, 50, 14, 12)


@pytest.mark.parametrize(
    ("devname", "volname", "status"),
    [
        ("", "RAM", OS_FS_ERR_PATH_INVALID),
        ("/dev", "", OS_FS_ERR_PATH_INVALID),
        ("/" + "d" * 31, "RAM", OS_FS_ERR_PATH_TOO_LONG),
        ("/dev", "R" * 32, OS_FS_ERR_PATH_TOO_LONG),
        ("/ramdev0", "RAM", OS_ERR_NAME_TAKEN),
    ],
)
def test_bad_names(bench: Bench, devname: str, volname: str, status: int) -> None:
    assert status_of(bench.os.mkfs, devname, volname, 512, 4) == status


def test_there_are_14_file_systems(bench: Bench) -> None:
    for number in range(12):
        bench.os.initfs(f"/a_name_of_over_20_chars_{number}", "RAM", 512, 1)
    assert status_of(bench.os.mkfs, "/one_more", "RAM", 512, 1) == OS_FS_ERR_DEVICE_NOT_FREE


def test_mounting_twice(bench: Bench) -> None:
    bench.os.mkfs("/ramdev1", "RAM1", 512, 4)
    assert status_of(bench.os.mount, "/ramdev1", "/ram") == OS_ERR_NAME_NOT_FOUND
    assert status_of(bench.os.mount, "/ramdev0", "/other") == OS_ERR_NAME_NOT_FOUND
    assert status_of(bench.os.unmount, "/nowhere") == OS_ERR_NAME_NOT_FOUND
    assert status_of(bench.os.chkfs, "/nowhere") == OS_ERR_NAME_NOT_FOUND


def test_a_fixed_map(bench: Bench, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(b"host")
    bench.os.file_sys_add_fixed_map(Volume(tmp_path), "/data")
    assert bench.os.files.read_file("/data/x") == b"host"
    assert status_of(bench.os.file_sys_add_fixed_map, Volume(), "/data") == OS_ERR_NAME_TAKEN
