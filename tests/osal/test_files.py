"""The virtual file system, and OSAL's functions on open files."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.osal import FileSystem, Volume
from cfepy.osal.limits import (
    OS_FILE_FLAG_CREATE,
    OS_FILE_FLAG_TRUNCATE,
    OS_READ_ONLY,
    OS_READ_WRITE,
    OS_SEEK_CUR,
    OS_SEEK_END,
    OS_SEEK_SET,
    OS_WRITE_ONLY,
)
from cfepy.status import (
    OS_ERR_INVALID_ID,
    OS_ERR_INVALID_SIZE,
    OS_ERR_NAME_NOT_FOUND,
    OS_ERR_NO_FREE_IDS,
    OS_ERR_OUTPUT_TOO_LARGE,
    OS_ERROR,
    OS_FS_ERR_NAME_TOO_LONG,
    OS_FS_ERR_PATH_INVALID,
    OS_FS_ERR_PATH_TOO_LONG,
)
from tests.osal.helpers import Bench
from tests.osal.test_queues import status_of


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A mission's folder with two files."""
    (tmp_path / "a.tbl").write_bytes(b"table")
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "b.txt").write_bytes(b"text")
    return tmp_path


@pytest.fixture
def files(folder: Path) -> FileSystem:
    """Return a file system whose /cf is that folder."""
    return FileSystem(folder, ram_bytes=1000)


@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("/ram/" + "d/" * 30, OS_FS_ERR_PATH_TOO_LONG),
        ("/ram/" + "n" * 20, OS_FS_ERR_NAME_TOO_LONG),
        ("ram/" + "n" * 20, OS_FS_ERR_NAME_TOO_LONG),
        ("ram/x", OS_FS_ERR_PATH_INVALID),
        ("x", OS_FS_ERR_PATH_INVALID),
        ("", OS_FS_ERR_PATH_INVALID),
        ("/ram/../cf/x", OS_FS_ERR_PATH_INVALID),
        ("/nowhere/x", OS_FS_ERR_PATH_INVALID),
        ("/ramdisk/x", OS_FS_ERR_PATH_INVALID),
        ("/", OS_FS_ERR_PATH_INVALID),
    ],
)
def test_invalid_paths_are_refused(files: FileSystem, path: str, status: int) -> None:
    assert status_of(files.translate, path) == status
    assert status_of(files.read_file, path) == status
    assert not files.exists(path)


def test_folder_of_the_mission_is_readable_and_never_written(files: FileSystem, folder: Path) -> None:
    assert files.read_file("/cf/a.tbl") == b"table"
    assert files.read_file("/cf/sub/b.txt") == b"text"
    files.write_file("/cf/a.tbl", b"changed")
    files.write_file("/cf/new", b"new")
    files.remove("/cf/sub/b.txt")
    assert files.read_file("/cf/a.tbl") == b"changed"
    assert files.list_dir("/cf") == ["a.tbl", "new", "sub"]
    assert files.list_dir("/cf/sub") == []
    assert sorted(path.name for path in folder.rglob("*")) == ["a.tbl", "b.txt", "sub"]
    assert (folder / "a.tbl").read_bytes() == b"table"


def test_host_file_changed_during_a_run_does_not_change_the_run(files: FileSystem, folder: Path) -> None:
    assert files.read_file("/cf/a.tbl") == b"table"
    (folder / "a.tbl").write_bytes(b"edited meanwhile")
    assert files.read_file("/cf/a.tbl") == b"table"


def test_missing_files_and_folders(files: FileSystem) -> None:
    for call in (files.read_file, files.remove, files.list_dir, files.remove_folder):
        assert status_of(call, "/ram/none") == OS_ERROR
    assert status_of(files.write_file, "/ram/none/x", b"") == OS_ERROR
    assert status_of(files.write_file, "/ram", b"") == OS_ERROR
    assert status_of(files.make_folder, "/ram/none/x") == OS_ERROR
    assert status_of(files.rename, "/ram/none", "/ram/x") == OS_ERROR


def test_folders(files: FileSystem) -> None:
    files.make_folder("/ram/logs")
    files.write_file("/ram/logs/one", b"1")
    assert files.list_dir("/ram") == ["logs"]
    assert files.list_dir("/ram/logs") == ["one"]
    assert status_of(files.remove_folder, "/ram/logs") == OS_ERROR
    files.remove("/ram/logs/one")
    files.remove_folder("/ram/logs")
    assert not files.exists("/ram/logs")
    files.remove_folder("/ram")  # NASA's code also removes the folder of the disk
    assert status_of(files.write_file, "/ram/x", b"") == OS_ERROR
    files.forget_guests()
    assert files.list_dir("/ram") == []


