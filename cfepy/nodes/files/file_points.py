"""`FilePoints`: other tasks may run before each file call of a program, while schedules are explored.

On the target a file call is a system call, during which another process or thread may run. The points lie outside the
locks of Python's buffers, so a task never waits for a buffer that another one holds. Bytes in a buffer are written when
the file is flushed or closed, so that is where a task may be too late.
"""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any, cast

from cfepy.interpreter.own_code import called_as
from cfepy.schedules import ExploringKernel

if TYPE_CHECKING:
    from cfepy.rtos import Kernel

READS_FILE, WRITES_FILE = "reads file", "writes file"
_PATHS = (str, bytes, os.PathLike)
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC
_LOOKING = frozenset(
    {"access", "getxattr", "listdir", "listxattr", "lstat", "pathconf", "readlink", "scandir", "stat", "statvfs"}
)
_WITHOUT = frozenset({"close", "closerange", "fstat"})  # they change nothing that another task sees
_TWO_PATHS = frozenset({"link", "rename", "replace"})
_SECOND_PATH = frozenset({"symlink"})  # the first is the text of the link
_KEYWORDS = ("path", "src", "dst")


class FilePoints:
    """Scheduling points of one program. The kernel's observers get its accesses, with this object as the subject.

    Args:
        kernel: kernel of the mission, with a policy.
    """

    def __init__(self, kernel: ExploringKernel) -> None:
        self._kernel = kernel

    def pause(self) -> None:
        """Let other tasks run."""
        self._kernel.point()

    def access(self, path: str, is_write: bool) -> None:
        """Let other tasks run, then report an access.

        Args:
            path: absolute path of the file, as the program sees it.
            is_write: whether the file changes.
        """
        self._kernel.point()
        self.report(path, is_write)

    def report(self, path: str, is_write: bool) -> None:
        """Report an access of the current task, without a point."""
        self._kernel.tell(self, WRITES_FILE if is_write else READS_FILE, (os.path.normpath(path),))

    def around(self, name: str, function: Callable[..., Any], where: Callable[..., str]) -> Callable[..., Any]:
        """Return a function of `os` with a point before it.

        Args:
            name: its name.
            function: the function.
            where: `(path, dir_fd) -> str`: returns an absolute path.
        """
        if name in _WITHOUT:
            return function
        first, last = (1, 2) if name in _SECOND_PATH else (0, 2) if name in _TWO_PATHS else (0, 1)
        keywords = _KEYWORDS[2:] if name in _SECOND_PATH else _KEYWORDS

        def call(*args: Any, **options: Any) -> Any:
            is_write = name not in _LOOKING
            if name == "open":
                flags = args[1] if len(args) > 1 else options.get("flags", 0)
                is_write = bool(flags & _WRITING)
            self.pause()
            for path in (*args[first:last], *(options[each] for each in keywords if each in options)):
                if isinstance(path, _PATHS):
                    with suppress(OSError):  # the call itself raises it
                        self.report(where(path, options.get("dir_fd")), is_write)
            return function(*args, **options)

        return called_as(call, name)

    def layers(self, where: Callable[[Any], str]) -> Mapping[type, type]:
        """Return the classes of open files, by the class of Python that each is derived from.

        Args:
            where: makes a path of the program absolute.
        """
        kinds = (io.BufferedReader, io.BufferedWriter, io.BufferedRandom, io.TextIOWrapper)
        return {kind: self._with_points(kind, where) for kind in kinds}

    def _with_points(self, kind: type, where: Callable[[Any], str]) -> type:
        points = self
        base = cast("type[io.BufferedRandom]", kind)

        class Pointed(base):  # type: ignore[valid-type, misc]  # mypy does not follow a class that is an argument
            __doc__ = kind.__doc__
            _is_read = _is_closing = False

            def _reads(this) -> None:
                """Let other tasks run before the first read, which fills the buffer."""
                if not this._is_read:
                    this._is_read = True
                    this._access(False)

            def _access(this, is_write: bool) -> None:
                if isinstance(this.name, _PATHS):
                    points.access(where(this.name), is_write)
                else:
                    points.pause()

            def read(this, *args: Any) -> Any:
                this._reads()
                return super().read(*args)

            def readline(this, *args: Any) -> Any:
                this._reads()
                return super().readline(*args)

            def flush(this) -> None:
                if not (this._is_closing or this.closed) and this.writable():
                    this._access(True)
                super().flush()

            def close(this) -> None:
                # not while the garbage collector closes it, at any place
                if not (this.closed or getattr(this, "_finalizing", False)) and this.writable():
                    this._access(True)
                this._is_closing = True
                super().close()

        Pointed.__name__ = Pointed.__qualname__ = kind.__name__
        Pointed.__module__ = kind.__module__
        return Pointed


def file_points(kernel: Kernel) -> FilePoints | None:
    """Return the points of a program; None for a kernel that asks no policy."""
    return FilePoints(kernel) if isinstance(kernel, ExploringKernel) else None
