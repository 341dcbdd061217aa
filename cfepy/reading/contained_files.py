"""Files that are put below a folder and nowhere else, whatever their names say.

Journals, shipments and missions name files by absolute paths of some computer; each goes to that path below a folder.
Packages of ROS and applications of cFS name files of what is made of them. A name that leaves the folder, by `..` or
through a symbolic link that is already there, is refused.
"""

from __future__ import annotations

import os
import posixpath
import stat
from pathlib import Path

from cfepy.status import UsageError

_LONGEST = 4_096  # bytes of a path, as Linux has it
_FLAGS = os.O_WRONLY | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
_FLAGS |= getattr(os, "O_NONBLOCK", 0)  # a pipe that has the name is not waited for


def is_contained(name: object) -> bool:
    """Whether a name is an absolute path, in its shortest form, which stays below a folder that it is put after."""
    if not isinstance(name, str) or not name.startswith("/") or name.startswith("//") or "\0" in name:
        return False
    try:
        return posixpath.normpath(name) == name and len(os.fsencode(name)) < _LONGEST
    except UnicodeEncodeError:
        return False


def make_folder(root: Path, name: str) -> Path:
    """The folder of a name below a root, made if it is not there.

    Args:
        root: a folder.
        name: an absolute path; "/" is the root itself.

    Raises:
        UsageError: the name leaves the root.
        OSError: it cannot be made.
    """
    path = root
    for path in _ways(root, name):
        path.mkdir(exist_ok=True)
    return path


def place_contained(root: Path, name: str) -> Path:
    """Find where a file of a name is below a root, or would be. Nothing is made.

    Args:
        root: a folder.
        name: an absolute path.

    Returns:
        The path, which is not a symbolic link.

    Raises:
        UsageError: the name leaves the root, or is that of a link or of something else that is not a file.
    """
    *_, path = _ways(root, name if name != "/" else "")
    if path.exists() and not path.is_file():
        raise UsageError(f"names {name!r}, which already exists and is not a file; move it away", file=path)
    return path


def write_contained(root: Path, name: str, data: bytes, mode: int = 0o666) -> None:
    """Put a file below a root; a link of that name is not followed. Errors as `make_folder`.

    Args:
        root: a folder.
        name: an absolute path.
        data: its content.
        mode: its permissions, from which the process's mask is taken.
    """
    path = _place(root, name)
    with open(path, "wb", opener=lambda file, _: os.open(file, _FLAGS, mode)) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise UsageError(f"names {name!r}, which already exists and is not a file; move it away", file=path)
        file.truncate(0)
        file.write(data)


def link_contained(root: Path, name: str) -> None:
    """Let a name below a root stand for the file of this computer that has it. Errors as `make_folder`."""
    path = _place(root, name)
    if os.path.isfile(name):  # a folder would lead out
        path.symlink_to(name)


def _place(root: Path, name: str) -> Path:
    if name == "/":
        raise UsageError("names '/', which is not a file")
    return make_folder(root, posixpath.dirname(name) if is_contained(name) else name) / posixpath.basename(name)


def _ways(root: Path, name: str) -> list[Path]:
    """The folders from a root to what has a name, and that itself; none of them is a symbolic link."""
    if not is_contained(name):
        raise UsageError(f"names {name!r}, which is outside the target folder")
    parts = name.strip("/").split("/") if name != "/" else []
    found = [root.joinpath(*parts[: count + 1]) for count in range(len(parts))]
    for each in found:
        if each.is_symlink():
            text = f"names {name!r}, which leads out of its folder through a symbolic link"
            raise UsageError(text, file=each)
    return found