def test_folder_is_renamed_with_its_contents(files: FileSystem) -> None:
    for folder in ("/ram/logs", "/ram/logs/old", "/ram/empty", "/ram/full"):
        files.make_folder(folder)
    files.write_file("/ram/logs/one", b"1")
    files.write_file("/ram/logs/old/two", b"2")
    files.write_file("/ram/full/x", b"")
    for old, new in (("logs", "full"), ("logs", "full/x"), ("logs", "logs/new"), ("logs", "none/new"), ("logs", "")):
        assert status_of(files.rename, f"/ram/{old}", f"/ram/{new}") == OS_ERROR
    assert status_of(files.rename, "/ram", "/ram/new") == OS_ERROR
    files.rename("/ram/logs", "/ram/empty")
    assert files.list_dir("/ram") == ["empty", "full"]
    assert files.list_dir("/ram/empty") == ["old", "one"]
    assert files.read_file("/ram/empty/old/two") == b"2"


def test_folder_of_the_host_is_renamed_only_in_the_run(files: FileSystem, folder: Path) -> None:
    (folder / "tables").mkdir()
    (folder / "tables" / "x.tbl").write_bytes(b"x")
    files.rename("/cf/tables", "/cf/old")
    assert not files.exists("/cf/tables/x.tbl")
    assert files.read_file("/cf/old/x.tbl") == b"x"
    files.rename("/cf/old", "/cf/tables")
    assert files.list_dir("/cf/tables") == ["x.tbl"]
    assert (folder / "tables" / "x.tbl").exists()


