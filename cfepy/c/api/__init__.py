"""The public functions of OSAL, the PSP and cFE in C's terms: a module for each service.

Each module has `declare(api, c)`, which adds its functions to the API: name, signature (`engine/calls.c` tells the
letters), the Python function that answers, and the status for a NULL pointer where there must not be one. Functions
raise `CfeError` or `OsalError` for a status, as the services do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.c.api import es, evs, sb, text

if TYPE_CHECKING:
    from cfepy.c.calls import Declarations
    from cfepy.c.runtime import CRuntime


def declare(api: Declarations, c: CRuntime) -> None:
    """Add all functions.

    Args:
        api: where they are added.
        c: the C side of the processor that answers.
    """
    for module in (text, es, evs, sb):
        module.declare(api, c)
