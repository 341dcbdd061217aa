"""Restarts the worker once, as a matter of routine."""

from cfepy.app import Cfe

TICK_MID = 0x0890


def NURSE_AppMain(cfe: Cfe) -> None:
    pipe = cfe.sb.create_pipe(4, "NURSE_PIPE")
    cfe.sb.subscribe(TICK_MID, pipe)
    cfe.es.run_loop()
    cfe.sb.receive_buffer(pipe)
    cfe.es.restart_app(cfe.es.get_app_id_by_name("WORKER"))
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
