"""Functions of `os` that take paths or descriptors, working on the files of a run.

A path may be relative to the node's working directory or to an open folder (`dir_fd`), or may be an open file itself.
Errors name it as the program gave it.
"""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from cfepy.nodes.files.stamps import GROUP, USER

if TYPE_CHECKING:
    from cfepy.nodes.files.overlay import Overlay
    from cfepy.nodes.universe import Universe

_LOOKS = ("getxattr", "listxattr", "pathconf")
BLOCK_BYTES = 4096
DISK_BYTES = 1 << 30  # of each disk, all of it free: a node must not see how full this computer's is
_CHANGES = ("chflags", "removexattr", "setxattr")
_LINK_CHANGES = ("lchflags",)
_WRITES = ("copy_file_range", "ftruncate", "posix_fallocate", "pwrite", "pwritev", "sendfile", "writev")
_MKFIFO_MODE, _MKDIR_MODE = 0o666, 0o777


class FolderEntry:
    """`os.DirEntry`: a name in a folder.

    Args:
        folder: the folder as it was given.
        name: name of the file.
        kind: file type given by the folder (`stat.S_IFMT`), so no permission on the file itself is needed.
        look: `stat` for a path of the program.
    """

    def __init__(self, folder: str, name: str, kind: int, look: Callable[..., os.stat_result]) -> None:
        self.name = name
        self.path = os.path.join(folder, name)
        self._kind = kind
        self._look = look

    def __fspath__(self) -> str:
        return self.path

    def __repr__(self) -> str:
        return f"<DirEntry {self.name!r}>"

    def inode(self) -> int:
        """Return the inode number."""
        return self.stat(follow_symlinks=False).st_ino

    def is_dir(self, *, follow_symlinks: bool = True) -> bool:
        """Return whether it is a folder."""
        return stat.S_ISDIR(self._found(follow_symlinks))

    def is_file(self, *, follow_symlinks: bool = True) -> bool:
        """Return whether it is a file."""
        return stat.S_ISREG(self._found(follow_symlinks))

    def is_symlink(self) -> bool:
        """Return whether it is a link."""
        return stat.S_ISLNK(self._kind)

    def is_junction(self) -> bool:
        """Return False: only Windows has junctions."""
        return False

    def stat(self, *, follow_symlinks: bool = True) -> os.stat_result:
        """Return the metadata of the file."""
        return self._look(self.path, follow_symlinks=follow_symlinks)

    def _found(self, follow: bool) -> int:
        if not (follow and self.is_symlink()):
            return self._kind
        try:
            return self.stat().st_mode
        except FileNotFoundError:
            return 0


class BytesFolderEntry(FolderEntry):
    """Entry of a folder that was given as bytes."""

    def __init__(self, folder: bytes, name: str, kind: int, look: Callable[..., os.stat_result]) -> None:
        super().__init__(os.fsdecode(folder), name, kind, look)
        self.name, self.path = os.fsencode(self.name), os.fsencode(self.path)  # type: ignore[assignment]


