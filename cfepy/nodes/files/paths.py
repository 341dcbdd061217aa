"""Paths of a run's files: their parts, where they lie below the run's folder, and, on Windows, their drives.

Between parts is "/", which Windows takes as well. A path begins with it, or there with a drive: C:/a/b, which lies at
TOP/C/a/b below the folder TOP of a run.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Container

HAS_DRIVES = os.name == "nt"


def with_slashes(path: str) -> str:
    """The path of Windows with "/" between its parts."""
    return path.replace("\\", "/")


def parted(path: str) -> tuple[str, str]:
    """The drive of a path of Windows, and the rest, which begins with "/"."""
    plain = with_slashes(path)
    drive, colon, rest = plain.partition(":")
    return (f"{drive}:", rest) if colon and len(drive) == 1 else ("", plain)


def place_below(top: str, path: str) -> str:
    """Where a path of Windows lies below a folder."""
    drive, rest = parted(path)
    return f"{top}/{drive[:1]}{rest}"


def path_below(top: str, place: str) -> str:
    """The path of Windows that lies at a place; one outside of the folder stays as it is."""
    plain = with_slashes(place)
    if not plain.startswith(f"{top}/"):
        return place
    drive, slash, rest = plain.removeprefix(f"{top}/").partition("/")
    return f"{drive}:{slash}{rest}" if len(drive) == 1 else f"/{drive}{slash}{rest}"


def with_end(done: str) -> str:
    """The path of a folder of which all parts are known; a root has a "/" at its end."""
    return done if "/" in done else f"{done}/"


def parent(path: str) -> str:
    """The folder that a path is in."""
    return with_end(path.rpartition("/")[0])


def is_root(path: str) -> bool:
    """Whether it is a root, such as / or C:/."""
    return path.endswith("/")


def below_root(root: str, absent: Container[str] = ()) -> Callable[[str], str]:
    """The places of the host's files, some of which are below a folder that stands for the computer's root.

    Args:
        root: the folder; empty for none.
        absent: paths at which nothing is to be found.
    """
    if not root:
        return lambda path: path
    return lambda path: root + path if path in absent or os.path.lexists(root + path) else path


def place_of(descriptor: int) -> str:
    """Where an open file lies; empty where the system does not tell."""
    try:
        return os.readlink(f"/proc/self/fd/{descriptor}")
    except OSError:
        return ""


def is_in(path: str, folder: str) -> bool:
    """Whether a path is a folder, or one of what is in it."""
    return path == folder or path.startswith(folder + "/")


def os_error(number: int, path: str) -> OSError:
    """The error of the system about a path."""
    return OSError(number, os.strerror(number), path)
