"""File names are completed as in CFE_FS_ParseInputFileNameEx."""

from __future__ import annotations

import pytest

from cfepy import fs, status
from cfepy.fs import FileCategory
from cfepy.status import CfeError


@pytest.mark.parametrize(
    ("name", "path"),
    [
        ("hk", "/cf/hk.so"),
        ("hk.so", "/cf/hk.so"),
        ("hk.bundle", "/cf/hk.bundle"),
        ("hk.a.b", "/cf/hk.a.b"),
        ("hk.", "/cf/hk."),
        ("hk..so", "/cf/hk.so"),
        ("/ram/hk", "/ram/hk.so"),
        ("//ram///hk", "/ram/hk.so"),
        ("/hk", "/hk.so"),
        ("./bad/../name?", "./bad/../name?.so"),
        ("hk\0/x", "/cf/hk.so"),
    ],
)
def test_modules(name: str, path: str) -> None:
    assert fs.parse_input_file_name(name, FileCategory.DYNAMIC_MODULE) == path


@pytest.mark.parametrize(
    ("arguments", "path"),
    [
        (("", "default", "/ram", ".log"), "/ram/default.log"),
        (("x", "default", "/ram/", "log"), "/ram/x.log"),
        (("x", None, None, None), "/x"),
        (("d/x", None, "/ram", None), "d/x"),
    ],
)
def test_explicit_defaults(arguments: tuple[str, str | None, str | None, str | None], path: str) -> None:
    assert fs.parse_input_file_name_ex(*arguments) == path


@pytest.mark.parametrize("name", ["", "/", "/cf/", "/cf/.so", ".."])
def test_empty_name_is_refused(name: str) -> None:
    with pytest.raises(CfeError) as caught:
        fs.parse_input_file_name(name, FileCategory.DYNAMIC_MODULE)
    assert caught.value.status == status.CFE_FS_INVALID_PATH


def test_length() -> None:
    assert len(fs.parse_input_file_name("x" * 56, FileCategory.DYNAMIC_MODULE)) == 63
    with pytest.raises(CfeError, match="CFE_FS_FNAME_TOO_LONG"):
        fs.parse_input_file_name("x" * 57, FileCategory.DYNAMIC_MODULE)
    with pytest.raises(CfeError, match="CFE_FS_BAD_ARGUMENT"):
        fs.parse_input_file_name_ex("x", max_len=0)


def test_defaults_of_each_kind() -> None:
    defaults = {kind: (fs.get_default_mount_point(kind), fs.get_default_extension(kind)) for kind in FileCategory}
    assert defaults == {
        FileCategory.UNKNOWN: (None, None),
        FileCategory.DYNAMIC_MODULE: ("/cf", ".so"),
        FileCategory.BINARY_DATA_DUMP: ("/ram", None),
        FileCategory.TEXT_LOG: ("/ram", ".log"),
        FileCategory.SCRIPT: ("/cf", ".scr"),
        FileCategory.TEMP: ("/ram", ".tmp"),
    }
    assert fs.get_default_extension(99) is None


def test_extract_filename() -> None:
    assert fs.extract_filename_from_path("/cf/apps/hk.so") == "hk.so"
    assert fs.extract_filename_from_path("/cf/") == ""
    for path in ("hk.so", "/hk.so", ""):
        with pytest.raises(CfeError, match="CFE_FS_INVALID_PATH"):
            fs.extract_filename_from_path(path)
    with pytest.raises(CfeError, match="CFE_FS_FNAME_TOO_LONG"):
        fs.extract_filename_from_path("/cf/" + "x" * 64)
