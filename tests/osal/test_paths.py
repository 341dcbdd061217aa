"""OSAL's functions on files by path, and on directories."""

from __future__ import annotations

import pytest

from cfepy.osal.limits import (
    OS_FILE_FLAG_CREATE,
    OS_FILE_FLAG_TRUNCATE,
    OS_FILESTAT_MODE_READ,
    OS_FILESTAT_MODE_WRITE,
    OS_READ_ONLY,
    OS_READ_WRITE,
    OS_WRITE_ONLY,
)
from cfepy.status import (
    OS_ERR_INVALID_ID,
    OS_ERR_NO_FREE_IDS,
    OS_ERROR,
    OS_FS_ERR_NAME_TOO_LONG,
    OS_FS_ERR_PATH_INVALID,
    OS_FS_ERR_PATH_TOO_LONG,
)
from tests.osal.helpers import Bench
from tests.osal.test_queues import status_of

S = 1_000_000_000


def test_stat() -> None:
    bench = Bench(epoch_ns=1000 * S)
    os = bench.os
    os.mkdir("/ram/d")
    os.files.write_file("/cf/old", b"12345")
    bench.run(lambda: (os.task_delay(2500), os.files.write_file("/ram/x", b"123", bench.kernel.now)))
    file, folder = os.stat("/ram/x"), os.stat("/ram/d")
    assert (os.filestat_size(file), os.filestat_time(file), file.file_time) == (3, 1002, 10_025_000_000)
    assert os.filestat_mode(file) == OS_FILESTAT_MODE_READ | OS_FILESTAT_MODE_WRITE
    assert [os.filestat_read(file), os.filestat_write(file), os.filestat_exec(file)] == [True, True, False]
    assert [os.filestat_isdir(file), os.filestat_isdir(folder), os.filestat_exec(folder)] == [False, True, True]
    assert os.filestat_time(os.stat("/cf/old")) == 1000
    assert status_of(os.stat, "/ram/none") == OS_ERROR


@pytest.mark.parametrize(
    ("mode", "readable", "writable"),
    [(OS_READ_ONLY, True, False), (OS_WRITE_ONLY, False, True), (OS_READ_WRITE, True, True)],
)
def test_chmod(bench: Bench, mode: int, readable: bool, writable: bool) -> None:
    os = bench.os
    os.files.write_file("/ram/x", b"content")
    writer = os.open_create("/ram/x", 0, OS_READ_WRITE)
    os.chmod("/ram/x", mode)
    stats = os.stat("/ram/x")
    assert (os.filestat_read(stats), os.filestat_write(stats)) == (readable, writable)
    for access, allowed in ((OS_READ_ONLY, readable), (OS_WRITE_ONLY, writable), (OS_READ_WRITE, mode == 2)):
        if allowed:
            os.close(os.open_create("/ram/x", 0, access))
        else:
            assert status_of(os.open_create, "/ram/x", 0, access) == OS_ERROR
    if not writable:
        assert status_of(os.open_create, "/ram/x", OS_FILE_FLAG_TRUNCATE, OS_READ_ONLY) == OS_ERROR
        assert status_of(os.cp, "/ram/x", "/ram/x") == OS_ERROR
    os.write(writer, b"C")
    assert os.files.read_file("/ram/x") == b"Content"


def test_chmod_of_an_inaccessible_file_fails(bench: Bench) -> None:
    bench.os.files.write_file("/ram/x", b"")
    bench.os.chmod("/ram/x", 77)
    assert status_of(bench.os.chmod, "/ram/x", OS_READ_WRITE) == OS_ERROR
    assert status_of(bench.os.chmod, "/ram/none", OS_READ_WRITE) == OS_ERROR
    bench.os.chmod("/ram", OS_READ_WRITE)
    assert status_of(bench.os.chmod, "x", OS_READ_WRITE) == OS_FS_ERR_PATH_INVALID


@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("/ram/" + "d/" * 30, OS_FS_ERR_PATH_TOO_LONG),
        ("/ram/" + "n" * 20, OS_FS_ERR_NAME_TOO_LONG),
        ("tmpDir", OS_FS_ERR_PATH_INVALID),
    ],
)
def test_bad_paths(bench: Bench, path: str, status: int) -> None:
    os = bench.os
    os.files.write_file("/ram/x", b"content")
    for function in (os.stat, os.remove, os.mkdir, os.rmdir, os.directory_open):
        assert status_of(function, path) == status
    for function in (os.rename, os.cp, os.mv):
        assert status_of(function, "/ram/x", path) == status
        assert status_of(function, path, "/ram/x") == status
    assert status_of(os.open_create, path, OS_FILE_FLAG_CREATE, OS_WRITE_ONLY) == status


def test_remove_deletes_an_empty_folder_like_c(bench: Bench) -> None:
    """As C's remove() under NASA's OSAL does."""
    bench.os.mkdir("/cf/folder")
    bench.os.files.write_file("/cf/folder/a.txt", b"a")
    assert status_of(bench.os.remove, "/cf/folder") == OS_ERROR
    bench.os.remove("/cf/folder/a.txt")
    bench.os.remove("/cf/folder")
    assert status_of(bench.os.remove, "/cf/folder") == OS_ERROR
    bench.os.remove("/cf")
    assert status_of(bench.os.mkdir, "/cf/folder") == OS_ERROR
    bench.os.mkdir("/cf")
    bench.os.mkdir("/cf/folder")


