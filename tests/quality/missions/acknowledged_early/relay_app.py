"""Switches a relay when a packet says so, and acknowledges."""

from cfepy.app import Cfe
from cfepy.msg import telemetry

SWITCH_MID, SWITCHED_MID = 0x0891, 0x0892


def RELAY_AppMain(cfe: Cfe) -> None:
    pipe = cfe.sb.create_pipe(4, "RELAY_PIPE")
    cfe.sb.subscribe(SWITCH_MID, pipe)
    while cfe.es.run_loop():
        if cfe.sb.receive_buffer(pipe) is not None:
            cfe.sb.transmit_msg(telemetry(SWITCHED_MID))
