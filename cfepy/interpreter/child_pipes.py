"""Ends of pipes that a process hands to one that it starts: by descriptor, and on Windows by handle.

The number of an end goes to the other process as an argument, and `popen_options` to `subprocess.Popen`; there the end
is taken over by its number.
"""

from __future__ import annotations

import os
import subprocess
import sys
from multiprocessing import connection as ends
from multiprocessing.connection import Connection
from typing import Any


def popen_options(number: int) -> dict[str, Any]:
    """What `subprocess.Popen` needs to hand over an end, whose `fileno()` this is; see `number_of` for a descriptor."""
    if sys.platform != "win32":
        return {"pass_fds": [number]}
    os.set_handle_inheritable(number, True)
    return {"startupinfo": subprocess.STARTUPINFO(lpAttributeList={"handle_list": [number]})}


def number_of(descriptor: int) -> int:
    """The number by which another process knows a descriptor of this one."""
    if sys.platform != "win32":
        return descriptor
    import msvcrt

    return msvcrt.get_osfhandle(descriptor)


def descriptor_of(number: int) -> int:
    """In the other process: the descriptor of an end."""
    if sys.platform != "win32":
        return number
    import msvcrt

    return msvcrt.open_osfhandle(number, os.O_BINARY)


def connection_of(number: int) -> Connection[Any, Any]:
    """In the other process: the end of a `multiprocessing.Pipe`; processes that this one starts do not inherit it."""
    if sys.platform != "win32":
        os.set_inheritable(number, False)
        return Connection(number)
    os.set_handle_inheritable(number, False)
    made: Connection[Any, Any] = ends.PipeConnection(number)
    return made
