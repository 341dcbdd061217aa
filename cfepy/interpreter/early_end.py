"""Ctrl-C where the command `cfepy` cannot answer it yet, or no more: the process ends at once, without a traceback.

Python answers an interrupt while it loads a module with a traceback of that, so the package `cfepy` calls this first of
all. A program that uses cfepy as a library keeps what it has: only the process of the command is concerned.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # importing `signal` takes longer than all that is done before
import os
import sys

INTERRUPTED = 130  # 128 + SIGINT, what shells expect
_SCRIPTS = ("cfepy", "cfepy.exe", "cfepy-script.py", "cfepy-script.pyw")  # as pip calls what it makes


def is_command() -> bool:
    """Whether this process is the command, as `cfepy` or as `python -m cfepy`."""
    if sys.argv[:1] == ["-m"]:  # the module that is meant is being looked for
        words = sys.orig_argv
        return words[words.index("-m") :][1:2] == ["cfepy"] if "-m" in words else "-mcfepy" in words
    return bool(sys.argv) and os.path.basename(sys.argv[0]) in _SCRIPTS


def leave(*_: object) -> None:
    """End the process: the answer to a signal while there is nothing to be tidied up."""
    os._exit(INTERRUPTED)


def leave_on_interrupt() -> None:
    """From here on SIGINT ends the process at once, unless it is ignored or answered in another way."""
    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, leave)
