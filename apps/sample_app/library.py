"""Calls the sample library by its function's name, as the dynamic linker does in C.

It is separate from the app, because an application that `cfepy new` makes from it has no library.
"""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.status import OsalError

FUNCTION = "SAMPLE_LIB_Function"


def call_library(cfe: Cfe) -> None:
    """Call the library. If the startup script did not load it, write that to the system log."""
    try:
        function = cfe.os.symbol_lookup(FUNCTION)
    except OsalError:
        cfe.es.write_to_sys_log(f"Sample App: no library has {FUNCTION}")
        return
    if not callable(function):
        cfe.es.write_to_sys_log(f"Sample App: {FUNCTION} is compiled, and only compiled applications can call it")
        return
    function(cfe)
