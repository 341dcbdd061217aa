"""Metadata of files: inode numbers in the order in which a run first looks at files, and times of the run's clock.

A host file has its real age, but is never younger than the run, whose clock may start in 1980. Everything else that
depends on the computer or user (owner, device, blocks, sizes of folders, link counts of host files) is the same for
all. Permissions of the run's files are kept here; on the disk they are always accessible to cfepy. For a host file the
owner's permissions count and the others follow from them, because the umask of its creator should not matter.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable
from dataclasses import dataclass

from cfepy.units import NS_PER_S

LISTED = "cfepy.listing"  # raised as Python audit event for each folder that a node lists, with its entries,
ASKED = "cfepy.look"  # for the first look at each host path,
NEEDED = "cfepy.folder"  # for each folder that must exist because something is written into it,
MADE = "cfepy.files"  # and for the folder that contains the run's own files
DEVICE = 1
BLOCK = 4096
USER = GROUP = 1000
"""Owner of all files: the user of all programs of a run."""
UMASK = 0o022
_LINK_MODE = 0o777
_SECTOR = 512
_MARK_NS = NS_PER_S  # real time of a file that has not been written since it was looked at

Key = tuple[int, int]
"""Device and number of a real file."""


@dataclass(slots=True)
class Stamp:
    """Times of a file of the run, in ns since 1970; `is_told`: they are those of the latest change."""

    read_ns: int
    written_ns: int
    changed_ns: int
    is_told: bool = True


class Stamps:
    """Numbers and times of one run's files.

    Args:
        now_ns: time of day of the run, ns since 1970.
    """

    def __init__(self, now_ns: Callable[[], int]) -> None:
        self.now_ns = now_ns
        self._start_ns = now_ns()
        self._numbers: dict[Key, int] = {}
        self._stamps: dict[Key, Stamp] = {}
        self._modes: dict[Key, int] = {}
        self._count = 1

    def made(self, real: os.stat_result, like: os.stat_result | None = None, mode: int | None = None) -> None:
        """Register a new file of the run.

        Args:
            real: its metadata on the host.
            like: the host file it is a copy of.
            mode: its permissions, if the run gave them.
        """
        key, now = key_of(real), self.now_ns()
        if like is not None:
            self._numbers[key] = self._number(key_of(like))
            now = self._of_host(like.st_mtime_ns)
            mode = self.mode(like)
        if mode is not None:
            self._modes[key] = mode & ~UMASK if like is None else mode
        self._stamps[key] = Stamp(now, now, now)

    def written(self, key: Key) -> None:
        """Something was written into a file of the run, or into a folder."""
        stamp = self._stamps.get(key)
        if stamp is not None:
            stamp.written_ns = stamp.changed_ns = self.now_ns()
            stamp.is_told = True

    def changed(self, real: os.stat_result, times: tuple[int, int] | None = None) -> None:
        """Record a change of a file's metadata, with its access and modification times if given (ns)."""
        stamp = self._stamps.get(key_of(real))
        if stamp is not None:
            stamp.changed_ns = self.now_ns()
            if times is not None:
                stamp.read_ns, stamp.written_ns = times
                stamp.is_told = True

    def forget(self, real: os.stat_result) -> None:
        """Record that a name of a file is removed; after the last one the system may reuse its number."""
        if real.st_nlink <= 1 or stat.S_ISDIR(real.st_mode):
            self._numbers.pop(key_of(real), None)
            self._stamps.pop(key_of(real), None)
            self._modes.pop(key_of(real), None)

    def moved(self, old: Key, new: Key) -> None:
        """Record that a file of the run is now a different file on the host."""
        if old in self._numbers:
            self._numbers[new] = self._numbers.pop(old)
        if old in self._stamps:
            self._stamps[new] = self._stamps.pop(old)
        if old in self._modes:
            self._modes[new] = self._modes.pop(old)

    def mode(self, real: os.stat_result) -> int:
        """Return the permissions of a file."""
        if stat.S_ISLNK(real.st_mode):
            return _LINK_MODE
        mode = self._modes.get(key_of(real))
        if mode is None:
            owner = real.st_mode >> 6 & 0o7
            mode = owner * 0o111 & ~UMASK
        return mode

    def set_mode(self, real: os.stat_result, mode: int) -> None:
        """Set the permissions of a file."""
        self._modes[key_of(real)] = stat.S_IMODE(mode)
        self.changed(real)

    def dressed(self, real: os.stat_result, own: str | int | None) -> os.stat_result:
        """Return the metadata of a file as the program sees it.

        Args:
            real: its metadata on the host.
            own: place or descriptor of the run's own file; None for a host file.
        """
        is_folder = stat.S_ISDIR(real.st_mode)
        size = BLOCK if is_folder else real.st_size
        is_device = stat.S_ISCHR(real.st_mode) or stat.S_ISBLK(real.st_mode)
        mode = stat.S_IFMT(real.st_mode) | (stat.S_IMODE(real.st_mode) if is_device else self.mode(real))
        times = self._times(real, own)
        number, links = self._number(key_of(real)), 1 if is_folder or own is None else real.st_nlink
        plain = (mode, number, DEVICE, links, USER, GROUP, size)
        more: dict[str, float] = {
            "st_blksize": BLOCK,
            "st_blocks": -(-size // BLOCK) * (BLOCK // _SECTOR),
            "st_rdev": getattr(real, "st_rdev", 0) if is_device else 0,
        }
        for name, value in zip(("st_atime", "st_mtime", "st_ctime"), times, strict=True):
            more |= {name: value / NS_PER_S, f"{name}_ns": value}
        return os.stat_result((*plain, *(value // NS_PER_S for value in times)), more)

    def _times(self, real: os.stat_result, own: str | int | None) -> tuple[int, int, int]:
        if own is None:
            written = self._of_host(real.st_mtime_ns)
            return written, written, written
        stamp = self._stamps.get(key_of(real))
        if stamp is None:  # made by C code, such as SQLite's
            self.made(real)
            stamp = self._stamps[key_of(real)]
        if stat.S_ISREG(real.st_mode) and real.st_mtime_ns != _MARK_NS:
            if not stamp.is_told:  # written by C code since it was last looked at
                stamp.written_ns = stamp.changed_ns = self.now_ns()
            stamp.is_told = False
            os.utime(own, ns=(_MARK_NS, _MARK_NS))
        return stamp.read_ns, stamp.written_ns, stamp.changed_ns

    def _of_host(self, time_ns: int) -> int:
        return min(time_ns, self._start_ns)

    def _number(self, key: Key) -> int:
        number = self._numbers.get(key)
        if number is None:
            self._count += 1
            self._numbers[key] = number = self._count
        return number


def key_of(real: os.stat_result) -> Key:
    """Return the identity of a real file."""
    return real.st_dev, real.st_ino


def asked_by(flags: int) -> int:
    """Return the access that the flags of `os.open` need."""
    writes = flags & (os.O_WRONLY | os.O_RDWR | os.O_TRUNC)
    reads = not flags & os.O_WRONLY
    return (os.R_OK if reads else 0) | (os.W_OK if writes else 0)


def is_special(place: str) -> bool:
    """Return whether a place is something other than a file, folder or link."""
    try:
        mode = os.stat(place).st_mode
    except OSError:
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode) or stat.S_ISLNK(mode))


def copy_tree(old: str, new: str, stamps: Stamps) -> None:
    """Copy the files of a run to another folder, for a run that continues in a forked process."""
    from shutil import copy2

    links: dict[tuple[int, int], str] = {}
    for folder, folders, names in os.walk(old):
        inside = new + folder.removeprefix(old)
        for name in (*folders, *names):
            source, target = os.path.join(folder, name), os.path.join(inside, name)
            real = os.lstat(source)
            if stat.S_ISDIR(real.st_mode):
                os.mkdir(target)
                os.chmod(target, stat.S_IMODE(real.st_mode))
            elif key_of(real) in links:
                os.link(links[key_of(real)], target)
                continue
            else:
                copy2(source, target, follow_symlinks=False)
                links[key_of(real)] = target
            stamps.moved(key_of(real), key_of(os.lstat(target)))
