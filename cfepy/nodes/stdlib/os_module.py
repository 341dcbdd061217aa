"""`os` of a node: its own environment, working directory, process number and entropy, and the files of its run.

Relative paths are relative to the node's working directory. Functions that start a process, or change the host's
process, are refused or have no effect.
"""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable, Iterator, Mapping, MutableMapping
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.files import LISTED, Entries, FileCalls, same_sizes
from cfepy.nodes.files.stamps import UMASK
from cfepy.nodes.made_modules import rebind
from cfepy.nodes.refused_modules import PROCESS, RefusedError, refusal
from cfepy.nodes.stdlib.streams import COLUMNS, ROWS, STDIN
from cfepy.nodes.stdlib.users import identity

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

# fmt: off
_ONE_PATH = (
    "access", "chflags", "chmod", "chown", "getxattr", "lchmod", "lchown", "listxattr", "lstat", "mkdir",
    "mkfifo", "mknod", "open", "pathconf", "readlink", "remove", "removexattr", "rmdir", "setxattr",
    "stat", "truncate", "unlink", "utime",
)
_TWO_PATHS = ("link", "rename", "replace")
_PROCESSES = (
    "execl", "execle", "execlp", "execlpe", "execv", "execve", "execvp", "execvpe", "fork", "forkpty", "popen",
    "posix_spawn", "posix_spawnp", "spawnl", "spawnle", "spawnlp", "spawnlpe", "spawnv", "spawnve", "spawnvp",
    "spawnvpe", "startfile", "system", "wait", "wait3", "wait4", "waitid", "waitpid", "chroot", "fchdir", "killpg",
)
_NO_EFFECT = (
    "nice", "register_at_fork", "sched_setaffinity", "sched_setparam", "sched_setscheduler", "setpriority",
    "setpgid", "setpgrp", "setsid",
)
# fmt: on


class Environ(MutableMapping[Any, Any]):
    """`os.environ`, or `os.environb` with bytes; changes stay in the node.

    Args:
        values: the variables.
        kind: of names and values, `str` or `bytes`.
    """

    def __init__(self, values: Mapping[str, str], kind: type = str) -> None:
        self._values = dict(values)
        self._kind: Any = kind

    def as_bytes(self) -> Environ:
        """Return the same variables as bytes (os.environb)."""
        made = Environ({}, bytes)
        made._values = self._values
        return made

    def __getitem__(self, name: Any) -> Any:
        try:
            return self._shown(self._values[self._text(name)])
        except KeyError:
            raise KeyError(name) from None

    def __setitem__(self, name: Any, value: Any) -> None:
        key, text = self._text(name), self._text(value)
        if "\0" in key or "\0" in text:
            raise ValueError("embedded null byte")
        if "=" in key:
            raise ValueError("illegal environment variable name")
        if not key:
            raise OSError(errno.EINVAL, os.strerror(errno.EINVAL))
        self._values[key] = text

    def __delitem__(self, name: Any) -> None:
        try:
            del self._values[self._text(name)]
        except KeyError:
            raise KeyError(name) from None

    def __iter__(self) -> Iterator[Any]:
        return map(self._shown, list(self._values))

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"environ({dict(self)!r})"

    def __or__(self, other: Any) -> Any:
        return {**self, **other} if isinstance(other, Mapping) else NotImplemented

    def __ror__(self, other: Any) -> Any:
        return {**other, **self} if isinstance(other, Mapping) else NotImplemented

    def __ior__(self, other: Any) -> Environ:
        self.update(other)
        return self

    def copy(self) -> dict[Any, Any]:
        """Return the variables as a dict."""
        return dict(self)

    def _shown(self, text: str) -> Any:
        return text if self._kind is str else os.fsencode(text)

    def _text(self, value: Any) -> str:
        if not isinstance(value, self._kind):
            raise TypeError(f"{self._kind.__name__} expected, not {type(value).__name__}")
        text: str = os.fsdecode(value)
        return text


Environ.__name__ = Environ.__qualname__ = "_Environ"
Environ.__module__ = "os"


def os_module(universe: Universe) -> ModuleType:
    """Return the module `os` of a universe."""
    names: dict[str, Any] = {name: refusal(universe, f"os.{name}", PROCESS) for name in _PROCESSES if hasattr(os, name)}
    names.update({name: lambda *args, **options: 0 for name in _NO_EFFECT if hasattr(os, name)})
    names.update(paths(universe))
    names.update(_process(universe))
    names.update(identity(universe))
    module = rebind(os, **names)
    modules = universe.importer.modules
    modules["os"] = module  # its own path functions import it
    path = universe.importer.load(os.path.__name__)
    vars(module)["path"] = modules["os.path"] = path
    return module


