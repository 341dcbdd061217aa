"""STAR_TRACKER: works once a second, until a command makes it wait for ever; HS notices, and starts it anew."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.msg import Command
from cfepy.sb import PEND_FOREVER

CMD_MID = 0x18D2
PERIOD_MS = 1000
INIT_EID = 1

HANG = Command("STAR_TRACKER_HANG", CMD_MID, 1, text="Makes it wait for what never comes.")
COMMANDS = (HANG,)


def STAR_TRACKER_Main(cfe: Cfe) -> None:
    """Run the application; the startup script names this function."""
    cfe.evs.register()
    pipe = cfe.sb.create_pipe(10, "TRACKER_PIPE")
    cfe.sb.subscribe(CMD_MID, pipe)
    never = cfe.sb.create_pipe(1, "TRACKER_NEVER")
    cfe.evs.send_info(INIT_EID, "STAR_TRACKER: looking at stars")
    while cfe.es.run_loop():
        cfe.os.task_delay(PERIOD_MS)
        if cfe.sb.receive_buffer(pipe, 0) is not None:
            cfe.sb.receive_buffer(never, PEND_FOREVER)
    cfe.es.exit_app()
