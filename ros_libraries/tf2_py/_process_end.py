"""The ends of a process in tf2's C++ core: a value that it does not check ends ROS's node, and so it ends here.

Imports tf2_py only. The status is the one that a shell shows: 128 and the number of the signal.
"""

from __future__ import annotations

import os
import sys
from typing import Any, NoReturn

_ABORTED = 128 + 6
_SEGMENTATION_FAULT = 128 + 11


def terminate(kind: str, text: str) -> NoReturn:
    """End the process by an exception of C++ that no code catches.

    Args:
        kind: the exception's class.
        text: its `what()`.
    """
    print(f"terminate called after throwing an instance of '{kind}'\n  what():  {text}", file=sys.stderr)
    os._exit(_ABORTED)


def part_of(value: Any, name: str) -> Any:
    """Return an attribute. C++ reads the memory of one that is missing, which ends the process."""
    try:
        return getattr(value, name)
    except AttributeError:
        note = f"cfepy: tf2 got a {type(value).__name__} without `{name}`. On ROS, a segmentation fault ends the node."
        print(note, file=sys.stderr)
        os._exit(_SEGMENTATION_FAULT)


def text_of(value: Any) -> str:
    """Return a text as C++ has it, which ends before a zero byte. Another value ends the process."""
    try:
        return str(value.encode().partition(b"\0")[0], "utf-8")
    except (AttributeError, UnicodeEncodeError):
        terminate("std::logic_error", "basic_string: construction from null is not valid")
