"""`Overlay`: the files that the programs of one run see: the host's, and over them what the run wrote.

What a run writes lies in a temporary folder of its own, at its path below that; a file of the host that is changed is
copied there first. What it removes is only noted. So descriptors are real ones, and code in C that is given one, or a
place, works as ever. The folder is made when it is first needed and goes with the mission.

Paths here are absolute and as programs have them, unless they are called places: where a file really lies.
"""

from __future__ import annotations

import errno
import os
import stat
import sys
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from weakref import WeakSet, finalize

from cfepy.interpreter.host_system import before_end, in_forked_process
from cfepy.nodes.files.paths import (
    HAS_DRIVES,
    is_in,
    is_root,
    os_error,
    parent,
    parted,
    path_below,
    place_below,
    place_of,
    with_end,
    with_slashes,
)
from cfepy.nodes.files.stamps import ASKED, LISTED, MADE, NEEDED, Stamps, asked_by, copy_tree, is_special, key_of

PREFIX = "cfepy-files-"  # of the folders that runs have in the temporary one
_SYSTEM = ("/proc", "/sys", "/dev")  # no files, but questions to the operating system
_SHM = "/dev/shm"
_MOST_LINKS = 40
_OWNER_S = 6  # bits from the owner's permissions to those of access()
_CREATES = os.O_CREAT | os.O_TRUNC | getattr(os, "O_TMPFILE", 0)
_TMPFILE = getattr(os, "O_TMPFILE", -1)


