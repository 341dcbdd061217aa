"""Facts about paths that a run checked without opening them: existence, kind, size, age.

A program that only checks whether a file exists gets the same answer in a replay, where the file may be missing or
newly created.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from cfepy.reading.contained_files import make_folder, write_contained

ABSENT, REGULAR, FOLDER, LINK, OTHER = KINDS = ("absent", "file", "folder", "link", "other")
MOST_LOOKS = 100_000  # maximum number in a journal
_LARGEST = 1 << 40  # largest size in bytes of a file that is created; it takes no space on the disk


@dataclass(frozen=True, slots=True)
class PathLook:
    """State of a path when a run first checked it.

    Attributes:
        path: absolute path, with links resolved except in the last part.
        kind: one of `KINDS`; "other" is a pipe, a device or the like.
        size: size of a file in bytes.
        mode: permissions of a file or folder.
        time_ns: time of the last change of its contents, ns since 1970.
        target: target of a link, as written in it.
    """

    path: str
    kind: str
    size: int = 0
    mode: int = 0
    time_ns: int = 0
    target: str = ""


def look_at(path: str) -> PathLook:
    """Return the current state of a path."""
    try:
        found = os.lstat(path)
        target = os.readlink(path) if stat.S_ISLNK(found.st_mode) else ""
    except (OSError, ValueError):
        return PathLook(path, ABSENT)
    if target:
        return PathLook(path, LINK, target=target)
    mode, time_ns = stat.S_IMODE(found.st_mode), max(0, found.st_mtime_ns)
    if stat.S_ISREG(found.st_mode):
        return PathLook(path, REGULAR, found.st_size, mode, time_ns)
    return PathLook(path, FOLDER if stat.S_ISDIR(found.st_mode) else OTHER, 0, mode, time_ns)


def put_in_place(root: Path, looks: Iterable[PathLook]) -> frozenset[str]:
    """Create files, folders and links below a root that look like those that a run checked.

    Existing files keep their contents, because they were opened too. Other kinds, such as devices, are left out.

    Args:
        root: folder that replaces the root of the computer.
        looks: states of the checked paths.

    Returns:
        The paths at which there was nothing.

    Raises:
        UsageError: if a path leaves the root.
        OSError: if something cannot be created.
    """
    found = sorted(looks, key=lambda look: look.path)
    for look in found:
        if look.kind == FOLDER:
            make_folder(root, look.path)
    for look in found:
        if look.kind == REGULAR and not os.path.lexists(f"{root}{look.path}"):
            write_contained(root, look.path, b"")
            os.truncate(f"{root}{look.path}", min(look.size, _LARGEST))
    for look in found:
        if look.kind == LINK and not os.path.lexists(f"{root}{look.path}"):
            place = make_folder(root, os.path.dirname(look.path)) / os.path.basename(look.path)
            place.symlink_to(look.target)
    for look in reversed(found):  # contents of a folder before the folder, which may become read-only
        _dress(root, look)
    return frozenset(look.path for look in found if look.kind == ABSENT and not os.path.lexists(f"{root}{look.path}"))


def _dress(root: Path, look: PathLook) -> None:
    """Set the permissions and time of a file or folder; its owner can always read it here."""
    place = f"{root}{look.path}"
    if look.kind not in (REGULAR, FOLDER) or look.path == "/" or os.path.islink(place):
        return
    with suppress(OverflowError):
        os.utime(place, ns=(look.time_ns, look.time_ns))
    os.chmod(place, stat.S_IMODE(look.mode) | (stat.S_IRUSR if look.kind == REGULAR else stat.S_IRUSR | stat.S_IXUSR))
