"""Ctrl-C before the command `cfepy` can handle it, or after: the process ends at once, without a traceback.

Python answers an interrupt during an import with a traceback, so the package `cfepy` calls this module first. It
affects only the process of the command. A program that uses cfepy as a library keeps its own handler.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # importing `signal` takes longer than all that is done before
import os
import sys

INTERRUPTED = 130  # 128 + SIGINT, as shells expect
_SCRIPTS = ("cfepy", "cfepy.exe", "cfepy-script.py", "cfepy-script.pyw")  # the names that pip gives its scripts


def is_command() -> bool:
    """Return whether this process is the command, as `cfepy` or as `python -m cfepy`."""
    if sys.argv[:1] == ["-m"]:  # Python is still looking for the module of -m
        words = sys.orig_argv
        return words[words.index("-m") :][1:2] == ["cfepy"] if "-m" in words else "-mcfepy" in words
    return bool(sys.argv) and os.path.basename(sys.argv[0]) in _SCRIPTS


def leave(*_: object) -> None:
    """End the process, as the handler of a signal while there is nothing to clean up."""
    os._exit(INTERRUPTED)


def leave_on_interrupt() -> None:
    """Make SIGINT end the process at once from here on, unless it is ignored or has a handler of its own."""
    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, leave)
