"""`open` of a program, working on the files of its run, and the program's open files.

They are flushed and closed when the program ends. The garbage collector would close the layers of a file in any order
and could lose the rest of its buffer.
"""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from itertools import count
from typing import IO, TYPE_CHECKING, Any
from weakref import WeakValueDictionary

from cfepy.nodes.files.stamps import BLOCK, Key, key_of

if TYPE_CHECKING:
    from cfepy.nodes.files.file_points import FilePoints
    from cfepy.nodes.files.overlay import Overlay

_Opener = Callable[[Any, int], int]
_STDERR = 2  # the last of the standard streams
_PATHS = (str, bytes, os.PathLike)
_FLAGS = {"r": os.O_RDONLY, "w": os.O_CREAT | os.O_TRUNC, "x": os.O_CREAT | os.O_EXCL, "a": os.O_CREAT | os.O_APPEND}


class RunFile(io.FileIO):
    """A raw file of a run; writes to it are reported to the overlay.

    Args:
        descriptor: descriptor of the open file.
        mode: as for `io.FileIO`.
        closefd: whether the descriptor is closed with the file.
        name: its path as it was given; None for none.
        overlay: files of the run.
    """

    def __init__(self, descriptor: int, mode: str, closefd: bool, name: Any, overlay: Overlay) -> None:
        super().__init__(descriptor, mode, closefd)
        if name is not None:
            self.name = name
        self._key: Key = key_of(os.fstat(descriptor))
        self._stamps = overlay.stamps

    def write(self, data: Any) -> int:
        self._stamps.written(self._key)
        return super().write(data)

    def truncate(self, size: int | None = None) -> int:
        self._stamps.written(self._key)
        return super().truncate(size)


class OpenFiles:
    """Open files of one program.

    Args:
        where: makes a path of the program absolute.
        overlay: files of its run; None for the host's files.
        points: where other tasks may run; None for nowhere.

    Attributes:
        raw_type: `io.FileIO` of the program.
    """

    def __init__(
        self, where: Callable[[Any], str], overlay: Overlay | None = None, points: FilePoints | None = None
    ) -> None:
        self._where = where
        self._overlay = overlay
        self._points = points
        self._layers: Mapping[type, type] = {} if points is None else points.layers(where)
        self.raw_type = io.FileIO if overlay is None else self._raw_class(overlay)
        self._files: WeakValueDictionary[int, IO[Any]] = WeakValueDictionary()
        self._numbers = count()

    def opener(self) -> Callable[..., IO[Any]]:
        """Return the program's `open`, with paths relative to its working directory."""

        def open_file(
            file: Any,
            mode: str = "r",
            buffering: int = -1,
            encoding: str | None = None,
            errors: str | None = None,
            newline: str | None = None,
            closefd: bool = True,
            opener: _Opener | None = None,
        ) -> IO[Any]:
            texts = {"encoding": encoding, "errors": errors, "newline": newline}
            if self._overlay is None or not isinstance(file, _PATHS):
                place = self._where(file) if isinstance(file, _PATHS) else _own(file)
                opened: IO[Any] = open(place, mode, buffering, closefd=closefd, opener=opener, **texts)  # noqa: SIM115
            else:
                _check(mode, buffering, closefd, texts)
                if self._points is not None:
                    self._points.access(self._where(file), "r" not in mode or "+" in mode)
                raw = self.raw_type(file, mode.replace("b", "").replace("t", ""), closefd, opener)
                opened = _layered(raw, mode, buffering, texts, self._layers)
            self._files[next(self._numbers)] = opened
            return opened

        return open_file

    def _raw_class(self, overlay: Overlay) -> type[io.FileIO]:
        """`io.FileIO` of the program."""

        class FileIO(RunFile):
            __doc__ = io.FileIO.__doc__

            def __init__(this, file: Any, mode: str = "r", closefd: bool = True, opener: _Opener | None = None) -> None:
                if isinstance(file, int):
                    super().__init__(_own(file), mode, closefd, None, overlay)
                    return
                _check(f"{mode.replace('b', '')}b", 0, closefd, {})
                path = os.fspath(file)
                descriptor = self._descriptor(overlay, path, mode, opener)
                try:
                    super().__init__(descriptor, mode, True, path, overlay)
                except OSError as error:  # a folder
                    os.close(descriptor)
                    error.filename = path
                    raise

        FileIO.__qualname__, FileIO.__module__ = "FileIO", "_io"
        return FileIO

    def _descriptor(self, overlay: Overlay, path: str | bytes, mode: str, opener: _Opener | None) -> int:
        plain = mode.replace("b", "").replace("t", "")
        flags = _FLAGS[plain.replace("+", "")] | getattr(os, "O_CLOEXEC", 0)
        flags |= os.O_RDWR if "+" in plain else os.O_RDONLY if "r" in plain else os.O_WRONLY
        if opener is not None:
            return opener(path, flags)
        try:
            return overlay.open(self._where(path), flags, 0o666)
        except OSError as error:
            error.filename = path
            raise

    def close_all(self) -> None:
        """Close all files at the end of the program; errors such as a full disk are ignored."""
        for opened in list(self._files.values()):
            with suppress(OSError, ValueError):
                opened.close()


def _own(file: Any) -> Any:
    """Return a descriptor that the program may close: a copy of the host's standard streams, any other as it is."""
    return os.dup(file) if isinstance(file, int) and 0 <= file <= _STDERR else file


def _check(mode: str, buffering: int, closefd: bool, texts: dict[str, str | None]) -> None:
    """Check the arguments as `io.open` does, before a file is created.

    Raises:
        ValueError: if the arguments contradict each other.
    """
    if not isinstance(mode, str):
        raise TypeError(f"open() argument 'mode' must be str, not {type(mode).__name__}")
    kinds = set(mode)
    if kinds - set("rwxab+t") or len(mode) > len(kinds):
        raise ValueError(f"invalid mode: {mode!r}")
    if {"b", "t"} <= kinds:
        raise ValueError("can't have text and binary mode at once")
    if len(kinds & set("rwxa")) != 1:
        raise ValueError("must have exactly one of create/read/write/append mode")
    for name, value in texts.items():
        if "b" in kinds and value is not None:
            raise ValueError(f"binary mode doesn't take {'an' if name[0] == 'e' else 'a'} {name} argument")
    if buffering == 0 and "b" not in kinds:
        raise ValueError("can't have unbuffered text I/O")
    if not closefd:
        raise ValueError("Cannot use closefd=False with file name")


def _layered(raw: io.FileIO, mode: str, buffering: int, texts: dict[str, Any], layers: Mapping[type, type]) -> IO[Any]:
    """Return a raw file with its buffer and its text.

    Args:
        raw: the raw file.
        mode: as for `open`.
        buffering: as for `open`.
        texts: encoding and the like, as for `open`.
        layers: the class of the outermost layer, by Python's class; Python's own class if it is missing.
    """
    if buffering == 0:
        return raw  # as `io.open` does
    is_line = buffering == 1 or (buffering < 0 and raw.isatty())
    size = buffering if buffering > 1 else BLOCK
    try:
        kind: type = io.BufferedRandom if "+" in mode else io.BufferedReader if "r" in mode else io.BufferedWriter
        if "b" in mode:
            return layers.get(kind, kind)(raw, size)  # type: ignore[no-any-return]
        text = layers.get(io.TextIOWrapper, io.TextIOWrapper)(kind(raw, size), line_buffering=is_line, **texts)
    except BaseException:
        raw.close()
        raise
    text.mode = mode
    return text  # type: ignore[no-any-return]
