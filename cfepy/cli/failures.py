"""What several commands say alike when a mission does not boot, or a file cannot be written."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cfepy.status import CfeError, UsageError


@contextmanager
def booting(script: Path) -> Iterator[None]:
    """Around what boots a mission.

    Args:
        script: its startup script.

    Raises:
        UsageError: in place of the CfeError that says why it does not boot.
    """
    try:
        yield
    except CfeError as error:
        raise UsageError(f"the mission cannot boot: {error}", file=script) from error


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
