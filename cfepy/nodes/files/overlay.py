"""`Overlay`: the files that the programs of one run see: the host's, under a layer with the files written by the run.

Files written by a run are stored in a temporary folder, at the same path below it; a host file is copied there before
it is changed. Removals are only recorded. Descriptors are therefore real, and C code that is given a descriptor or
place works. The folder is created on first use and removed with the mission.

Paths here are absolute and as programs see them; a "place" is where a file is really stored.
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

PREFIX = "cfepy-files-"  # of the folders of runs in the temporary folder
_SYSTEM = ("/proc", "/sys", "/dev")  # not files, but queries to the operating system
_SHM = "/dev/shm"
_MOST_LINKS = 40
_OWNER_S = 6  # shift from the owner's permission bits to those of access()
_CREATES = os.O_CREAT | os.O_TRUNC | getattr(os, "O_TMPFILE", 0)
_TMPFILE = getattr(os, "O_TMPFILE", -1)


class Overlay:
    """Files of one run.

    Args:
        now_ns: time of day of the run, ns since 1970.
        host: returns the place of a host file; in a replay, recorded files have other places.

    Attributes:
        stamps: numbers and times of files.
    """

    def __init__(self, now_ns: Callable[[], int] = lambda: 0, host: Callable[[str], str] = lambda path: path) -> None:
        self.stamps = Stamps(now_ns)
        self._place_of_host = host
        self._asked: set[str] = set()  # host paths that were looked at
        self._top = ""
        self._gone: set[str] = set()  # host paths that are hidden, with everything below them
        self._no_links: set[str] = set()  # folders known to have no links in their path and to be searchable
        self._descriptors: dict[int, str] = {}  # places of recently opened files
        self._remove: Callable[[], object] = bool
        _living().add(self)

    # -- finding ----------------------------------------------------------------------------------------------------

    def real(self, path: str, follow: bool = True) -> str:
        """Return a path with links resolved, the last part only if `follow`; missing parts stay as they are.

        Raises:
            OSError: if links form a cycle, or ".." follows something that is not a folder.
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
        """Raise the OSError of a path that continues behind a file, or a folder that the program may not search."""
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
        """Return whether the program may access the file at a path without links.

        The program owns all files and is not root, whoever runs cfepy. It cannot read files that cfepy cannot read on
        the host; writes go to a copy.

        Args:
            path: path of the file.
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
        """Raise an OSError if the program must not access a file."""
        if not self.allows(path, bits):
            raise os_error(errno.EACCES, told or path)

    def is_system(self, path: str) -> bool:
        """Return whether a path is answered by the operating system and not by a disk."""
        return path.startswith(_SYSTEM) and any(is_in(path, each) for each in _SYSTEM) and not is_in(path, _SHM)

    def place(self, path: str) -> str:
        """Return the place of a path without links, whether or not the file exists."""
        if self._top:
            own = self._own(path)
            if os.path.lexists(own) or self.is_hidden(path):
                return own
        return self._host(path)

    def _host(self, path: str) -> str:
        """Return the place of a file of the host."""
        place = self._place_of_host(path)
        if path not in self._asked:
            self._asked.add(path)
            sys.audit(ASKED, place)
        return place

    def own_place(self, path: str) -> str | None:
        """Return the place of the run's own file at a path without links; None if there is none."""
        if not self._top:
            return None
        own = self._own(path)
        return own if os.path.lexists(own) else None

    def _own(self, path: str) -> str:
        """Return the place that the run's own file at a path without links would have."""
        return place_below(self._top, path) if HAS_DRIVES else self._top + path

    def places(self, path: str) -> list[str]:
        """Return the places of a folder at a path without links, the run's own first; removed files are still visible
        there.
        """
        own = self.own_place(path)
        hosts = [] if self.is_hidden(path) else [self._host(path)]
        return hosts if own is None else [own, *hosts]

    def is_hidden(self, path: str) -> bool:
        """Return whether the host file at a path, or a folder above it, was removed."""
        gone = self._gone
        if not gone:
            return False
        while path:
            if path in gone:
                return True
            path = path.rpartition("/")[0]
        return False

    def shown(self, place: str) -> str:
        """Return the path of a place."""
        if not self._top:
            return place
        return path_below(self._top, place) if HAS_DRIVES else place.removeprefix(self._top)

    def exists(self, path: str) -> bool:
        """Return whether a path without links exists; a broken link counts."""
        return os.path.lexists(self.place(path))

    def is_folder(self, path: str) -> bool:
        """Return whether a path without links is a folder."""
        place = self.place(path)
        return os.path.isdir(place) and not os.path.islink(place)

    def check_folder(self, path: str) -> None:
        """Raise an OSError if a path without links is not a folder."""
        if not self.is_folder(path):
            raise os_error(errno.ENOTDIR if self.exists(path) else errno.ENOENT, path)

    def check_entry(self, path: str) -> None:
        """Raise an OSError if a program cannot use a path without links as its working directory."""
        self.check_folder(path)
        self._check(path, os.X_OK)

    def _shines_through(self, path: str) -> bool:
        return not self.is_hidden(path) and os.path.lexists(self._host(path))

    def names(self, path: str) -> list[str]:
        """Return the names in a folder, sorted.

        Raises:
            OSError: if it is not a folder, or must not be read.
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
        """Return the place to change for a path without links; a host file is copied first.

        Raises:
            OSError: if the host would not allow the change, or its folder does not exist.
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
                from shutil import copyfile  # loaded only by runs that write

                copyfile(place, own)
            else:
                os.close(os.open(own, os.O_CREAT | os.O_WRONLY))
            os.chmod(own, stat.S_IRUSR | stat.S_IWUSR)
        self.stamps.made(os.lstat(own), real)

    def _folder_of(self, path: str) -> None:
        """Ensure that the run has its own copy of the folder of a path."""
        folder = parent(path)
        self.check_folder(folder)
        if not (self._top and os.path.isdir(self._own(folder))):
            if not is_root(folder):
                self._folder_of(folder)
            sys.audit(NEEDED, self._host(folder))
            self.claim(folder)

    def _own_folder_of(self, path: str) -> None:
        """As `_folder_of`, for adding or removing an entry."""
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
            OSError: as for `os.open`.
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
                os.fchmod(descriptor, stat.S_IRUSR | stat.S_IWUSR)  # independent of the host's umask
            self.stamps.made(os.fstat(descriptor), mode=mode)
            self._touch_folder(path)
        elif flags & os.O_TRUNC:
            self.stamps.written(key_of(os.fstat(descriptor)))
        return descriptor

    def make(self, path: str, how: Callable[[str], object], mode: int | None = None) -> None:
        """Create something at a path, such as a folder or a link.

        Args:
            path: path to create; a link as its last part is not followed.
            how: creates it at a place.
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
        """Raise an OSError if a path does not exist or its folder must not be changed."""
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
        """`os.rename`: the target is replaced, a folder only if it is empty."""
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
            self._check(source, os.W_OK)  # its ".." entry changes
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
        own = self.claim(path)  # a folder is moved whole, even if the program may not search or change it
        if self.is_folder(path):
            for name in self._names(path):
                self._claim_all(f"{path}/{name}")
        return own

    def change(self, path: str, how: Callable[[str], object], follow: bool = True) -> str:
        """Change the metadata of a file; returns its place.

        Args:
            path: path of the file.
            how: makes the change at a place.
            follow: whether a link is followed.
        """
        path = self.real(path, follow)
        if not self.exists(path):
            raise os_error(errno.ENOENT, path)
        own = path if self.is_system(path) or is_special(self.place(path)) else self.claim(path)
        how(own)
        self.stamps.changed(os.lstat(own))
        return own

    def change_mode(self, path: str | int, mode: int, follow: bool = True) -> None:
        """`os.chmod` of a path or an open file; the host file is not changed."""
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
        """Return whether an open file belongs to the run."""
        place = place_of(descriptor) or self._descriptors.get(descriptor, "")
        return bool(self._top) and place.startswith(f"{self._top}/")

    def written(self) -> Iterator[tuple[str, str]]:
        """Return path and place of each file that the run wrote, in order."""
        for folder, folders, names in os.walk(self._top) if self._top else ():
            folders.sort()
            for name in sorted(names):
                place = os.path.join(folder, name)
                if stat.S_ISREG(os.lstat(place).st_mode):
                    yield self.shown(place), place

    # -- end and fork -----------------------------------------------------------------------------------------------

    def close(self) -> None:
        """Remove the files of the run, at the end of the mission."""
        self._remove()
        self._remove = bool
        self._top = ""

    def part(self) -> None:
        """Continue in a forked process with a copy of the run's files; open files get positions of their own."""
        import fcntl  # only systems that can fork have it

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
            except OSError:  # it is closed, or no longer has a name
                continue
            os.lseek(again, at, os.SEEK_SET)
            os.dup2(again, descriptor, inheritable=False)
            os.close(again)


def _remove_tree(top: str, process: int) -> None:
    if os.getpid() == process:  # a forked process has its own
        from shutil import rmtree

        rmtree(top, ignore_errors=True)


@cache
def _living() -> WeakSet[Overlay]:
    """Return the overlays of this process: they are copied when it is forked, and removed at the end of a fork."""
    found: WeakSet[Overlay] = WeakSet()

    in_forked_process(lambda: list(map(Overlay.part, tuple(found))))
    before_end(lambda: list(map(Overlay.close, tuple(found))))
    return found
