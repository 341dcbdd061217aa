"""Gives an order at the tick, and expects it to be done."""

from cfepy.app import Cfe
from cfepy.msg import telemetry

TICK_MID, ORDER_MID, DONE_MID = 0x0890, 0x0891, 0x0892


def BOSS_AppMain(cfe: Cfe) -> None:
    cfe.evs.register()
    ticks, done = cfe.sb.create_pipe(4, "BOSS_TICKS"), cfe.sb.create_pipe(4, "BOSS_DONE")
    cfe.sb.subscribe(TICK_MID, ticks)
    cfe.sb.subscribe(DONE_MID, done)
    while cfe.es.run_loop():
        cfe.sb.receive_buffer(ticks)
        cfe.sb.transmit_msg(telemetry(ORDER_MID))
        if cfe.sb.receive_buffer(done, 200) is None:
            cfe.evs.send_err(1, "the order was not carried out")
