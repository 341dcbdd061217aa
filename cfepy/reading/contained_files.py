"""Files that are written below a folder and nowhere else, whatever their names are.

Journals, shipments and missions name files by absolute paths of some computer. Each file goes to that path below a
folder. ROS packages and cFS applications also name the files to be generated. A name that leaves the folder, by `..` or
through an existing symbolic link, is refused.
"""

from __future__ import annotations

import os
import posixpath
import stat
from pathlib import Path

from cfepy.status import UsageError

_LONGEST = 4_096  # bytes of a path, as on Linux
_FLAGS = os.O_WRONLY | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
_FLAGS |= getattr(os, "O_NONBLOCK", 0)  # do not wait for a pipe with that name


def is_contained(name: object) -> bool:
    """Return whether a name is a normalized absolute path that stays below any folder it is appended to."""
    if not isinstance(name, str) or not name.startswith("/") or name.startswith("//") or "\0" in name:
        return False
    try:
        return posixpath.normpath(name) == name and len(os.fsencode(name)) < _LONGEST
    except UnicodeEncodeError:
        return False


def make_folder(root: Path, name: str) -> Path:
    """Return the folder of a name below a root, and create it if it is missing.

    Args:
        root: a folder.
        name: an absolute path; "/" is the root itself.

    Raises:
        UsageError: if the name leaves the root.
        OSError: if it cannot be created.
    """
    path = root
    for path in _ways(root, name):
        path.mkdir(exist_ok=True)
    return path


def place_contained(root: Path, name: str) -> Path:
    """Return the path of a file name below a root, without creating anything.

    Args:
        root: a folder.
        name: an absolute path.

    Returns:
        The path, which is not a symbolic link.

    Raises:
        UsageError: if the name leaves the root, or belongs to a link or to anything else that is not a file.
    """
    *_, path = _ways(root, name if name != "/" else "")
    if path.exists() and not path.is_file():
        raise UsageError(f"names {name!r}, which already exists and is not a file; move it away", file=path)
    return path


def write_contained(root: Path, name: str, data: bytes, mode: int = 0o666) -> None:
    """Write a file below a root without following a link of that name; see `make_folder` for the errors.

    Args:
        root: a folder.
        name: an absolute path.
        data: its content.
        mode: its permissions, reduced by the process's umask.
    """
    path = _place(root, name)
    with open(path, "wb", opener=lambda file, _: os.open(file, _FLAGS, mode)) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise UsageError(f"names {name!r}, which already exists and is not a file; move it away", file=path)
        file.truncate(0)
        file.write(data)


def link_contained(root: Path, name: str) -> None:
    """Link a name below a root to the file of this computer with that name; see `make_folder` for the errors."""
    path = _place(root, name)
    if os.path.isfile(name):  # a link to a folder would lead out of the root
        path.symlink_to(name)


def _place(root: Path, name: str) -> Path:
    if name == "/":
        raise UsageError("names '/', which is not a file")
    return make_folder(root, posixpath.dirname(name) if is_contained(name) else name) / posixpath.basename(name)


def _ways(root: Path, name: str) -> list[Path]:
    """Return the folders from a root to a name, then the named path itself; none of them is a symbolic link."""
    if not is_contained(name):
        raise UsageError(f"names {name!r}, which is outside the target folder")
    parts = name.strip("/").split("/") if name != "/" else []
    found = [root.joinpath(*parts[: count + 1]) for count in range(len(parts))]
    for each in found:
        if each.is_symlink():
            text = f"names {name!r}, which leads out of its folder through a symbolic link"
            raise UsageError(text, file=each)
    return found
