"""open, read, stat, opendir and related functions of POSIX, on the files of OSAL's file system.

Devices of the mission, sockets and the files of libgcov are behind the same descriptors.
"""

from __future__ import annotations

import errno
import platform
from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.gcov import has_host_folder, make_host_folder
from cfepy.extra.c.api.posix_calls import PosixCalls, Slots
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.memory import chars
from cfepy.extra.c.posix.file_tree import OpenFolder
from cfepy.extra.c.posix.open_descriptors import (
    CHANGEABLE,
    MOST,
    O_CREAT,
    O_NONBLOCK,
    O_TRUNC,
    O_WRONLY,
    S_IFCHR,
    Facts,
    failure,
)
from cfepy.osal import OS_TIME_TICK_RESOLUTION_NS
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

AT_FDCWD = -100
F_DUPFD, F_GETFD, F_SETFD, F_GETFL, F_SETFL, F_DUPFD_CLOEXEC = 0, 1, 2, 3, 4, 1030
FIONREAD, FIONBIO = 0x541B, 0x5421
IOVEC = Struct("<QQ")
DIRENT = Struct("<QqHB256s5x")
_SLOT = 512
"""Bytes of a DIR with its dirent."""
DT_UNKNOWN, DT_DIR, DT_REG = 0, 4, 8
_IS_ARM = platform.machine() == "aarch64"
STAT = Struct("<QQIIIIQ8xqi4xq6q8x" if _IS_ARM else "<QQQIII4xQqqq6q24x")
"""struct stat."""
DEVICE_NUMBER, OWNER = 1, 0
DEVICE = Facts(S_IFCHR | 0o660)


def open_path(c: CRuntime, function: str, path: str, flags: int, mode: int) -> int:
    """Open a device of the mission or a file.

    Args:
        c: the C side of the processor.
        function: the function of C.
        path: the path.
        flags: Linux's flags of open.
        mode: the permissions of a new file.

    Returns:
        The number of its descriptor.

    Raises:
        OSError: it cannot be opened.
    """
    c.kernel.preempt()
    for opener in c.openers:
        found = opener(path, flags, mode)
        if found is not None:
            return c.descriptors.add(found)
    return c.descriptors.add(c.posix_files.open(function, path, flags, mode))


