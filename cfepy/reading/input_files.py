"""Opening and reading of input files from others: the only way for cfepy to read inputs.

A file must be a regular file. A device or a pipe may never end, and opening a pipe may wait forever. The exception is a
descriptor that the caller of the command passed, such as `/dev/stdin`, or the `/dev/fd/63` of `<(...)` in a shell. A
path on the command line may be a descriptor; a path inside a file may not.

Reading never waits. A system file without data to read yet, such as `/proc/kmsg`, is refused. The limits of
`cfepy.reading.input_limits` set the maximum sizes.
"""

from __future__ import annotations

import os
import re
import stat
from errno import ENOENT
from io import BufferedReader
from pathlib import Path

from cfepy.reading.suggestions import like
from cfepy.status import UsageError

_DESCRIPTOR = re.compile(r"/dev/stdin|/dev/fd/\d+|/proc/self/fd/\d+")
_PIECE = 1 << 16
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)


def open_input(path: str | Path, *, handed: bool = False) -> BufferedReader:
    """Open a file for reading.

    Args:
        path: the file.
        handed: whether the path is from the command line, which may pass a descriptor.

    Returns:
        The open file.

    Raises:
        UsageError: if it is a device or a pipe, or the path is not legal.
        OSError: if it cannot be opened or is a folder.
    """
    if handed and _DESCRIPTOR.fullmatch(str(path)):
        return open(path, "rb")
    try:
        found = os.stat(path)
    except ValueError:  # the path has a NUL or a surrogate
        raise UsageError(f"invalid path {str(path)!r}; correct it") from None
    _check_kind(found, path)
    file = open(path, "rb", opener=lambda name, _: os.open(name, _FLAGS))  # noqa: SIM115  # the caller closes it
    try:
        _check_kind(os.fstat(file.fileno()), path)  # the path may refer to another file by now
    except UsageError:
        file.close()
        raise
    return file


def _check_kind(found: os.stat_result, path: str | Path) -> None:
    if not stat.S_ISREG(found.st_mode) and not stat.S_ISDIR(found.st_mode):  # reading a folder fails later, as usual
        raise UsageError("is a device or a pipe, not a file; name a file", file=path)


def unreadable(path: str | Path, error: OSError) -> UsageError:
    """Return the error to raise about a file that cannot be read, with the name of a similar file if it is missing.

    Args:
        path: the file.
        error: the error of the operating system.
    """
    hint = ""
    if error.errno == ENOENT:
        wanted = Path(path)
        near = like(wanted.name, _names_near(wanted))
        hint = f"; did you mean {wanted.parent / near[0]}?" if near else "; check the path"
    return UsageError(f"cannot be read: {error.strerror}{hint}", file=path)


def unwritable(path: str | Path, error: OSError, option: str | None = None) -> UsageError:
    """Return the error to raise about a file that cannot be written, with the folder to create if it is missing.

    Args:
        path: the file.
        error: the error of the operating system.
        option: the option that names the file; None if no option does.
    """
    folder = Path(path).parent
    is_missing = error.errno == ENOENT and not folder.exists()
    hint = f"; create the folder {folder} first" if is_missing else ""
    return UsageError(f"cannot be written: {error.strerror or error}{hint}", file=path, field=option)


def _names_near(path: Path) -> list[str]:
    try:
        return sorted(os.listdir(path.parent))
    except (OSError, ValueError):
        return []


def read_limited(path: str | Path, most: int, *, handed: bool = False) -> bytes:
    """Read a file.

    Args:
        path: the file.
        most: maximum number of bytes.
        handed: see `open_input`.

    Returns:
        Its content.

    Raises:
        UsageError: if it has more bytes; otherwise see `open_input`.
        OSError: if it cannot be read.
    """
    parts: list[bytes] = []
    with open_input(path, handed=handed) as file:
        size = os.fstat(file.fileno()).st_size
        piece = max(size + 1, _PIECE)
        while size <= most:
            part = file.read(piece)
            if part is None:
                raise UsageError("is not ready for reading and may never be; name a file", file=path)
            if not part:
                return b"".join(parts) if len(parts) > 1 else parts[0] if parts else b""
            parts.append(part)
            size = max(size, sum(map(len, parts)))
    raise UsageError(f"has more than the limit of {most:,} bytes; make it smaller", file=path)


def text_limited(path: str | Path, most: int, errors: str = "strict", *, handed: bool = False) -> str:
    """Read a text file in UTF-8; see `read_limited` for further errors.

    Args:
        path: the file.
        most: maximum number of bytes.
        errors: the treatment of bytes that are not UTF-8, as in `bytes.decode`.
        handed: see `open_input`.

    Returns:
        The text, with "\\n" at the end of each line.

    Raises:
        UnicodeDecodeError: if it is not UTF-8 and `errors` is "strict".
    """
    text = read_limited(path, most, handed=handed).decode("utf-8", errors)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def beginning_of(path: str | Path, count: int) -> bytes:
    """Read the first bytes of a file, to determine its type.

    Args:
        path: the file.
        count: number of bytes.

    Returns:
        The bytes; empty if the path is not a readable file.
    """
    try:
        with open_input(path) as file:
            return file.read(count) or b""
    except (OSError, UsageError):
        return b""
