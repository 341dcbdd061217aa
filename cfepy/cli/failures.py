"""Messages that several commands share: a file cannot be written, or a run did not do what was asked."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from cfepy.status import UsageError


@contextmanager
def writing(file: str | Path, option: str) -> Iterator[None]:
    """Around what writes a file.

    Args:
        file: its path.
        option: that named it.

    Raises:
        UsageError: in place of the OSError that says why it cannot be written.
    """
    try:
        yield
    except OSError as error:
        raise UsageError(f"cannot be written: {error.strerror}", file=file, field=option) from None


def tell(texts: Iterable[object]) -> None:
    """Write lines to standard error, after all that went to standard output."""
    sys.stdout.flush()
    for text in texts:
        print(f"cfepy: {text}", file=sys.stderr, flush=True)