def paths(universe: Universe) -> dict[str, Any]:
    """Return the functions of `os` that take paths or descriptors."""
    names = _host_paths(universe) if universe.overlay is None else FileCalls(universe, universe.overlay).names()
    cwd = {"getcwd": lambda: universe.cwd, "getcwdb": lambda: os.fsencode(universe.cwd)}
    return {**names, **cwd, "chdir": universe.change_directory}


def _host_paths(universe: Universe) -> dict[str, Any]:
    """Return the functions for a program that works on the host's own files."""
    resolve = universe.resolve

    def one(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(path: Any = ".", *args: Any, **options: Any) -> Any:
            return function(path if options.get("dir_fd") is not None else resolve(path), *args, **options)

        return call

    def two(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(source: Any, target: Any, **options: Any) -> Any:
            return function(resolve(source), resolve(target), **options)

        return call

    def symlink(target: Any, path: Any, target_is_directory: bool = False, **options: Any) -> None:
        os.symlink(target, resolve(path), target_is_directory, **options)

    def listdir(path: Any = ".") -> list[Any]:
        place = resolve(path)
        names = sorted(os.listdir(place))
        sys.audit(LISTED, place, names)
        return names

    def scandir(path: Any = ".") -> Entries:
        place = resolve(path)
        with os.scandir(place) as entries:
            found = sorted(entries, key=lambda entry: entry.name)
        sys.audit(LISTED, place, [entry.name for entry in found])
        return Entries(found)

    names = {name: one(getattr(os, name)) for name in _ONE_PATH if hasattr(os, name)}
    names.update({name: two(getattr(os, name)) for name in _TWO_PATHS})
    names.update(symlink=symlink, listdir=listdir, scandir=scandir)
    if hasattr(os, "statvfs"):
        names["statvfs"] = one(same_sizes(os.statvfs))
    return names


def _process(universe: Universe) -> dict[str, Any]:
    environ = universe.environ

    def kill(pid: int, number: int) -> None:
        if pid not in (universe.pid, 0):
            raise RefusedError("os.kill() of another process", PROCESS, universe.name)
        universe.deliver_signal(number)

    points = universe.file_points

    def write(fd: int, data: Any) -> int:
        if fd not in (1, 2):
            if points is not None:
                points.pause()
            written = os.write(fd, data)
            if universe.overlay is not None:
                universe.overlay.wrote(fd)
            return written
        stream = universe.stdout if fd == 1 else universe.stderr
        return stream.buffer.write(data)

    def read(fd: int, size: int) -> bytes:
        if fd != STDIN:
            if points is not None:
                points.pause()
            return os.read(fd, size)
        return b"" if universe.terminal is None else universe.terminal.read(size)

    def isatty(fd: int) -> bool:
        return universe.terminal is not None and fd in (0, 1, 2)

    def get_terminal_size(fd: int = 1) -> os.terminal_size:
        if not isatty(fd):
            raise OSError(25, "Inappropriate ioctl for device")
        return os.terminal_size((COLUMNS, ROWS))

    def times() -> os.times_result:
        return os.times_result((universe.cpu_ns / 1e9, 0.0, 0.0, 0.0, universe.kernel.now / 1e9))

    def uname() -> os.uname_result:
        real = os.uname()
        return os.uname_result((real.sysname, universe.host_name, real.release, real.version, real.machine))

    return {
        "_exit": universe.exit_now,
        "abort": lambda: universe.exit_now(134),
        "cpu_count": lambda: 1,
        "environ": environ,
        **({"environb": environ.as_bytes()} if os.supports_bytes_environ else {}),
        "get_terminal_size": get_terminal_size,
        "getloadavg": lambda: (0.0, 0.0, 0.0),
        "getpid": lambda: universe.pid,
        "getppid": lambda: 1,
        "getrandom": lambda size, flags=0: universe.rng.randbytes(size),
        "isatty": isatty,
        "kill": kill,
        "putenv": environ.__setitem__,
        "read": read,
        "sched_getaffinity": lambda pid=0: {0},
        "sched_yield": lambda: universe.clock.wait(0),
        "times": times,
        "umask": lambda mask: UMASK,
        "uname": uname,
        "unsetenv": environ.__delitem__,
        "urandom": universe.rng.randbytes,
        "write": write,
    }
