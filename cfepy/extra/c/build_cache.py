"""The folder that keeps cfepy's built files from one run to the next: the engine, C headers, ROS nodes in C++.

`CFEPY_CACHE` names it. Without that it is `cfepy` in the user's cache folder. If that cannot be written (a container's
user often has no home), it is a folder of the user's below the one for temporary files. cfepy loads machine code from
this folder, so a fallback folder that another user could write is refused.
"""

from __future__ import annotations

import errno
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple, Self

from cfepy.status import UsageError

VARIABLE = "CFEPY_CACHE"
MOST_BYTES = 4 << 30
"""How large a folder of the cache becomes before entries that were not used for long are removed."""
KEPT_BYTES = 2 << 30
"""How large it is afterwards."""
KEPT_S = 86_400.0
"""How long an entry stays after its last use, in seconds: other processes may be using it."""
_ADVICE = f"set {VARIABLE} to a writable folder with free space"


def cache_folder() -> Path:
    """Make the cache folder if it does not exist.

    Returns:
        Its path.

    Raises:
        UsageError: it cannot be made, or is not safe to use.
    """
    named = os.environ.get(VARIABLE)
    if named:
        folder = Path(named)
        with writing_cache(folder):
            folder.mkdir(parents=True, exist_ok=True)
        return folder
    try:
        folder = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "cfepy"
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        return _fallback(f"{folder} cannot be made: {error.strerror}")
    except RuntimeError:  # of Path.home
        return _fallback("this user has no home folder")
    return folder if os.access(folder, os.W_OK | os.X_OK) else _fallback(f"{folder} cannot be written")


@contextmanager
def writing_cache(folder: Path) -> Iterator[None]:
    """Turn an OSError of the block that concerns the cache into a UsageError that names the path and the variable.

    Args:
        folder: the cache folder, or the one below it that the block writes.
    """
    try:
        yield
    except OSError as error:
        at = folder if error.filename is None else Path(os.fsdecode(error.filename))  # a full disk names no file
        if not (at.is_relative_to(folder) or folder.is_relative_to(at)):
            raise
        raise UsageError(f"cannot be written: {error.strerror or error}; {_ADVICE}", file=at) from None


def mark_used(*entries: Path) -> None:
    """Note that files or folders of the cache are used now, so that they stay in it.

    Args:
        entries: their paths; those that are missing are left out.
    """
    for each in entries:
        with suppress(OSError):
            os.utime(each)


def remove_unused(folder: Path) -> None:
    """Remove the entries with the oldest use, if a folder of the cache has grown above `MOST_BYTES`.

    Args:
        folder: the folder, whose files and folders are each one entry. One of them was used just now.
    """
    entries = sorted(_Entry.of(each) for each in folder.iterdir())
    size = sum(each.size for each in entries)
    if size <= MOST_BYTES:
        return
    for entry in entries:
        if size <= KEPT_BYTES or entry.used_s > entries[-1].used_s - KEPT_S:
            break
        if entry.path.is_dir():
            shutil.rmtree(entry.path, ignore_errors=True)
        else:
            with suppress(OSError):
                entry.path.unlink()
        size -= entry.size


class _Entry(NamedTuple):
    """A file or folder of the cache: when it was used last, in seconds since 1970, and its bytes."""

    used_s: float
    size: int
    path: Path

    @classmethod
    def of(cls, path: Path) -> Self:
        """Look at a file or folder. One that another process has removed is empty."""
        used_s, size = 0.0, 0
        with suppress(OSError):
            used_s = path.lstat().st_mtime
            inside = [path] if path.is_file() else path.rglob("*")
            size = sum(each.lstat().st_size for each in inside)
        return cls(used_s, size, path)


def _fallback(reason: str) -> Path:
    """Make the folder below the one for temporary files, and report it on standard error when it is new."""
    owner = os.getuid() if hasattr(os, "getuid") else 0
    folder = Path(tempfile.gettempdir()) / f"cfepy-cache-{owner}"
    try:
        folder.mkdir(mode=0o700)
    except FileExistsError:
        _check_owned(folder, owner)
    except OSError as error:
        text = f"cannot be made: {error.strerror} (and {reason}); {_ADVICE}"
        raise UsageError(text, file=folder) from None
    else:
        text = f"{reason}; cfepy keeps built files in {folder} (set {VARIABLE} for another folder)"
        print(f"cfepy: {text}", file=sys.stderr, flush=True)
    return folder


def _check_owned(folder: Path, owner: int) -> None:
    """Check that an existing fallback folder can be written only by its owner, who is this user.

    Raises:
        UsageError: it is not, for example because it is a link of another user's.
    """
    found = folder.lstat()
    theirs = hasattr(os, "getuid") and (found.st_uid != owner or found.st_mode & 0o022)
    if not stat.S_ISDIR(found.st_mode) or theirs:
        raise UsageError(f"must be a folder that only you can write; {_ADVICE}", file=folder)
    if not os.access(folder, os.W_OK | os.X_OK):
        raise UsageError(f"cannot be written: {os.strerror(errno.EACCES)}; {_ADVICE}", file=folder)
