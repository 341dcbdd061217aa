"""What files say of themselves: numbers in the order in which a run first looks at them, and times of the run's clock.

A file of the host is as old as it is there, but never younger than the run, whose clock may stand in 1980. All else
that another computer would answer differently (device, blocks, sizes and links of folders) is the same for all.
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
        self._count = 1

    def made(self, real: os.stat_result, like: os.stat_result | None = None) -> None:
        """The run has a new file of its own; it is a copy of the host's when `like` is given."""
        key, now = key_of(real), self.now_ns()
        if like is not None:
            self._numbers[key] = self._number(key_of(like))
            now = self._of_host(like.st_mtime_ns)
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

    def moved(self, old: Key, new: Key) -> None:
        """A file of the run is another one of the computer's from now on."""
        if old in self._numbers:
            self._numbers[new] = self._numbers.pop(old)
        if old in self._stamps:
            self._stamps[new] = self._stamps.pop(old)

    def dressed(self, real: os.stat_result, own: str | int | None) -> os.stat_result:
        """What the program gets to know of a file.

        Args:
            real: what the computer says.
            own: place or descriptor of a file of the run's own; None for one of the host's.
        """
        is_folder = stat.S_ISDIR(real.st_mode)
        if not (is_folder or stat.S_ISREG(real.st_mode) or stat.S_ISLNK(real.st_mode)):
            return real
        size = BLOCK if is_folder else real.st_size
        times = self._times(real, own)
        number, links = self._number(key_of(real)), 1 if is_folder else real.st_nlink
        plain = (real.st_mode, number, DEVICE, links, real.st_uid, real.st_gid, size)
        more: dict[str, float] = {
            "st_blksize": BLOCK,
            "st_blocks": -(-size // BLOCK) * (BLOCK // _SECTOR),
            "st_rdev": 0,
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
