"""Carries out orders, and says when one is done."""

from cfepy.app import Cfe
from cfepy.msg import telemetry

TICK_MID, ORDER_MID, DONE_MID = 0x0890, 0x0891, 0x0892


def WORKER_AppMain(cfe: Cfe) -> None:
    pipe = cfe.sb.create_pipe(8, "WORKER_PIPE")
    for mid in (TICK_MID, ORDER_MID):
        cfe.sb.subscribe(mid, pipe)
    while cfe.es.run_loop():
        packet = cfe.sb.receive_buffer(pipe)
        if packet is not None and packet[:2] == ORDER_MID.to_bytes(2, "big"):
            cfe.sb.transmit_msg(telemetry(DONE_MID))
