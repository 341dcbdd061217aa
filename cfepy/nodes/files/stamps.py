"""What files say of themselves: numbers in the order in which a run first looks at them, and times of the run's clock.

A file of the host is as old as it is there, but never younger than the run, whose clock may stand in 1980. All else
that another computer or user would have otherwise (owner, device, blocks, sizes of folders, links of what is not the
run's own) is the same for all. Permissions are kept here for files of the run, which lie on the disk such that cfepy
can work with them; of a file of the host those of its owner count, and the others' follow from them, as the umask of
who made it is no matter.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable
from dataclasses import dataclass

from cfepy.units import NS_PER_S

LISTED = "cfepy.listing"  # Python's audit hooks are told of each folder that a node looks into, and what is in it,
ASKED = "cfepy.look"  # of each path of the host at which it looks for something, once,
NEEDED = "cfepy.folder"  # of each folder that must be there, since something is written into it,
MADE = "cfepy.files"  # and of the folder in which a run has its own files
DEVICE = 1
BLOCK = 4096
USER = GROUP = 1000
"""The owner of all files: the user that all programs of a run are."""
UMASK = 0o022
_LINK_MODE = 0o777
_SECTOR = 512
_MARK_NS = NS_PER_S  # the real time of a file that nobody has written into since it was looked at

Key = tuple[int, int]
"""Device and number of a real file."""


@dataclass(slots=True)
class Stamp:
    """The times of a file of the run, in ns since 1970; `is_told`: they are those of the latest change."""

    read_ns: int
    written_ns: int
    changed_ns: int
    is_told: bool = True


class Stamps:
    """Numbers and times of one run's files.

    Args:
        now_ns: the run's time of day, ns since 1970.
    """

    def __init__(self, now_ns: Callable[[], int]) -> None:
        self.now_ns = now_ns
        self._start_ns = now_ns()
        self._numbers: dict[Key, int] = {}
        self._stamps: dict[Key, Stamp] = {}
        self._modes: dict[Key, int] = {}
        self._count = 1

    def made(self, real: os.stat_result, like: os.stat_result | None = None, mode: int | None = None) -> None:
        """The run has a new file of its own.

        Args:
            real: what the computer says of it.
            like: it is a copy of this one of the host.
            mode: its permissions, if the run said them.
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
        """What a file of the run says of itself was changed, its times of reading and writing perhaps (ns)."""
        stamp = self._stamps.get(key_of(real))
        if stamp is not None:
            stamp.changed_ns = self.now_ns()
            if times is not None:
                stamp.read_ns, stamp.written_ns = times
                stamp.is_told = True

    def forget(self, real: os.stat_result) -> None:
        """A name of a file of the run is gone; after the last one the system may give its number to another."""
        if real.st_nlink <= 1 or stat.S_ISDIR(real.st_mode):
            self._numbers.pop(key_of(real), None)
            self._stamps.pop(key_of(real), None)
            self._modes.pop(key_of(real), None)

    def moved(self, old: Key, new: Key) -> None:
        """A file of the run is another one of the computer's from now on."""
        if old in self._numbers:
            self._numbers[new] = self._numbers.pop(old)
        if old in self._stamps:
            self._stamps[new] = self._stamps.pop(old)
        if old in self._modes:
            self._modes[new] = self._modes.pop(old)

    def mode(self, real: os.stat_result) -> int:
        """The permissions of a file."""
        if stat.S_ISLNK(real.st_mode):
            return _LINK_MODE
        mode = self._modes.get(key_of(real))
        if mode is None:
            owner = real.st_mode >> 6 & 0o7
            mode = owner * 0o111 & ~UMASK
        return mode

    def set_mode(self, real: os.stat_result, mode: int) -> None:
        """The program gives a file other permissions."""
        self._modes[key_of(real)] = stat.S_IMODE(mode)
        self.changed(real)

    def dressed(self, real: os.stat_result, own: str | int | None) -> os.stat_result:
        """What the program gets to know of a file.

        Args:
            real: what the computer says.
            own: place or descriptor of a file of the run's own; None for one of the host's.
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
            if not stamp.is_told:  # written by C code since it was looked at
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
    """What tells a real file from others."""
    return real.st_dev, real.st_ino


def asked_by(flags: int) -> int:
    """What of a file is asked for by the flags of `os.open`."""
    writes = flags & (os.O_WRONLY | os.O_RDWR | os.O_TRUNC)
    reads = not flags & os.O_WRONLY
    return (os.R_OK if reads else 0) | (os.W_OK if writes else 0)


def is_special(place: str) -> bool:
    """Whether at a place is something else than a file, a folder or a link."""
    try:
        mode = os.stat(place).st_mode
    except OSError:
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode) or stat.S_ISLNK(mode))


def copy_tree(old: str, new: str, stamps: Stamps) -> None:
    """Copy what a run wrote to another folder, for one that goes on in a forked process."""
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