def test_write_to_a_disk_that_is_nearly_full_is_short(bench: Bench) -> None:
    os = bench.os
    os.files.mount("/d", Volume(capacity=10))
    filedes = os.open_create("/d/x", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    assert os.write(filedes, b"123456") == 6
    assert os.write(filedes, b"7890ab") == 4
    assert status_of(os.write, filedes, b"x") == OS_ERROR
    assert os.lseek(filedes, 0, OS_SEEK_CUR) == 10
    os.files.write_file("/ram/y", bytes(2000))
    assert status_of(os.cp, "/ram/y", "/d/x") == OS_ERROR
    assert os.stat("/d/x").file_size == 10
    os.file_truncate(filedes, 0)
    os.lseek(filedes, 7, OS_SEEK_SET)
    assert os.write(filedes, b"abcdef") == 3
    assert os.files.read_file("/d/x") == bytes(7) + b"abc"


def test_removed_file_takes_room_until_it_is_closed(bench: Bench) -> None:
    os = bench.os
    os.files.mount("/d", Volume(capacity=10))
    filedes = os.open_create("/d/x", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    os.write(filedes, bytes(10))
    os.remove("/d/x")
    other = os.open_create("/d/y", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    assert status_of(os.write, other, b"x") == OS_ERROR
    os.close(filedes)
    assert os.write(other, b"x") == 1


def test_file_does_not_grow_beyond_the_memory_of_the_host(bench: Bench) -> None:
    os = bench.os
    filedes = os.open_create("/cf/x", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    os.lseek(filedes, 1 << 40, OS_SEEK_SET)
    assert status_of(os.write, filedes, b"x") == OS_ERROR
    assert os.lseek(filedes, 0, OS_SEEK_END) == 0, "a write that fails leaves the file as long as it was"
    assert status_of(os.file_truncate, filedes, 1 << 40) == OS_ERR_OUTPUT_TOO_LARGE
    assert status_of(os.lseek, filedes, (1 << 63) - 1, OS_SEEK_CUR) == OS_ERROR


@pytest.mark.parametrize(("folder", "last"), [("/cf", 17_592_186_040_320), ("/ram", (1 << 63) - 1)])
def test_last_position_in_a_file_is_that_of_its_disk_on_linux(bench: Bench, folder: str, last: int) -> None:
    os = bench.os
    filedes = os.open_create(f"{folder}/x", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    for whence in (OS_SEEK_SET, OS_SEEK_CUR, OS_SEEK_END):
        os.lseek(filedes, 0, OS_SEEK_SET)
        assert status_of(os.lseek, filedes, last + 1, whence) == OS_ERROR
        assert os.lseek(filedes, last, whence) == last
    assert status_of(os.write, filedes, b"x") == OS_ERROR


def test_a_full_disk_refuses(files: FileSystem) -> None:
    files.write_file("/ram/a", bytes(900))
    assert status_of(files.write_file, "/ram/b", bytes(200)) == OS_ERROR
    files.write_file("/ram/a", bytes(1000))


def test_mount_and_unmount(files: FileSystem) -> None:
    volume = Volume()
    files.mount("/data", volume)
    files.write_file("/data/x", b"kept")
    assert files.mount_points() == ["/cf", "/data", "/ram"]
    assert files.unmount("/data") is volume
    assert status_of(files.read_file, "/data/x") == OS_FS_ERR_PATH_INVALID
    assert status_of(files.unmount, "/data") == OS_ERR_NAME_NOT_FOUND
    files.mount("/data", volume)
    assert files.read_file("/data/x") == b"kept"
    files.volume("/data").clear()
    assert files.list_dir("/data") == []


def test_read_write_and_seek(bench: Bench) -> None:
    os = bench.os
    filedes = os.open_create("/ram/log", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    assert os.write(filedes, b"hello world") == 11
    assert os.lseek(filedes, -5, OS_SEEK_END) == 6
    assert os.read(filedes, 100) == b"world"
    assert os.read(filedes, 100) == b""
    assert os.lseek(filedes, 0, OS_SEEK_SET) == 0
    assert os.write(filedes, b"J") == 1
    assert os.lseek(filedes, 3, OS_SEEK_CUR) == 4
    assert os.read(filedes, 1) == b"o"
    assert os.lseek(filedes, 15, OS_SEEK_SET) == 15
    os.write(filedes, b"!")
    os.close(filedes)
    assert os.files.read_file("/ram/log") == b"Jello world\0\0\0\0!"


def test_modes_and_flags(bench: Bench) -> None:
    os = bench.os
    os.files.write_file("/ram/x", b"content")
    reader = os.open_create("/ram/x")
    writer = os.open_create("/ram/x", 0, OS_WRITE_ONLY)
    assert status_of(os.write, reader, b"x") == OS_ERROR
    assert status_of(os.read, writer, 1) == OS_ERROR
    assert status_of(os.read, reader, 0) == OS_ERR_INVALID_SIZE
    assert status_of(os.write, writer, b"") == OS_ERR_INVALID_SIZE
    assert status_of(os.lseek, reader, -1, OS_SEEK_SET) == OS_ERROR
    assert status_of(os.lseek, reader, 0, 9) == OS_ERROR
    assert status_of(os.open_create, "/ram/x", 0, 7) == OS_ERROR
    assert status_of(os.open_create, "/ram/none", 0, OS_READ_ONLY) == OS_ERROR
    os.close(os.open_create("/ram/x", OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY))
    assert os.read(reader, 10) == b""
    os.close(reader)
    assert status_of(os.close, reader) == OS_ERR_INVALID_ID


def test_descriptors_by_name(bench: Bench) -> None:
    os = bench.os
    os.files.write_file("/ram/x", b"content")
    filedes = os.open_create("/ram/x")
    os.open_create("/ram/x")
    assert os.file_open_check("/ram/x")
    assert os.fd_get_info(filedes) == ("/ram/x", 0, True)
    os.rename("/ram/x", "/ram/y")
    assert os.fd_get_info(filedes).path == "/ram/y"
    os.close_file_by_name("/ram/y")
    assert not os.file_open_check("/ram/y")
    assert status_of(os.close_file_by_name, "/ram/y") == OS_FS_ERR_PATH_INVALID
    os.files.write_file("/ram/y", b"")
    for _ in range(os.config.os_max_num_open_files):
        os.open_create("/ram/y")
    assert status_of(os.open_create, "/ram/y") == OS_ERR_NO_FREE_IDS
    os.close_all_files()
    assert not os.file_open_check("/ram/y")


def test_truncate_and_allocate(bench: Bench) -> None:
    os = bench.os
    filedes = os.open_create("/ram/x", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    os.write(filedes, b"123456")
    os.file_truncate(filedes, 3)
    os.file_allocate(filedes, 2, 3)
    os.file_allocate(filedes, 0, 1)
    assert os.files.read_file("/ram/x") == b"123\0\0"
    os.file_truncate(filedes, 7)
    assert os.files.read_file("/ram/x") == b"123\0\0\0\0"
    reader = os.open_create("/ram/x")
    for call, arguments, status in (
        (os.file_truncate, (filedes, -1), OS_ERROR),
        (os.file_truncate, (reader, 0), OS_ERROR),
        (os.file_truncate, (filedes, 1 << 30), OS_ERR_OUTPUT_TOO_LARGE),
        (os.file_truncate, (0, 1), OS_ERR_INVALID_ID),
        (os.file_allocate, (0, 0, 1), OS_ERR_INVALID_ID),
    ):
        assert status_of(call, *arguments) == status
    for place, length in ((-1, 5), (0, 0), (0, 1 << 30)):  # NASA's Linux never reports these
        os.file_allocate(filedes, place, length)
    os.file_allocate(reader, 0, 9)
    assert os.files.read_file("/ram/x") == b"123\0\0\0\0"


def test_file_beyond_the_limit_is_neither_created_nor_emptied(bench: Bench) -> None:
    os = bench.os
    os.files.write_file("/ram/x", b"content")
    for _ in range(os.config.os_max_num_open_files):
        os.open_create("/ram/x")
    flags = OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE
    assert status_of(os.open_create, "/ram/x", flags, OS_WRITE_ONLY) == OS_ERR_NO_FREE_IDS
    assert status_of(os.open_create, "/ram/y", flags, OS_WRITE_ONLY) == OS_ERR_NO_FREE_IDS
    assert status_of(os.open_create, "y", flags, OS_WRITE_ONLY) == OS_FS_ERR_PATH_INVALID
    assert os.files.list_dir("/ram") == ["x"]
    assert os.files.read_file("/ram/x") == b"content"
