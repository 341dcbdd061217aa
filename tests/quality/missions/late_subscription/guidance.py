"""Asks the star tracker once, and listens for the answer."""

from cfepy.app import Cfe
from cfepy.msg import telemetry

REQUEST_MID, REPLY_MID = 0x0891, 0x0892


def GUIDANCE_AppMain(cfe: Cfe) -> None:
    cfe.evs.register()
    pipe = cfe.sb.create_pipe(4, "GUIDANCE_PIPE")
    cfe.es.wait_for_startup_sync(1000)
    cfe.os.task_delay(200)
    cfe.sb.transmit_msg(telemetry(REQUEST_MID))
    cfe.sb.subscribe(REPLY_MID, pipe)
    if cfe.sb.receive_buffer(pipe, 100) is None:
        cfe.evs.send_err(1, "the star tracker does not answer")
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
