"""The exceptions of procedures: a failed check, a skipped or stopped script, and a function beyond this add-on."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType


class CheckError(RuntimeError):
    """A check of a procedure failed."""


class SkipScript(Exception):
    """The procedure skips the rest of a test."""


class StopScript(Exception):
    """The procedure ends."""


class RefusedError(Exception):
    """A procedure uses a function of COSMOS that this add-on does not have."""


def place_in(trace: TracebackType | None, files: set[str]) -> str:
    """Return the innermost line of a procedure in a traceback as "FILE:LINE", or an empty text.

    Args:
        trace: the traceback.
        files: paths of the procedures' files.
    """
    found = ""
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if file in files:
            found = f"{_short(file)}:{trace.tb_lineno}"
        trace = trace.tb_next
    return found


def _short(file: str) -> str:
    path = Path(file)
    try:
        return str(path.relative_to(Path.cwd()))
    except ValueError:
        return file
