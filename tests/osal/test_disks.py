"""OS_mkfs, OS_mount and their kin."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.osal import FileSystem
from cfepy.osal.limits import OS_FILE_FLAG_CREATE, OS_READ_WRITE
from cfepy.status import (
    OS_ERR_NAME_NOT_FOUND,
    OS_ERR_NAME_TAKEN,
    OS_ERR_NOT_IMPLEMENTED,
    OS_ERROR,
    OS_FS_ERR_DEVICE_NOT_FREE,
    OS_FS_ERR_DRIVE_NOT_CREATED,
    OS_FS_ERR_PATH_INVALID,
    OS_FS_ERR_PATH_TOO_LONG,
)
from tests.osal.helpers import Bench, Ledger
from tests.osal.test_queues import status_of


def test_the_life_of_a_ram_disk(bench: Bench) -> None:
    os = bench.os
    os.mkfs("/ramdev1", "RAM1", 512, 4)
    os.mount("/ramdev1", "/scratch")
    os.files.write_file("/scratch/x", bytes(600))
    assert os.file_sys_stat_volume("/scratch") == (512, 4, 2)
    assert status_of(os.files.write_file, "/scratch/y", bytes(1500)) == OS_ERROR
    assert status_of(os.chkfs, "/scratch") == OS_ERR_NOT_IMPLEMENTED
    os.unmount("/scratch")
    assert status_of(os.files.read_file, "/scratch/x") == OS_FS_ERR_PATH_INVALID
    os.mount("/ramdev1", "/again")
    assert len(os.files.read_file("/again/x")) == 600
    os.unmount("/again")
    os.rmfs("/ramdev1")
    assert status_of(os.mount, "/ramdev1", "/again") == OS_ERR_NAME_NOT_FOUND


def test_initial_disks_exist(tmp_path: Path) -> None:
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
def test_invalid_names_are_refused(bench: Bench, devname: str, volname: str, status: int) -> None:
    assert status_of(bench.os.mkfs, devname, volname, 512, 4) == status


def test_number_of_file_systems_is_limited_to_14(bench: Bench) -> None:
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
    bench.os.file_sys_add_fixed_map(str(tmp_path), "/data")
    assert bench.os.files.read_file("/data/x") == b"host"
    bench.os.files.write_file("/data/x", b"flight")
    assert (tmp_path / "x").read_bytes() == b"host"
    assert bench.os.fs_get_phys_drive_name("/data") == str(tmp_path)
    add = bench.os.file_sys_add_fixed_map
    assert status_of(add, tmp_path, "/data") == OS_ERR_NAME_TAKEN
    assert status_of(add, tmp_path, "/" + "d" * 63) == OS_FS_ERR_PATH_TOO_LONG
    assert status_of(add, "", "/without_a_folder") == OS_FS_ERR_DRIVE_NOT_CREATED
    add(tmp_path / "nothing", "/a_path/of_more_than/the_32_characters/of_a_device")
    assert bench.os.files.list_dir("/a_path/of_more_than/the_32_characters/of_a_device") == []
    bench.os.unmount("/data")
    assert not bench.os.files.exists("/data/x")


def test_relative_path_of_a_fixed_map_begins_at_the_folder_of_the_mission(tmp_path: Path) -> None:
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "x").write_bytes(b"x")
    os = Bench(files=FileSystem(tmp_path)).os
    os.file_sys_add_fixed_map("./more", "/more")
    assert os.files.read_file("/more/x") == b"x"
    assert os.fs_get_phys_drive_name("/more") == "./more"


def test_disk_may_be_removed_while_it_is_mounted(bench: Bench) -> None:
    bench.os.mkfs("/ramdev1", "RAM1", 512, 4)
    bench.os.mount("/ramdev1", "/scratch")
    bench.os.rmfs("/ramdev1")
    assert not bench.os.files.exists("/scratch")
    bench.os.mkfs("/ramdev1", "RAM1", 512, 4)
    bench.os.mount("/ramdev1", "/scratch")


def test_mount_requires_a_ram_disk(bench: Bench) -> None:
    bench.os.mkfs("/ssrdev0", "SSR1", 512, 4)
    assert status_of(bench.os.mount, "/ssrdev0", "/ssr") == OS_ERR_NAME_NOT_FOUND


@pytest.mark.parametrize(
    ("point", "reached", "missed"),
    [("scratch", None, "/scratch/f"), ("/x/", "/x//f", "/x/f"), ("/", "//f", "/f"), ("", None, "/f")],
)
def test_disk_is_mounted_at_any_text_but_reached_only_through_it(
    bench: Bench, tmp_path: Path, point: str, reached: str | None, missed: str
) -> None:
    os = bench.os
    os.mkfs("/ramdev1", "RAM1", 512, 4)
    os.mount("/ramdev1", point)
    assert status_of(os.mount, "/ramdev1", "/again") == OS_ERR_NAME_NOT_FOUND
    assert status_of(os.open_create, missed, OS_FILE_FLAG_CREATE, OS_READ_WRITE) == OS_FS_ERR_PATH_INVALID
    if reached is not None:
        os.close(os.open_create(reached, OS_FILE_FLAG_CREATE, OS_READ_WRITE))
    if point:
        os.unmount(point)
    else:
        assert status_of(os.unmount, point) == OS_ERR_NAME_NOT_FOUND
    os.rmfs("/ramdev1")
    os.file_sys_add_fixed_map(tmp_path, point)
    assert status_of(os.file_sys_add_fixed_map, tmp_path, point) == OS_ERR_NAME_TAKEN


def test_fixed_map_at_the_place_of_a_mounted_disk_is_not_reached(bench: Bench, tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(b"host")
    bench.os.file_sys_add_fixed_map(tmp_path, "/ram")
    assert not bench.os.files.exists("/ram/x")
    bench.os.rmfs("/ram")
    bench.os.files.write_file("/ram/x", b"disk")
    assert bench.os.files.read_file("/ram/x") == b"disk"


def test_disk_in_memory_can_be_mounted_with_any_name(bench: Bench) -> None:
    bench.os.mkfs("/ssrdev1", "SSR1", 512, 4, in_memory=True)
    bench.os.initfs("/ssrdev2", "SSR2", 512, 4, in_memory=True)
    bench.os.mount("/ssrdev1", "/ssr")
    bench.os.mount("/ssrdev2", "/ssr2")


@pytest.mark.parametrize(
    "function", ["rmfs", "unmount", "chkfs", "file_sys_stat_volume", "fs_get_phys_drive_name", "translate_path"]
)
def test_long_names(bench: Bench, function: str) -> None:
    assert status_of(getattr(bench.os, function), "/" + "n" * 63) == OS_FS_ERR_PATH_TOO_LONG
    assert status_of(bench.os.mount, "/ramdev0", "/" + "n" * 63) == OS_FS_ERR_PATH_TOO_LONG


def test_format_of_the_disk_of_the_board_empties_it(bench: Bench) -> None:
    os = bench.os
    os.files.write_file("/ram/x", bytes(512))
    assert os.file_sys_stat_volume("/ram").blocks_free == 4095
    os.unmount("/ram")
    os.rmfs("/ramdev0")
    os.mkfs("/ramdev0", "RAM", 512, 4096)
    os.mount("/ramdev0", "/ram")
    assert os.files.list_dir("/ram") == []
    assert os.file_sys_stat_volume("/ram").blocks_free == 4096


def test_disks_count_against_the_memory_except_for_the_disks_of_the_board() -> None:
    ledger = Ledger(free=3000)
    bench = Bench(memory=ledger)
    bench.os.mkfs("/ramdev1", "RAM1", 512, 4)
    assert ledger.free == 3000 - 2048
    bench.os.unmount("/ram")
    bench.os.rmfs("/ramdev0")
    bench.os.mkfs("/ramdev0", "RAM", 512, 4096)
    assert ledger.free == 3000 - 2048
    bench.os.rmfs("/ramdev1")
    assert ledger.free == 3000


def test_reset_keeps_disks_of_the_board_and_removes_others() -> None:
    files = FileSystem()
    first = Bench(files=files).os
    first.mkfs("/ramdev1", "RAM1", 512, 4)
    first.mount("/ramdev1", "/guest")
    first.unmount("/ram")
    first.rmfs("/ramdev0")
    first.mkfs("/ramdev0", "RAM", 512, 4096)
    first.mount("/ramdev0", "/ram")
    files.write_file("/ram/x", b"kept")
    files.write_file("/cf/x", b"kept")
    second = Bench(files=files).os
    assert files.mount_points() == ["/cf", "/ram"]
    assert (files.read_file("/ram/x"), files.read_file("/cf/x")) == (b"kept", b"kept")
    second.unmount("/ram")
    second.mkfs("/ramdev1", "RAM1", 512, 4)
    Bench(files=files)
    assert files.read_file("/ram/x") == b"kept"
