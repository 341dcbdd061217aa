"""How SAMPLE_APP reaches the sample library: by the name of its function, as the dynamic linker does in C.

Apart from the app, since an application that `cfepy new` makes from it has no library.
"""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.status import OsalError

FUNCTION = "SAMPLE_LIB_Function"


def call_library(cfe: Cfe) -> None:
    """Call the library; when the startup script did not load it, the system log says so."""
    try:
        function = cfe.os.symbol_lookup(FUNCTION)
    except OsalError:
        cfe.es.write_to_sys_log(f"Sample App: no library has {FUNCTION}")
        return
    function(cfe)
