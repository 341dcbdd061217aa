"""Files that are put below a folder and nowhere else, whatever their names say.

Journals, shipments and missions name files by absolute paths of some computer; each goes to that path below a folder.
A name that leaves the folder, by `..` or through a symbolic link, is refused.
"""

from __future__ import annotations

import os
import posixpath
from pathlib import Path

from cfepy.status import UsageError

_LONGEST = 4_096  # bytes of a path, as Linux has it


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
    if not is_contained(name):
        raise UsageError(f"names {name!r}, which does not stay in the folder that its files are put into")
    path = root
    for part in name.strip("/").split("/") if name != "/" else ():
        path = path / part
        if path.is_symlink():
            raise UsageError(f"names {name!r}, which leads through a symbolic link and out of its folder")
        path.mkdir(exist_ok=True)
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
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
    with open(path, "wb", opener=lambda file, _: os.open(file, flags, mode)) as file:
        file.write(data)


def link_contained(root: Path, name: str) -> None:
    """Let a name below a root stand for the file of this computer that has it. Errors as `make_folder`."""
    path = _place(root, name)
    if os.path.isfile(name):  # a folder would lead out
        path.symlink_to(name)


def _place(root: Path, name: str) -> Path:
    if name == "/":
        raise UsageError("names '/', which is no file")
    return make_folder(root, posixpath.dirname(name) if is_contained(name) else name) / posixpath.basename(name)