@pytest.mark.parametrize("new", ["/cf/nowhere/a.txt", "/cf/folder"])
def test_rename_to_a_folder_or_a_missing_folder_is_refused(bench: Bench, new: str) -> None:
    """As on NASA's cFE."""
    bench.os.files.write_file("/cf/a.txt", b"a")
    bench.os.mkdir("/cf/folder")
    assert status_of(bench.os.rename, "/cf/a.txt", new) == OS_ERROR
    assert status_of(bench.os.mv, "/cf/a.txt", new) == OS_ERROR
    assert bench.os.files.read_file("/cf/a.txt") == b"a"


def test_missing_file_cannot_be_renamed_copied_or_moved(bench: Bench) -> None:
    os = bench.os
    os.files.write_file("/ram/x", b"content")
    os.rename("/ram/x", "/ram/y")
    for function in (os.rename, os.cp, os.mv):
        assert status_of(function, "/ram/x", "/ram/y") == OS_ERROR
    assert os.files.read_file("/ram/y") == b"content"


def test_copy_and_move_between_volumes(bench: Bench) -> None:
    os = bench.os
    os.files.write_file("/ram/x", b"content")
    os.cp("/ram/x", "/cf/y")
    os.mv("/cf/y", "/ram/z")
    assert os.files.read_file("/ram/z") == b"content"
    assert not os.files.exists("/cf/y")
    os.mv("/ram/z", "/ram/w")
    os.remove("/ram/w")
    assert status_of(os.remove, "/ram/w") == OS_ERROR


@pytest.mark.parametrize("path", ["/ram/x", "/ram/./x", "/ram//x"])
def test_copy_onto_itself_empties_the_file(bench: Bench, path: str) -> None:
    bench.os.files.write_file("/ram/x", b"content")
    bench.os.mv("/ram/x", path)
    assert bench.os.files.read_file("/ram/x") == b"content"
    bench.os.cp("/ram/x", path)
    assert bench.os.files.read_file("/ram/x") == b""


def test_copying_takes_two_descriptors(bench: Bench) -> None:
    bench.os.files.write_file("/ram/x", b"content")
    opened = [bench.os.open_create("/ram/x") for _ in range(bench.os.config.os_max_num_open_files)]
    for _ in range(2):
        assert status_of(bench.os.cp, "/ram/x", "/ram/y") == OS_ERR_NO_FREE_IDS
        assert not bench.os.files.exists("/ram/y")
        bench.os.close(opened.pop())
    bench.os.cp("/ram/x", "/ram/y")


@pytest.mark.parametrize("path", ["/ram/x/", "/ram/x/.", "/ram/x//"])
def test_file_with_a_slash_behind_it_does_not_exist(bench: Bench, path: str) -> None:
    os = bench.os
    os.files.write_file("/ram/x", b"content")
    for function in (os.stat, os.remove, os.open_create, os.chmod, os.directory_open, os.rmdir):
        arguments = (path, 2) if function == os.chmod else (path,)
        assert status_of(function, *arguments) == OS_ERROR
    for pair in ((path, "/ram/y"), ("/ram/x", path), ("/ram/x", "/ram/y/")):
        for function in (os.rename, os.cp, os.mv):
            assert status_of(function, *pair) == OS_ERROR
    assert status_of(os.open_create, "/ram/y/", OS_FILE_FLAG_CREATE, OS_WRITE_ONLY) == OS_ERROR
    assert os.files.list_dir("/ram") == ["x"]
    os.mkdir("/ram/d/")
    os.rename("/ram/d/", "/ram/e/")
    os.rmdir("/ram/e/")


def test_directories(bench: Bench) -> None:
    os = bench.os
    os.mkdir("/ram/d")
    for name in ("b", "a"):
        os.files.write_file(f"/ram/d/{name}", b"")
    dir_id = os.directory_open("/ram/d")
    names = [os.directory_read(dir_id) for _ in range(3)]
    os.directory_rewind(dir_id)
    assert [*names, os.directory_read(dir_id)] == ["a", "b", None, "a"]
    os.directory_close(dir_id)
    assert status_of(os.directory_read, dir_id) == OS_ERR_INVALID_ID
    assert status_of(os.directory_open, "/ram/none") == OS_ERROR
    assert status_of(os.rmdir, "/ram/d") == OS_ERROR


def test_directory_is_listed_at_the_first_read_and_after_a_rewind(bench: Bench) -> None:
    """It is read again after a rewind, as with the C library under NASA's OSAL. FM's listing names itself."""
    os = bench.os
    os.mkdir("/ram/d")
    dir_id = os.directory_open("/ram/d")
    os.files.write_file("/ram/d/a", b"")
    assert os.directory_read(dir_id) == "a"
    os.files.write_file("/ram/d/b", b"")
    assert os.directory_read(dir_id) is None
    os.directory_rewind(dir_id)
    assert [os.directory_read(dir_id) for _ in range(3)] == ["a", "b", None]


def test_directory_removed_while_open_has_no_entries(bench: Bench) -> None:
    os = bench.os
    os.mkdir("/ram/d")
    dir_id = os.directory_open("/ram/d")
    os.rmdir("/ram/d")
    assert os.directory_read(dir_id) is None


def test_there_are_4_open_directories(bench: Bench) -> None:
    for _ in range(bench.os.config.os_max_num_open_dirs):
        bench.os.directory_open("/ram")
    assert status_of(bench.os.directory_open, "/ram") == OS_ERR_NO_FREE_IDS
