"""Tracebacks for the author of an app: the lines of the app, without the surrounding lines of cfepy."""

from __future__ import annotations

import re
import traceback
from pathlib import Path

from cfepy.interpreter.own_code import PACKAGE, source_file
from cfepy.nodes.node_tracebacks import strip
from cfepy.reading.texts import without_addresses

SHARED = str(Path(PACKAGE) / "share")
_PLACE = re.compile(r"\([^\s():]+:\d+\)")
FILES = 4096  # number of files whose owner is cached
INNERMOST = 50  # maximum number of frames shown, because the depth of a runaway recursion depends on the task context


def app_traceback(error: BaseException) -> str:
    """Return the formatted traceback of an error and its causes, without cfepy's frames, unless nothing would
    be left.
    """
    text = traceback.TracebackException.from_exception(error, limit=-INNERMOST)
    whole = list(text.stack)
    strip(text, _is_ours)
    if not text.stack and not isinstance(error, SyntaxError):  # a SyntaxError names its place itself
        text.stack = traceback.StackSummary.from_list(whole)
    return "".join(text.format()).rstrip()


def reason(error: BaseException) -> str:
    """Return the last line of a traceback, with the place: `ValueError: no such joint (arm.py:12)`.

    If the text has several lines, only the first is used. A text that already names a place, such as a fault in C, is
    kept.
    """
    frames = traceback.extract_tb(error.__traceback__, limit=-INNERMOST)
    own = [frame for frame in frames if not _is_ours(frame.filename)] or frames
    what = without_addresses(traceback.format_exception_only(error)[-1]).strip().partition("\n")[0].rstrip(":")
    place = f"{Path(own[-1].filename).name}:{own[-1].lineno}" if own and own[-1].lineno else ""
    return f"{what} ({place})" if place and not _PLACE.search(what) else what


def described(error: BaseException) -> str:
    """Return the type and text of an error, even if its `__str__` fails."""
    try:
        return f"{type(error).__name__}: {error}"
    except Exception:
        return f"{type(error).__name__}: its text is not available"


def _is_ours(file: str) -> bool:
    file = source_file(file)
    return file.startswith((PACKAGE, "<frozen")) and not file.startswith(SHARED)
