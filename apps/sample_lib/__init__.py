"""SAMPLE_LIB, the smallest cFE library: an init function, and a function for apps to call. NASA's sample_lib v7.0.0.

A library is code that a startup script loads before the apps (CFE_LIB). Its functions run in the task of the calling
app. An app finds a function by its name with `cfe.os.symbol_lookup`, which the dynamic linker does in C.
"""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.config.versions import version_string
from cfepy.status import CFE_SUCCESS

VERSION = version_string("Sample Lib")
BUFFER = "SAMPLE DATA"


def SAMPLE_LIB_Init(cfe: Cfe) -> int:
    """Initialize the library; the startup script names this function.

    A result other than CFE_SUCCESS unloads the library.
    """
    cfe.os.printf(f"SAMPLE Lib Initialized.{VERSION}\n")
    return CFE_SUCCESS


def SAMPLE_LIB_Function(cfe: Cfe) -> int:
    """Print the library's buffer.

    Args:
        cfe: the handle of the calling app.
    """
    cfe.os.printf(f"SAMPLE_LIB_Function called, buffer='{BUFFER}'\n")
    return CFE_SUCCESS
