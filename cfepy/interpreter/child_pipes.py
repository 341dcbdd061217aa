"""Pipe ends that a process passes to a child: by descriptor, and on Windows by handle.

The parent passes the number of an end as an argument and gives `popen_options` to `subprocess.Popen`. The child takes
over the end by its number.
"""

from __future__ import annotations

import os
import subprocess
import sys
from multiprocessing import connection as ends
from multiprocessing.connection import Connection
from typing import Any


def popen_options(number: int) -> dict[str, Any]:
    """Return the options of `subprocess.Popen` that pass an end to the child.

    Args:
        number: the end's `fileno()`, or the result of `number_of` for a descriptor.
    """
    if sys.platform != "win32":
        return {"pass_fds": [number]}
    os.set_handle_inheritable(number, True)
    return {"startupinfo": subprocess.STARTUPINFO(lpAttributeList={"handle_list": [number]})}


def number_of(descriptor: int) -> int:
    """Return the number of a descriptor of this process for use in another process."""
    if sys.platform != "win32":
        return descriptor
    import msvcrt

    return msvcrt.get_osfhandle(descriptor)


def descriptor_of(number: int) -> int:
    """Return the descriptor of an end; called in the child."""
    if sys.platform != "win32":
        return number
    import msvcrt

    return msvcrt.open_osfhandle(number, os.O_BINARY)


def connection_of(number: int) -> Connection[Any, Any]:
    """Return the end of a `multiprocessing.Pipe`; called in the child, whose own children do not inherit it."""
    if sys.platform != "win32":
        os.set_inheritable(number, False)
        return Connection(number)
    os.set_handle_inheritable(number, False)
    made: Connection[Any, Any] = ends.PipeConnection(number)
    return made