class Overlay:
    """The files of one run.

    Args:
        now_ns: the run's time of day, ns since 1970.
        host: the place of a file of the host; that of a replay has the recorded files elsewhere.

    Attributes:
        stamps: numbers and times of files.
    """

    def __init__(self, now_ns: Callable[[], int] = lambda: 0, host: Callable[[str], str] = lambda path: path) -> None:
        self.stamps = Stamps(now_ns)
        self._place_of_host = host
        self._asked: set[str] = set()  # paths of the host that were looked at
        self._top = ""
        self._gone: set[str] = set()  # what of the host does not show through, with all below it
        self._no_links: set[str] = set()  # folders of which this is known, and that they may be searched
        self._descriptors: dict[int, str] = {}  # places of what was opened last
        self._remove: Callable[[], object] = bool
        _living().add(self)

    # -- where things are --------------------------------------------------------------------------------------------

    def real(self, path: str, follow: bool = True) -> str:
        """A path without links, of the last part too if it is to be followed; what is not there has none.

        Raises:
            OSError: the links go round in circles, or what ".." is said of is no folder.
        """
        if self.is_system(path):
            return path
        drive, path = parted(path) if HAS_DRIVES else ("", path)
        parts, done, links = deque(path.split("/")), drive, 0
        while parts:
            part = parts.popleft()
            if part in ("", "."):
                continue
            if part == "..":
                self.check_folder(with_end(done))
                done = done.rpartition("/")[0] or drive
                continue
            here = f"{done}/{part}"
            target = self._target(here) if parts or follow else None
            if target is None:
                if parts and here not in self._no_links:
                    self._refuse_search(here, path, any(parts))
                done = here
                continue
            links += 1
            if links > _MOST_LINKS:
                raise os_error(errno.ELOOP, path)
            if HAS_DRIVES:
                other, target = parted(target)
                drive = other or drive
            parts.extendleft(reversed(target.split("/")))
            done = drive if target.startswith("/") else done
        return with_end(done)

    def _refuse_search(self, here: str, path: str, is_searched: bool) -> None:
        """Raise the OSError of a path that goes on behind what is no folder, or is one that must not be searched."""
        if not self.is_folder(here):
            if self.exists(here):
                raise os_error(errno.ENOTDIR, path)
        elif is_searched and not self.allows(here, os.X_OK):
            raise os_error(errno.EACCES, path)

    def _target(self, path: str) -> str | None:
        if path in self._no_links:
            return None
        try:
            return os.readlink(self.place(path))
        except OSError:
            if self.is_folder(path) and self.allows(path, os.X_OK):
                self._no_links.add(path)
            return None

    def allows(self, path: str, bits: int) -> bool:
        """Whether the program may do something with what is at a path without links.

        It is the owner of all files, and no root, whoever runs cfepy. What the host does not let cfepy read, it may not
        read either; what it writes, it writes into a copy.

        Args:
            path: of the file.
            bits: `os.R_OK`, `os.W_OK`, `os.X_OK`.
        """
        place, own = self.place(path), self.own_place(path)
        if self.is_system(path):
            return os.access(place, bits)
        try:
            mode = self.stamps.mode(os.lstat(place))
        except OSError:
            return False
        seen = bits & (os.R_OK | os.X_OK)
        return mode >> _OWNER_S & bits == bits and (own is not None or not seen or os.access(place, seen))

    def _check(self, path: str, bits: int, told: str | None = None) -> None:
        """Raise the OSError of a file with which the program must not do something."""
        if not self.allows(path, bits):
            raise os_error(errno.EACCES, told or path)

    def is_system(self, path: str) -> bool:
        """Whether the operating system answers at a path, and not a disk."""
        return path.startswith(_SYSTEM) and any(is_in(path, each) for each in _SYSTEM) and not is_in(path, _SHM)

    def place(self, path: str) -> str:
        """Where the file at a path without links lies, or would lie if it were there."""
        if self._top:
            own = self._own(path)
            if os.path.lexists(own) or self.is_hidden(path):
                return own
        return self._host(path)

    def _host(self, path: str) -> str:
        """The place of a file of the host."""
        place = self._place_of_host(path)
        if path not in self._asked:
            self._asked.add(path)
            sys.audit(ASKED, place)
        return place

    def own_place(self, path: str) -> str | None:
        """Where the run's own file at a path without links lies; None when it has none there."""
        if not self._top:
            return None
        own = self._own(path)
        return own if os.path.lexists(own) else None

    def _own(self, path: str) -> str:
        """Where the run's own file at a path without links would lie."""
        return place_below(self._top, path) if HAS_DRIVES else self._top + path

    def places(self, path: str) -> list[str]:
        """Where what is in a folder at a path without links lies, the run's own first; what was removed shows there."""
        own = self.own_place(path)
        hosts = [] if self.is_hidden(path) else [self._host(path)]
        return hosts if own is None else [own, *hosts]

    def is_hidden(self, path: str) -> bool:
        """Whether the host's file at a path was removed, or one of the folders above it was."""
        gone = self._gone
        if not gone:
            return False
        while path:
            if path in gone:
                return True
            path = path.rpartition("/")[0]
        return False

    def shown(self, place: str) -> str:
        """The path of a place."""
        if not self._top:
            return place
        return path_below(self._top, place) if HAS_DRIVES else place.removeprefix(self._top)

    def exists(self, path: str) -> bool:
        """Whether there is something at a path without links, perhaps a link that leads nowhere."""
        return os.path.lexists(self.place(path))

    def is_folder(self, path: str) -> bool:
        """Whether there is a folder at a path without links."""
        place = self.place(path)
        return os.path.isdir(place) and not os.path.islink(place)

    def check_folder(self, path: str) -> None:
        """Raise the OSError of a path without links that is no folder."""
        if not self.is_folder(path):
            raise os_error(errno.ENOTDIR if self.exists(path) else errno.ENOENT, path)

    def check_entry(self, path: str) -> None:
        """Raise the OSError of a path without links that no program can work in."""
        self.check_folder(path)
        self._check(path, os.X_OK)

    def _shines_through(self, path: str) -> bool:
        return not self.is_hidden(path) and os.path.lexists(self._host(path))

    def names(self, path: str) -> list[str]:
        """What is in a folder, sorted.

        Raises:
            OSError: it is none, or must not be read.
        """
        self.check_folder(path)
        if not self.is_system(path):
            self._check(path, os.R_OK)
        return self._names(path)

    def _names(self, path: str) -> list[str]:
        below = path.rstrip("/")
        found: set[str] = set()
        if not self.is_hidden(path) and os.path.isdir(place := self._host(path)):
            hosts = sorted(os.listdir(place))
            sys.audit(LISTED, place, hosts)
            found = {name for name in hosts if f"{below}/{name}" not in self._gone}
        if self._top and os.path.isdir(own := self._own(path)):
            found.update(os.listdir(own))
        return sorted(found)

    # -- changes -----------------------------------------------------------------------------------------------------

    def claim(self, path: str, with_data: bool = True) -> str:
        """The place of what is at a path without links, for a change: a file of the host is copied first.

        Raises:
            OSError: the host would not let it be changed, or there is no folder for it.
        """
        own = self.own_place(path)
        if own is not None:
            return own
        if not self.is_hidden(path) and os.path.lexists(place := self._host(path)):
            if not is_root(path):
                self._folder_of(path)
            own = self._own_of_home(path)
            if not is_root(path):
                self._copy(place, own, with_data)
            else:
                os.makedirs(own, exist_ok=True)
        else:
            self._own_folder_of(path)
            own = self._own_of_home(path)
        return own

    def _copy(self, place: str, own: str, with_data: bool) -> None:
        real = os.lstat(place)
        if stat.S_ISLNK(real.st_mode):
            os.symlink(os.readlink(place), own)
        elif stat.S_ISDIR(real.st_mode):
            os.mkdir(own)
            os.chmod(own, stat.S_IRWXU)
        elif not stat.S_ISREG(real.st_mode):
            raise os_error(errno.EPERM, own)
        else:
            if with_data:
                from shutil import copyfile  # a run that writes nothing does without

                copyfile(place, own)
            else:
                os.close(os.open(own, os.O_CREAT | os.O_WRONLY))
            os.chmod(own, stat.S_IRUSR | stat.S_IWUSR)
        self.stamps.made(os.lstat(own), real)

    def _folder_of(self, path: str) -> None:
        """Have the folder of a path among the run's own."""
        folder = parent(path)
        self.check_folder(folder)
        if not (self._top and os.path.isdir(self._own(folder))):
            if not is_root(folder):
                self._folder_of(folder)
            sys.audit(NEEDED, self._host(folder))
            self.claim(folder)

    def _own_folder_of(self, path: str) -> None:
        """The same, for something new in it, or for something to go."""
        folder = parent(path)
        self.check_folder(folder)
        self._check(folder, os.W_OK | os.X_OK, path)
        self._folder_of(path)

    def _touch_folder(self, path: str) -> None:
        with suppress(OSError):
            self.stamps.written(key_of(os.stat(self._own_of_home(parent(path)))))

    def _own_of_home(self, path: str) -> str:
        self._home()
        return self._own(path)

    def _home(self) -> str:
        if not self._top:
            from tempfile import mkdtemp

            top = os.path.realpath(mkdtemp(prefix=PREFIX))
            self._top = with_slashes(top) if HAS_DRIVES else top
            sys.audit(MADE, self._top)
            self._remove = finalize(self, _remove_tree, self._top, os.getpid())
        return self._top

    def open(self, path: str, flags: int, mode: int = 0o777) -> int:
        """`os.open`.

        Raises:
            OSError: as of `os.open`.
        """
        must_be_new = flags & os.O_CREAT and flags & os.O_EXCL
        path = self.real(path, not (must_be_new or flags & getattr(os, "O_NOFOLLOW", 0)))
        place = self.place(path)
        changes = flags & (os.O_WRONLY | os.O_RDWR | _CREATES)
        if not changes or self.is_system(path) or is_special(place):
            if not (self.is_system(path) or flags & getattr(os, "O_PATH", 0)) and self.exists(path):
                self._check(path, asked_by(flags))
            descriptor = os.open(place, flags, mode)
        elif flags & _TMPFILE == _TMPFILE:
            self._own_folder_of(os.path.join(path, "new"))
            place = self._own_of_home(path)
            descriptor = os.open(place, flags, mode)
            self.stamps.made(os.fstat(descriptor), mode=mode)
        else:
            descriptor = self._open_to_write(path, flags, mode)
            place = self._own(path)
        self._descriptors[descriptor] = place
        return descriptor

    def _open_to_write(self, path: str, flags: int, mode: int) -> int:
        is_new = not self.exists(path)
        if is_new:
            if not flags & os.O_CREAT:
                raise os_error(errno.ENOENT, path)
            self._own_folder_of(path)
        elif flags & os.O_CREAT and flags & os.O_EXCL:
            raise os_error(errno.EEXIST, path)
        elif self.is_folder(path):
            raise os_error(errno.EISDIR, path)
        else:
            self._check(path, asked_by(flags))
        own = self.claim(path, with_data=not flags & os.O_TRUNC)
        descriptor = os.open(own, flags, stat.S_IRUSR | stat.S_IWUSR)
        if is_new:
            if hasattr(os, "fchmod"):
                os.fchmod(descriptor, stat.S_IRUSR | stat.S_IWUSR)  # whatever the umask of the computer is
            self.stamps.made(os.fstat(descriptor), mode=mode)
            self._touch_folder(path)
        elif flags & os.O_TRUNC:
            self.stamps.written(key_of(os.fstat(descriptor)))
        return descriptor

    def make(self, path: str, how: Callable[[str], object], mode: int | None = None) -> None:
        """Make something new at a path, such as a folder or a link.

        Args:
            path: where; its last part is no link that is followed.
            how: makes it at a place.
            mode: its permissions; None leaves them.
        """
        path = self.real(path, follow=False)
        if self.exists(path):
            raise os_error(errno.EEXIST, path)
        self._own_folder_of(path)
        own = self._own_of_home(path)
        how(own)
        if mode is not None:
            os.chmod(own, stat.S_IRWXU)
        self._no_links.clear()
        self.stamps.made(os.lstat(own), mode=mode)
        self._touch_folder(path)

    def link(self, source: str, target: str) -> None:
        """`os.link`."""
        source = self.real(source, follow=False)
        if not self.exists(source):
            raise os_error(errno.ENOENT, source)
        target = self.real(target, follow=False)
        if self.exists(target):
            raise os_error(errno.EEXIST, target)
        self._own_folder_of(target)
        if self.is_folder(source):
            raise os_error(errno.EPERM, source)
        os.link(self.claim(source), self._own_of_home(target), follow_symlinks=False)
        self.stamps.changed(os.lstat(self._own_of_home(target)))
        self._touch_folder(target)

    def remove(self, path: str) -> None:
        """`os.unlink`."""
        path = self.real(path, follow=False)
        self._check_taken_away(path)
        if self.is_folder(path):
            raise os_error(errno.EISDIR, path)
        self._take_away(path, os.unlink)

    def _check_taken_away(self, path: str) -> None:
        """Raise the OSError of what is not there, or whose folder must not be changed."""
        if not self.exists(path):
            self.check_folder(parent(path))
            raise os_error(errno.ENOENT, path)
        if not is_root(path):
            self._check(parent(path), os.W_OK | os.X_OK, path)

    def remove_folder(self, path: str) -> None:
        """`os.rmdir`."""
        path = self.real(path, follow=False)
        self._check_taken_away(path)
        self.check_folder(path)
        if self._names(path):
            raise os_error(errno.ENOTEMPTY, path)
        self._take_away(path, os.rmdir)

    def _take_away(self, path: str, how: Callable[[str], object]) -> None:
        self._own_folder_of(path)
        own = self.own_place(path)
        if own is not None:
            self.stamps.forget(os.lstat(own))
            how(own)
        if self._shines_through(path):
            self._gone.add(path)
        self._no_links.clear()
        self._touch_folder(path)

    def rename(self, source: str, target: str) -> None:
        """`os.rename`: what is at the target is replaced, a folder only if it is empty."""
        source = self.real(source, follow=False)
        self.check_folder(parent(source))
        target = self.real(target, follow=False)
        if not self.exists(source):
            raise os_error(errno.ENOENT, source)
        is_folder = self.is_folder(source)
        self.check_folder(parent(target))
        if is_folder and is_in(target, source) and target != source:
            raise os_error(errno.EINVAL, source)
        if is_in(source, target) and source != target:
            raise os_error(errno.ENOTEMPTY, source)
        is_there = self.exists(target)
        if is_there and os.path.samestat(os.lstat(self.place(source)), os.lstat(self.place(target))):
            return
        for each in (source, target):
            self._check(parent(each), os.W_OK | os.X_OK, each)
        if is_there and self.is_folder(target) != is_folder:
            raise os_error(errno.ENOTDIR if is_folder else errno.EISDIR, target)
        if is_folder and parent(source) != parent(target):
            self._check(source, os.W_OK)  # what ".." is in it changes
        if is_there:
            (self.remove_folder if is_folder else self.remove)(target)
        self._own_folder_of(source)
        own = self._claim_all(source)
        self._own_folder_of(target)
        os.rename(own, self._own_of_home(target))
        if self._shines_through(source):
            self._gone.add(source)
        if self._shines_through(target):
            self._gone.add(target)
        self._no_links.clear()
        self._touch_folder(source)
        self._touch_folder(target)

    def _claim_all(self, path: str) -> str:
        own = self.claim(path)  # a folder moves whole, also one in which the program must not look up or change names
        if self.is_folder(path):
            for name in self._names(path):
                self._claim_all(f"{path}/{name}")
        return own

    def change(self, path: str, how: Callable[[str], object], follow: bool = True) -> str:
        """Change what a file says of itself; returns the place.

        Args:
            path: of the file.
            how: does it at a place.
            follow: a link is followed.
        """
        path = self.real(path, follow)
        if not self.exists(path):
            raise os_error(errno.ENOENT, path)
        own = path if self.is_system(path) or is_special(self.place(path)) else self.claim(path)
        how(own)
        self.stamps.changed(os.lstat(own))
        return own

    def change_mode(self, path: str | int, mode: int, follow: bool = True) -> None:
        """`os.chmod` of a path, or of an open file; the host's own stays as it is."""
        if isinstance(path, int):
            self.stamps.set_mode(os.fstat(path), mode)
        else:
            self.stamps.set_mode(os.lstat(self.change(path, lambda place: None, follow)), mode)
        self._no_links.clear()

    def truncate(self, path: str, length: int) -> None:
        """`os.truncate` of a path."""
        descriptor = self.open(path, os.O_WRONLY)
        try:
            os.ftruncate(descriptor, length)
            self.stamps.written(key_of(os.fstat(descriptor)))
        finally:
            os.close(descriptor)

    # -- looking -----------------------------------------------------------------------------------------------------

    def stat(self, path: str, follow: bool = True) -> os.stat_result:
        """`os.stat`."""
        path = self.real(path, follow)
        own = self.own_place(path)
        return self.stamps.dressed(os.lstat(self.place(path)), own)

    def stat_of(self, descriptor: int) -> os.stat_result:
        """`os.fstat`."""
        return self.stamps.dressed(os.fstat(descriptor), descriptor if self.is_own(descriptor) else None)

    def wrote(self, descriptor: int) -> None:
        """Something was written to an open file."""
        self.stamps.written(key_of(os.fstat(descriptor)))

    def is_own(self, descriptor: int) -> bool:
        """Whether an open file is one of the run's own."""
        place = place_of(descriptor) or self._descriptors.get(descriptor, "")
        return bool(self._top) and place.startswith(f"{self._top}/")

    def written(self) -> Iterator[tuple[str, str]]:
        """Path and place of each file that the run wrote, in order."""
        for folder, folders, names in os.walk(self._top) if self._top else ():
            folders.sort()
            for name in sorted(names):
                place = os.path.join(folder, name)
                if stat.S_ISREG(os.lstat(place).st_mode):
                    yield self.shown(place), place

    # -- the end, and a second life ----------------------------------------------------------------------------------

    def close(self) -> None:
        """The mission is over: what it wrote is gone."""
        self._remove()
        self._remove = bool
        self._top = ""

    def part(self) -> None:
        """This process was forked: its run goes on with files of its own, and its own places in open ones."""
        import fcntl  # only a system that forks has it

        old = self._top
        if old:
            self._top, self._remove = "", bool
            new = self._home()
            copy_tree(old, new, self.stamps)
        for descriptor in list(self._descriptors):
            try:
                place, at = place_of(descriptor), os.lseek(descriptor, 0, os.SEEK_CUR)
                flags = fcntl.fcntl(descriptor, fcntl.F_GETFL) & ~(_CREATES | os.O_EXCL)
                moved = self._top + place.removeprefix(old) if old and place.startswith(old + "/") else place
                again = os.open(moved, flags)
            except OSError:  # it is closed, or has no name any more
                continue
            os.lseek(again, at, os.SEEK_SET)
            os.dup2(again, descriptor, inheritable=False)
            os.close(again)


def _remove_tree(top: str, process: int) -> None:
    if os.getpid() == process:  # a forked one has its own
        from shutil import rmtree

        rmtree(top, ignore_errors=True)


@cache
def _living() -> WeakSet[Overlay]:
    """The overlays of this process: they part from their like when it is forked, and go when a forked one ends."""
    found: WeakSet[Overlay] = WeakSet()

    in_forked_process(lambda: list(map(Overlay.part, tuple(found))))
    before_end(lambda: list(map(Overlay.close, tuple(found))))
    return found
