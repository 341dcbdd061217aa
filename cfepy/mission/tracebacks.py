"""Tracebacks as the author of an app wants them: the lines of the app, without those of cfepy around them."""

from __future__ import annotations

import re
import traceback
from pathlib import Path

from cfepy.interpreter.own_code import PACKAGE, source_file
from cfepy.nodes.node_tracebacks import strip
from cfepy.reading.texts import without_addresses

SHARED = str(Path(PACKAGE) / "share")
_PLACE = re.compile(r"\([^\s():]+:\d+\)")
FILES = 4096  # of which it is remembered whose they are
INNERMOST = 50  # frames that are shown: how deep a runaway recursion gets differs between task contexts


def app_traceback(error: BaseException) -> str:
    """The formatted traceback of an error and its causes, without frames of cfepy; all when nothing would be left."""
    text = traceback.TracebackException.from_exception(error, limit=-INNERMOST)
    whole = list(text.stack)
    strip(text, _is_ours)
    if not text.stack and not isinstance(error, SyntaxError):  # that one names its place by itself
        text.stack = traceback.StackSummary.from_list(whole)
    return "".join(text.format()).rstrip()


def reason(error: BaseException) -> str:
    """The last line of a traceback, with the place: `ValueError: no such joint (arm.py:12)`.

    Of a text of several lines, it is the first. One that names a place of its own stays as it is: a fault in C does.
    """
    frames = traceback.extract_tb(error.__traceback__, limit=-INNERMOST)
    own = [frame for frame in frames if not _is_ours(frame.filename)] or frames
    what = without_addresses(traceback.format_exception_only(error)[-1]).strip().partition("\n")[0].rstrip(":")
    place = f"{Path(own[-1].filename).name}:{own[-1].lineno}" if own and own[-1].lineno else ""
    return f"{what} ({place})" if place and not _PLACE.search(what) else what


def described(error: BaseException) -> str:
    """Type and text of an error, also when its own `__str__` fails."""
    try:
        return f"{type(error).__name__}: {error}"
    except Exception:
        return f"{type(error).__name__}: its text is not available"


def _is_ours(file: str) -> bool:
    file = source_file(file)
    return file.startswith((PACKAGE, "<frozen")) and not file.startswith(SHARED)
