"""Messages that several commands share: a file cannot be written, or a run did not do all that was asked of it."""

from __future__ import annotations

import errno
import os
import re
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cfepy.reading.input_files import unwritable

_LEFT_OUT = re.compile(r"node (/\S+) is left out: ")
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
"""Errors of a full or broken disk."""


@contextmanager
def writing(file: str | Path, option: str) -> Iterator[None]:
    """Convert errors of writing a file, as a context manager.

    Args:
        file: its path.
        option: the option that named it.

    Raises:
        UsageError: the file cannot be written; replaces the OSError.
    """
    try:
        yield
    except BrokenPipeError:  # of standard output, to which the caller writes as well
        raise
    except OSError as error:
        discard_half_written(file, error)
        raise unwritable(file, error, option) from None


def check_writable(file: str | Path, option: str) -> None:
    """Check before a run that a file can be written; leave no file behind.

    Raises:
        UsageError: it cannot be written.
    """
    is_new = not os.path.exists(file)
    with writing(file, option):
        open(file, "a", encoding="utf-8").close()
        if is_new:
            os.unlink(file)


def discard_half_written(file: str | Path, error: OSError) -> None:
    """Remove a file that is truncated because the disk is full; a program must not take it for a whole one."""
    if error.errno in NO_ROOM and os.path.isfile(file):
        with suppress(OSError):
            os.unlink(file)


def tell(texts: Iterable[object]) -> None:
    """Write lines to standard error, after all output to standard output."""
    sys.stdout.flush()
    for text in texts:
        print(f"cfepy: {text}", file=sys.stderr, flush=True)


def tell_briefly(notes: Iterable[str]) -> None:
    """Write the notes of a mission that a command looks at: one line for all nodes that are left out.

    `cfepy check`, `run` and `launch` give the reasons.
    """
    lines = list(notes)
    tell(each for each in lines if _LEFT_OUT.search(each) is None)
    names = left_out_nodes(lines)
    if names:
        tell([f"left out: {', '.join(names)}; `cfepy check` gives the reasons"])


def left_out_nodes(notes: Iterable[str]) -> list[str]:
    """Return the names of the nodes of launch files that a mission does not have, by its notes."""
    found = (_LEFT_OUT.search(each) for each in notes)
    return list(dict.fromkeys(each[1] for each in found if each is not None))


def note(text: str) -> None:
    """Write a message for the user that is not a failure; it takes the same way."""
    tell([text])
