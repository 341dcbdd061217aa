"""Paths of a run's files: their parts, their places below the run's folder, and Windows drives.

The separator is "/", which Windows accepts too. A path starts with it, or on Windows with a drive: C:/a/b is stored at
TOP/C/a/b below the folder TOP of a run.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Container

HAS_DRIVES = os.name == "nt"


def with_slashes(path: str) -> str:
    """Return the path of Windows with "/" between its parts."""
    return path.replace("\\", "/")


def parted(path: str) -> tuple[str, str]:
    """Return the drive of a Windows path, and the rest, which starts with "/"."""
    plain = with_slashes(path)
    drive, colon, rest = plain.partition(":")
    return (f"{drive}:", rest) if colon and len(drive) == 1 else ("", plain)


def place_below(top: str, path: str) -> str:
    """Return the place of a Windows path below a folder."""
    drive, rest = parted(path)
    return f"{top}/{drive[:1]}{rest}"


def path_below(top: str, place: str) -> str:
    """Return the Windows path that is stored at a place; a place outside of the folder stays as it is."""
    plain = with_slashes(place)
    if not plain.startswith(f"{top}/"):
        return place
    drive, slash, rest = plain.removeprefix(f"{top}/").partition("/")
    return f"{drive}:{slash}{rest}" if len(drive) == 1 else f"/{drive}{slash}{rest}"


def with_end(done: str) -> str:
    """Return the path of a folder from all of its parts; a root ends with "/"."""
    return done if "/" in done else f"{done}/"


def parent(path: str) -> str:
    """Return the folder that a path is in."""
    return with_end(path.rpartition("/")[0])


def is_root(path: str) -> bool:
    """Return whether it is a root, such as / or C:/."""
    return path.endswith("/")


def below_root(root: str, absent: Container[str] = ()) -> Callable[[str], str]:
    """Return a function for the places of host files, with some of them below a folder that replaces the root.

    Args:
        root: the folder; empty for none.
        absent: paths at which nothing is found.
    """
    if not root:
        return lambda path: path
    return lambda path: root + path if path in absent or os.path.lexists(root + path) else path


def place_of(descriptor: int) -> str:
    """Return the place of an open file; empty if the system does not tell."""
    try:
        return os.readlink(f"/proc/self/fd/{descriptor}")
    except OSError:
        return ""


def is_in(path: str, folder: str) -> bool:
    """Return whether a path is a folder, or inside it."""
    return path == folder or path.startswith(folder + "/")


def os_error(number: int, path: str) -> OSError:
    """Return the error of the system about a path."""
    return OSError(number, os.strerror(number), path)
