"""Tracebacks as the author of an app wants them: the lines of the app, without those of cfepy around them."""

from __future__ import annotations

import traceback
from pathlib import Path

PACKAGE = str(Path(__file__).resolve().parents[1])
SHARED = str(Path(PACKAGE) / "share")


def app_traceback(error: BaseException) -> str:
    """The formatted traceback of an error, frames of cfepy left out; all of it when nothing else would be left."""
    text = traceback.TracebackException.from_exception(error)
    kept = [frame for frame in text.stack if not _is_ours(frame.filename)]
    if kept:
        text.stack = traceback.StackSummary.from_list(kept)
    return "".join(text.format()).rstrip()


def reason(error: BaseException) -> str:
    """The last line of a traceback, with the place: `ValueError: no such joint (arm.py:12)`."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if not _is_ours(frame.filename)] or frames
    what = traceback.format_exception_only(error)[-1].strip()
    return f"{what} ({Path(own[-1].filename).name}:{own[-1].lineno})" if own else what


def _is_ours(file: str) -> bool:
    return file.startswith((PACKAGE, "<frozen")) and not file.startswith(SHARED)