class PosixCallsOnFiles:
    """The functions on descriptors and paths.

    Args:
        c: the C side of the processor.
    """

    def __init__(self, c: CRuntime) -> None:
        self._c = c
        self._files = c.posix_files
        self._table = c.descriptors
        self._slots = Slots(c, _SLOT)
        self._folders: dict[int, int] = {}  # numbers of descriptors by DIR

    # -- opening -----------------------------------------------------------------------------------------------------

    def open(self, path: str, flags: int, mode: int) -> int:
        return open_path(self._c, "open", path, flags, mode)

    def open_at(self, folder: int, path: str, flags: int, mode: int) -> int:
        return open_path(self._c, "openat", self._below(folder, path), flags, mode)

    def create(self, path: str, mode: int) -> int:
        return open_path(self._c, "creat", path, O_WRONLY | O_CREAT | O_TRUNC, mode)

    def _below(self, folder: int, path: str) -> str:
        if folder == AT_FDCWD or path.startswith("/"):
            return path
        found = self._table.of(folder)
        if not isinstance(found, OpenFolder):
            raise failure(errno.ENOTDIR)
        return f"{found.path}/{path}"

    def close(self, number: int) -> int:
        self._c.kernel.preempt()
        self._table.close(number)
        return 0

    # -- transfers ---------------------------------------------------------------------------------------------------

    def read(self, number: int, buffer: int, count: int) -> int:
        self._c.kernel.preempt()
        data = self._table.of(number).read(count)
        self._c.memory.poke(buffer, data)
        return len(data)

    def read_checked(self, number: int, buffer: int, count: int, room: int) -> int:
        if count > room:
            raise CFault("buffer overflow detected")
        return self.read(number, buffer, count)

    def write(self, number: int, buffer: int, count: int) -> int:
        self._c.kernel.preempt()
        return self._table.of(number).write(bytes(self._c.memory.peek(buffer, count)))

    def read_at(self, number: int, buffer: int, count: int, position: int) -> int:
        self._c.kernel.preempt()
        data = self._table.of(number).read_at(count, position)
        self._c.memory.poke(buffer, data)
        return len(data)

    def write_at(self, number: int, buffer: int, count: int, position: int) -> int:
        self._c.kernel.preempt()
        return self._table.of(number).write_at(bytes(self._c.memory.peek(buffer, count)), position)

    def gathered(self, vectors: int, count: int) -> bytes:
        """Return the bytes of an array of struct iovec."""
        memory = self._c.memory
        places = (IOVEC.unpack(memory.peek(vectors + n * IOVEC.size, IOVEC.size)) for n in range(count))
        return b"".join(bytes(memory.peek(at, size)) for at, size in places)

    def write_gathered(self, number: int, vectors: int, count: int) -> int:
        self._c.kernel.preempt()
        return self._table.of(number).write(self.gathered(vectors, count))

    def seek(self, number: int, offset: int, whence: int) -> int:
        return self._table.of(number).seek(offset, whence)

    def sync(self, number: int) -> int:
        self._table.of(number)
        return 0

    def truncate_open(self, number: int, size: int) -> int:
        self._table.of(number).truncate(size)
        return 0

    # -- settings of a descriptor ------------------------------------------------------------------------------------

    def settings(self, number: int, command: int, argument: int) -> int:
        found = self._table.of(number)
        if command == F_GETFL:
            return found.flags & ~O_CREAT & ~O_TRUNC
        if command == F_SETFL:
            found.flags = found.flags & ~CHANGEABLE | argument & CHANGEABLE
            return 0
        if command in (F_DUPFD, F_DUPFD_CLOEXEC):
            if not 0 <= argument < MOST:
                raise failure(errno.EINVAL)
            return self._table.add(found, argument)
        if command in (F_GETFD, F_SETFD):  # no other process is ever started
            return 0
        return found.lock(command, argument)

    def control(self, number: int, request: int, argument: int) -> int:
        found, request = self._table.of(number), request & 0xFFFFFFFF
        if request == FIONBIO:
            is_set = self._c.memory.u32(argument) != 0
            found.flags = found.flags & ~O_NONBLOCK | (O_NONBLOCK if is_set else 0)
            return 0
        if request == FIONREAD:
            self._c.memory.put_u32(argument, found.waiting())
            return 0
        return found.control(request, argument)

    def is_terminal(self, number: int) -> int:
        if not self._table.of(number).is_terminal:
            raise failure(errno.ENOTTY)
        return 1

    # -- facts -------------------------------------------------------------------------------------------------------

    def stat(self, path: str, at: int) -> int:
        self._c.kernel.preempt()
        is_device = self._c.devices.has_file(path)
        self._put(DEVICE if is_device else self._files.facts("stat", path), at)
        return 0

    def stat_open(self, number: int, at: int) -> int:
        self._put(self._table.of(number).facts(), at)
        return 0

    def stat_at(self, folder: int, path: str, at: int, flags: int) -> int:
        return self.stat(self._below(folder, path), at)

    def _put(self, facts: Facts, at: int) -> None:
        now = self._c.handle.os.get_local_time() * OS_TIME_TICK_RESOLUTION_NS
        time = divmod(now - self._c.kernel.now + facts.modified_ns, NS_PER_S)
        ids, blocks = (OWNER, OWNER), -(-facts.size // 512)
        head = (facts.mode, 1) if _IS_ARM else (1, facts.mode)
        values = (DEVICE_NUMBER, facts.number, *head, *ids, 0, facts.size, 4096, blocks, *time, *time, *time)
        self._c.memory.poke(at, STAT.pack(*values))

    def access(self, path: str, mode: int) -> int:
        self._c.kernel.preempt()
        if self._c.devices.has_file(path) or has_host_folder(self._c, path):
            return 0
        self._files.access("access", path, mode)
        return 0

    # -- changes by path ---------------------------------------------------------------------------------------------

    def change(self, function: str, *arguments: object) -> int:
        self._c.kernel.preempt()
        changes = {
            "mkdir": self._files.make_folder,
            "rmdir": self._files.remove_folder,
            "unlink": self._files.unlink,
            "remove": self._files.remove,
            "rename": self._files.rename,
            "truncate": self._files.truncate,
        }
        changes[function](function, *arguments)  # type: ignore[operator]
        return 0

    def make_folder(self, path: str, mode: int) -> int:
        return 0 if make_host_folder(path, mode) else self.change("mkdir", path)

    def current_folder(self, to: int, size: int) -> int:
        if not to:
            raise CFault("getcwd() of a NULL pointer is not available; pass a buffer")
        if size < 2:
            raise failure(errno.ERANGE if size else errno.EINVAL)
        self._c.memory.poke(to, b"/\0")
        return to

    # -- folders -----------------------------------------------------------------------------------------------------

    def open_folder(self, path: str) -> int:
        self._c.kernel.preempt()
        found = self._files.open("opendir", path, 0, 0)
        if not isinstance(found, OpenFolder):
            found.close()
            raise failure(errno.ENOTDIR)
        number = self._table.add(found)
        made = self._slots.take()
        self._folders[made] = number
        return made

    def _folder(self, folder: int) -> tuple[int, OpenFolder]:
        number = self._folders.get(folder)
        if number is None:
            raise CFault(f"0x{folder:x} is not an open DIR")
        found = self._table.of(number)
        if not isinstance(found, OpenFolder):
            raise failure(errno.EBADF)
        return number, found

    def read_folder(self, folder: int) -> int:
        self._c.kernel.preempt()
        opened = self._folder(folder)[1]
        following = opened.next_name()
        if following is None:
            return 0
        name, found = following
        kind = DT_REG if found.node is not None else DT_DIR if found.is_folder else DT_UNKNOWN
        size = 19 + len(name.encode("utf-8", "surrogateescape")) + 1
        entry = DIRENT.pack(found.number, opened.position, size + -size % 8, kind, chars(name, 256))
        self._c.memory.poke(folder, entry)
        return folder

    def rewind_folder(self, folder: int) -> None:
        self._folder(folder)[1].rewind()

    def number_of_folder(self, folder: int) -> int:
        return self._folder(folder)[0]

    def close_folder(self, folder: int) -> int:
        number, _ = self._folder(folder)
        del self._folders[folder]
        self._slots.give(folder)
        self._table.close(number)
        return 0


def declare(api: Declarations, c: CRuntime) -> None:
    calls, files = PosixCalls(api, c), PosixCallsOnFiles(c)
    calls.add("open open64", "$SiI", files.open)
    calls.add("__open_2 __open64_2", "$Si", lambda path, flags: files.open(path, flags, 0))
    calls.add("openat openat64", "$iSiI", files.open_at)
    calls.add("creat creat64", "$SI", files.create)
    calls.add("close", "$i", files.close)
    calls.add("read", "$iPQ", files.read)
    calls.add("__read_chk", "$iPQQ", files.read_checked)
    calls.add("write", "$iPQ", files.write)
    calls.add("pread pread64", "$iPQq", files.read_at)
    calls.add("pwrite pwrite64", "$iPQq", files.write_at)
    calls.add("writev", "$iPi", files.write_gathered)
    calls.add("lseek lseek64", "$iqi", files.seek)
    calls.add("fsync fdatasync", "$i", files.sync)
    calls.add("ftruncate ftruncate64", "$iq", files.truncate_open)
    calls.add("dup", "i", lambda number: c.descriptors.add(c.descriptors.of(number)))
    calls.add("dup2", "ii", lambda number, wanted: c.descriptors.replace(wanted, number))
    calls.add("fcntl fcntl64", "iip", files.settings)
    calls.add("ioctl", "$iQp", files.control)
    calls.add("isatty", "i", files.is_terminal, 0)
    calls.add("stat stat64 lstat lstat64", "$SP", files.stat)
    calls.add("__xstat __xstat64 __lxstat __lxstat64", "$-SP", files.stat)
    calls.add("fstat fstat64", "$iP", files.stat_open)
    calls.add("__fxstat __fxstat64", "$-iP", files.stat_open)
    calls.add("fstatat fstatat64", "$iSPi", files.stat_at)
    calls.add("access", "$Si", files.access)
    calls.add("mkdir", "$SI", files.make_folder)
    for name in ("rmdir", "unlink", "remove"):
        calls.add(name, "$S", lambda path, name=name: files.change(name, path))
    calls.add("rename", "$SS", lambda old, new: files.change("rename", old, new))
    calls.add("truncate truncate64", "$Sq", lambda path, size: files.change("truncate", path, size))
    calls.add("getcwd", "pQ", files.current_folder, 0)
    calls.add("opendir", "$S", files.open_folder, 0)
    calls.add("readdir readdir64", "$P", files.read_folder, 0)
    calls.add("rewinddir", "P", files.rewind_folder)
    calls.add("dirfd", "P", files.number_of_folder)
    calls.add("closedir", "$P", files.close_folder)
