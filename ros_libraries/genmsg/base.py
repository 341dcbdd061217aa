"""Constants of the definition language, the two errors, and the output that `log_verbose` enables."""

from __future__ import annotations

import pprint
import sys
from typing import Any

SEP = "/"
MSG_DIR, SRV_DIR = "msg", "srv"
EXT_MSG, EXT_SRV = ".msg", ".srv"
CONSTCHAR, COMMENTCHAR, IODELIM = "=", "#", "---"

verbose = False


class InvalidMsgSpec(Exception):  # ROS's name
    """A definition with a mistake."""


class MsgGenerationException(Exception):  # ROS's name
    """Code cannot be generated."""


def log_verbose(value: bool) -> None:
    """Enable or disable the output of `log` and `plog`."""
    global verbose
    verbose = value


def log(*args: Any) -> None:
    """Say something on stderr, with the place in the code."""
    if verbose:
        print(f"{_caller()}\n{' '.join(map(str, args))}", file=sys.stderr)


def plog(msg: str, obj: Any) -> None:
    """Say something on stderr, followed by an object."""
    if verbose:
        print(f"{_caller()}\n{msg}  ", file=sys.stderr)
        pprint.pprint(obj, stream=sys.stderr)


def _caller() -> str:
    frame = sys._getframe(2)
    return f"{frame.f_code.co_filename}:{frame.f_lineno}"
