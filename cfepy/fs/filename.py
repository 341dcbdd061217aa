"""File names as users and commands give them, completed with the default directory and extension of their kind.

It replaces CFE_FS_ParseInputFileName and its relatives. It only handles text and opens no files.
"""

from __future__ import annotations

import re
from enum import IntEnum

from cfepy.reading.texts import from_bytes, to_bytes
from cfepy.status import CFE_FS_BAD_ARGUMENT, CFE_FS_FNAME_TOO_LONG, CFE_FS_INVALID_PATH, CfeError

MAX_PATH_LEN = 64
"""OS_MAX_PATH_LEN and CFE_MISSION_MAX_PATH_LEN, including the NUL."""

NONVOL_MOUNT_POINT = "/cf"
RAM_MOUNT_POINT = "/ram"
MODULE_EXTENSION = ".so"


class FileCategory(IntEnum):
    """The kind of a file, which determines its directory and extension (CFE_FS_FileCategory_t)."""

    UNKNOWN = 0
    DYNAMIC_MODULE = 1
    BINARY_DATA_DUMP = 2
    TEXT_LOG = 3
    SCRIPT = 4
    TEMP = 5


_MOUNT_POINTS: dict[int, str] = {
    FileCategory.DYNAMIC_MODULE: NONVOL_MOUNT_POINT,
    FileCategory.SCRIPT: NONVOL_MOUNT_POINT,
    FileCategory.BINARY_DATA_DUMP: RAM_MOUNT_POINT,
    FileCategory.TEXT_LOG: RAM_MOUNT_POINT,
    FileCategory.TEMP: RAM_MOUNT_POINT,
}
_EXTENSIONS: dict[int, str] = {
    FileCategory.DYNAMIC_MODULE: MODULE_EXTENSION,
    FileCategory.SCRIPT: ".scr",
    FileCategory.TEXT_LOG: ".log",
    FileCategory.TEMP: ".tmp",
}


def get_default_mount_point(category: int) -> str | None:
    """Return the mount point for files of a kind, "/cf" or "/ram"; None for an unknown kind
    (CFE_FS_GetDefaultMountPoint).
    """
    return _MOUNT_POINTS.get(category)


def get_default_extension(category: int) -> str | None:
    """Return the default extension of a kind, with the dot; None if it has none (CFE_FS_GetDefaultExtension)."""
    return _EXTENSIONS.get(category)


def _directory(parts: list[str], default_path: str | None) -> str:
    """Return the path part of a name, with one "/" at its end; runs of "/" count as one."""
    if not parts:
        return (default_path or "").rstrip("/") + "/"
    return re.sub("/+", "/", "/".join([*parts, ""]))


class FileNameError(CfeError):
    """Exception for an invalid file name; `made` is the incomplete result that NASA's code leaves in the buffer."""

    def __init__(self, status: int, text: str, made: str) -> None:
        super().__init__(status, text)
        self.made = made


def parse_input_file_name_ex(
    name: str,
    default_name: str | None = None,
    default_path: str | None = None,
    default_extension: str | None = None,
    max_len: int = MAX_PATH_LEN,
) -> str:
    """Return a complete file name from the input of a user or a command (CFE_FS_ParseInputFileNameEx).

    Args:
        name: the input, up to a NUL.
        default_name: used if the input is empty.
        default_path: directory for a name without any "/".
        default_extension: extension for a name without any "."; a missing or duplicate "." between them is corrected.
        max_len: size of the C buffer for the result, including its NUL.

    Raises:
        FileNameError: CFE_FS_INVALID_PATH if there is no name before the extension, CFE_FS_FNAME_TOO_LONG.
        CfeError: CFE_FS_BAD_ARGUMENT for a `max_len` of 0.
    """
    if max_len <= 0:
        raise CfeError(CFE_FS_BAD_ARGUMENT, "a buffer for a file name must have at least one byte")
    text = (name or default_name or "").partition("\0")[0]
    *parts, last = text.split("/")
    stem, dot, extension = last.partition(".")
    if not dot and default_extension is not None:
        dot, extension = ".", default_extension
    complete = _directory(parts, default_path) + stem + dot + extension.lstrip(".")
    size = len(to_bytes(complete))
    if size >= max_len:
        text = f"{complete!r} must have at most {max_len - 1} characters, not {size}"
        raise FileNameError(CFE_FS_FNAME_TOO_LONG, text, from_bytes(to_bytes(complete)[: max_len - 1]))
    if not stem:
        raise FileNameError(CFE_FS_INVALID_PATH, f"{text!r} has no file name", complete)
    return complete


def parse_input_file_name(name: str, category: int, max_len: int = MAX_PATH_LEN) -> str:
    """As `parse_input_file_name_ex` with the defaults of a kind of file (CFE_FS_ParseInputFileName).

    >>> parse_input_file_name("hk", FileCategory.DYNAMIC_MODULE)
    '/cf/hk.so'
    """
    return parse_input_file_name_ex(
        name, None, get_default_mount_point(category), get_default_extension(category), max_len
    )


def dump_file_name(name: str, default_name: str) -> str:
    """Return the path of a file that a command requests, completed like the names of binary dumps.

    Args:
        name: the name in the command; empty for the default.
        default_name: the default of this kind of file.

    Raises:
        CfeError: see `parse_input_file_name_ex`.
    """
    category = FileCategory.BINARY_DATA_DUMP
    return parse_input_file_name_ex(
        name, default_name, get_default_mount_point(category), get_default_extension(category)
    )


def extract_filename_from_path(path: str) -> str:
    """Return the part after the last "/" (CFE_FS_ExtractFilenameFromPath).

    Raises:
        CfeError: CFE_FS_INVALID_PATH without a "/" beyond the first character, CFE_FS_FNAME_TOO_LONG.
    """
    at = path.rfind("/")
    if len(path) - (at + 1) >= MAX_PATH_LEN:
        raise CfeError(CFE_FS_FNAME_TOO_LONG, f"the file name of {path!r} is too long: {len(path) - at - 1} characters")
    if at <= 0:
        raise CfeError(CFE_FS_INVALID_PATH, f"{path!r} has no directory before the file name")
    return path[at + 1 :]
