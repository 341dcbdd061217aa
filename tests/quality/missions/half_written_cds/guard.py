"""Resets the processor once, when it was told so."""

from cfepy.app import Cfe
from cfepy.psp.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR

RESET_MID = 0x0891


def GUARD_AppMain(cfe: Cfe) -> None:
    pipe = cfe.sb.create_pipe(4, "GUARD_PIPE")
    cfe.sb.subscribe(RESET_MID, pipe)
    while cfe.es.run_loop():
        cfe.sb.receive_buffer(pipe)
        if cfe.es.get_reset_type().reset_type == RST_TYPE_POWERON:
            cfe.es.reset_cfe(RST_TYPE_PROCESSOR)