class Entries:
    """`os.scandir`, sorted by name, because the order of a directory depends on the file system.

    Args:
        found: the entries.
    """

    def __init__(self, found: list[Any]) -> None:
        self._entries = iter(found)

    def __iter__(self) -> Iterator[Any]:
        return self._entries

    def __next__(self) -> Any:
        return next(self._entries)

    def __enter__(self) -> Entries:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Do nothing: all entries were read at once."""


class FileCalls:
    """File functions of a program's `os`.

    Args:
        universe: universe of the program.
        overlay: files of its run.
    """

    def __init__(self, universe: Universe, overlay: Overlay) -> None:
        self._universe = universe
        self._overlay = overlay
        self._folders: dict[int, str] = {}  # open folders, by descriptor

    def names(self) -> dict[str, Any]:
        """Return the functions by name."""
        overlay = self._overlay
        found: dict[str, Any] = {
            "access": self._access,
            "close": self._close,
            "closerange": lambda low, high: None,
            "fstat": overlay.stat_of,
            "link": self._link,
            "listdir": self._listdir,
            "lstat": lambda path, *, dir_fd=None: self._stat(path, dir_fd=dir_fd, follow_symlinks=False),
            "mkdir": self._mkdir,
            "mkfifo": self._mkfifo,
            "mknod": self._mknod,
            "open": self._open,
            "readlink": self._readlink,
            "remove": self._remove,
            "rename": self._rename,
            "replace": self._rename,
            "rmdir": self._rmdir,
            "scandir": self._scandir,
            "stat": self._stat,
            "symlink": self._symlink,
            "truncate": self._truncate,
            "unlink": self._remove,
            "utime": self._utime,
        }
        owners = {
            "chmod": self._chmod,
            "chown": self._chown,
            "fchmod": overlay.change_mode,
            "fchown": self._chown,
            "lchmod": lambda path, mode: self._chmod(path, mode, follow_symlinks=False),
            "lchown": lambda path, uid, gid: self._chown(path, uid, gid, follow_symlinks=False),
        }
        found |= {name: function for name, function in owners.items() if hasattr(os, name)}
        found |= {name: self._look_at(getattr(os, name)) for name in _LOOKS if hasattr(os, name)}
        if hasattr(os, "statvfs"):
            found["statvfs"] = self._look_at(same_sizes(os.statvfs))
        found |= {name: self._changing(getattr(os, name)) for name in _CHANGES if hasattr(os, name)}
        found |= {name: self._changing(getattr(os, name), follow=False) for name in _LINK_CHANGES if hasattr(os, name)}
        found |= {name: self._writing(name, getattr(os, name)) for name in _WRITES if hasattr(os, name)}
        points = self._universe.file_points
        return found if points is None else {name: points.around(name, found[name], self.where) for name in found}

    def where(self, path: Any, dir_fd: int | None = None) -> str:
        """Return the absolute path, as the program sees it, of an argument."""
        plain = os.fsdecode(path)
        if not plain:
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)
        if dir_fd is not None and not plain.startswith("/") and dir_fd in self._folders:
            plain = os.path.join(self._folders[dir_fd], plain)
        found: str = self._universe.absolute(plain)
        return found

    # -- opening -----------------------------------------------------------------------------------------------------

    def _open(self, path: Any, flags: int, mode: int = 0o777, *, dir_fd: int | None = None) -> int:
        where = self.where(path, dir_fd)
        with _told(path):
            descriptor = self._overlay.open(where, flags, mode)
        if stat.S_ISDIR(os.fstat(descriptor).st_mode):
            self._folders[descriptor] = where
        return descriptor

    def _close(self, fd: int) -> None:
        self._folders.pop(fd, None)
        os.close(fd)

    def _writing(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        at = 1 if name == "copy_file_range" else 0

        def call(*args: Any, **options: Any) -> Any:
            value = function(*args, **options)
            self._overlay.wrote(args[at])
            return value

        return call

    # -- looking -----------------------------------------------------------------------------------------------------

    def _stat(self, path: Any, *, dir_fd: int | None = None, follow_symlinks: bool = True) -> os.stat_result:
        if isinstance(path, int):
            return self._overlay.stat_of(path)
        where = self.where(path, dir_fd)
        with _told(path):
            return self._overlay.stat(where, follow_symlinks)

    def _look_at(self, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(path: Any, *args: Any, follow_symlinks: bool = True) -> Any:
            if isinstance(path, int):
                return function(path, *args)
            with _told(path):
                return function(self._overlay.place(self._overlay.real(self.where(path), follow_symlinks)), *args)

        return call

    def _access(
        self,
        path: Any,
        mode: int,
        *,
        dir_fd: int | None = None,
        effective_ids: bool = False,
        follow_symlinks: bool = True,
    ) -> bool:
        try:
            where = self._overlay.real(self.where(path, dir_fd), follow_symlinks)
        except OSError:
            return False
        return self._overlay.allows(where, mode)

    def _readlink(self, path: Any, *, dir_fd: int | None = None) -> Any:
        where = self.where(path, dir_fd)
        with _told(path):
            target = os.readlink(self._overlay.place(self._overlay.real(where, follow=False)))
        return os.fsencode(target) if isinstance(path, bytes) else target

    def _listed(self, path: Any) -> list[str]:
        with _told(path):
            return self._overlay.names(self._folder(path))

    def _folder(self, path: Any) -> str:
        return self._overlay.real(self._folders[path] if isinstance(path, int) else self.where(path))

    def _listdir(self, path: Any = ".") -> list[Any]:
        names = self._listed("." if path is None else path)
        return [os.fsencode(name) for name in names] if isinstance(path, bytes) else list(names)

    def _scandir(self, path: Any = ".") -> Entries:
        given = "." if path is None else self._folders.get(path) if isinstance(path, int) else os.fspath(path)
        entry: Any = BytesFolderEntry if isinstance(given, bytes) else FolderEntry
        with _told(path):
            folder = self._folder(path if path is not None else ".")
            kinds = [(name, self._kind(folder, name)) for name in self._overlay.names(folder)]
        return Entries([entry(given, name, kind, self._stat) for name, kind in kinds])

    def _kind(self, folder: str, name: str) -> int:
        try:
            return stat.S_IFMT(os.lstat(self._overlay.place(f"{folder.rstrip('/')}/{name}")).st_mode)
        except OSError:  # it no longer exists, such as the descriptor in /proc/self/fd by which the folder was read
            return 0

    # -- changing ----------------------------------------------------------------------------------------------------

    def _mkdir(self, path: Any, mode: int = _MKDIR_MODE, *, dir_fd: int | None = None) -> None:
        where = self.where(path, dir_fd)
        with _told(path):
            self._overlay.make(where, os.mkdir, mode)

    def _mkfifo(self, path: Any, mode: int = _MKFIFO_MODE, *, dir_fd: int | None = None) -> None:
        where = self.where(path, dir_fd)
        with _told(path):
            self._overlay.make(where, os.mkfifo, mode)

    def _mknod(self, path: Any, mode: int = 0o600, device: int = 0, *, dir_fd: int | None = None) -> None:
        where = self.where(path, dir_fd)
        with _told(path):
            self._overlay.make(where, lambda place: os.mknod(place, mode, device), stat.S_IMODE(mode))

    def _symlink(self, src: Any, dst: Any, target_is_directory: bool = False, *, dir_fd: int | None = None) -> None:
        where = self.where(dst, dir_fd)
        with _told(src, dst):
            self._overlay.make(where, lambda place: os.symlink(os.fsdecode(src), place))

    def _link(
        self,
        src: Any,
        dst: Any,
        *,
        src_dir_fd: int | None = None,
        dst_dir_fd: int | None = None,
        follow_symlinks: bool = True,
    ) -> None:
        source, target = self.where(src, src_dir_fd), self.where(dst, dst_dir_fd)
        with _told(src, dst):
            self._overlay.link(source, target)

    def _rename(self, src: Any, dst: Any, *, src_dir_fd: int | None = None, dst_dir_fd: int | None = None) -> None:
        source, target = self.where(src, src_dir_fd), self.where(dst, dst_dir_fd)
        with _told(src, dst):
            self._overlay.rename(source, target)

    def _remove(self, path: Any, *, dir_fd: int | None = None) -> None:
        where = self.where(path, dir_fd)
        with _told(path):
            self._overlay.remove(where)

    def _rmdir(self, path: Any, *, dir_fd: int | None = None) -> None:
        where = self.where(path, dir_fd)
        with _told(path):
            self._overlay.remove_folder(where)

    def _changing(self, function: Callable[..., Any], follow: bool = True) -> Callable[..., Any]:
        def call(
            path: Any, *args: Any, dir_fd: int | None = None, follow_symlinks: bool = follow, **options: Any
        ) -> None:
            if isinstance(path, int):
                if not self._overlay.is_own(path):  # an open file of the host
                    raise PermissionError(errno.EPERM, os.strerror(errno.EPERM), path)
                function(path, *args, **options)
                self._overlay.stamps.changed(os.fstat(path))
                return
            where = self.where(path, dir_fd)
            with _told(path):
                self._overlay.change(where, lambda place: function(place, *args, **options), follow_symlinks)

        return call

    def _chmod(self, path: Any, mode: int, *, dir_fd: int | None = None, follow_symlinks: bool = True) -> None:
        where = path if isinstance(path, int) else self.where(path, dir_fd)
        with _told(path):
            self._overlay.change_mode(where, mode, follow_symlinks)

    def _chown(self, path: Any, uid: int, gid: int, *, dir_fd: int | None = None, follow_symlinks: bool = True) -> None:
        """Change the owner; an ordinary user cannot give a file away."""
        with _told(path):
            if isinstance(path, int):
                self._overlay.stamps.changed(os.fstat(path))
            else:
                self._overlay.change(self.where(path, dir_fd), lambda place: None, follow_symlinks)
            if uid not in (-1, USER) or gid not in (-1, GROUP):
                raise PermissionError(errno.EPERM, os.strerror(errno.EPERM), path)

    def _truncate(self, path: Any, length: int) -> None:
        if isinstance(path, int):
            os.ftruncate(path, length)
            self._overlay.wrote(path)
            return
        where = self.where(path)
        with _told(path):
            self._overlay.truncate(where, length)

    def _utime(
        self,
        path: Any,
        times: tuple[float, float] | None = None,
        *,
        ns: tuple[int, int] | None = None,
        dir_fd: int | None = None,
        follow_symlinks: bool = True,
    ) -> None:
        now = self._universe.clock.epoch_ns + self._universe.kernel.now
        told = ns if ns is not None else (now, now) if times is None else (round(times[0] * 1e9), round(times[1] * 1e9))
        if isinstance(path, int):
            self._overlay.stamps.changed(os.fstat(path), told)
            return
        where = self.where(path, dir_fd)
        with _told(path):
            own = self._overlay.change(where, lambda place: None, follow_symlinks)
            self._overlay.stamps.changed(os.lstat(own), told)


class _told:
    """Context of a call in which errors name paths as the program gave them."""

    def __init__(self, path: Any, second: Any = None) -> None:
        self._path = path
        self._second = second

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: object, error: BaseException | None, where: object) -> None:
        if isinstance(error, OSError) and error.filename is not None:
            error.filename = self._path
            if self._second is not None:
                error.filename2 = self._second


def same_sizes(look: Callable[..., os.statvfs_result]) -> Callable[..., os.statvfs_result]:
    """Return `os.statvfs` with sizes that are the same on each computer; its errors stay."""

    def call(path: Any) -> os.statvfs_result:
        names = look(path).f_namemax
        blocks = DISK_BYTES // BLOCK_BYTES
        return os.statvfs_result((BLOCK_BYTES, BLOCK_BYTES, *[blocks] * 6, 0, names, 0))

    return call
