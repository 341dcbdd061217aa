"""Heats when it has got its settings."""

from cfepy.app import Cfe

SETTINGS_MID = 0x0891


def HEATER_AppMain(cfe: Cfe) -> None:
    cfe.evs.register()
    pipe = cfe.sb.create_pipe(4, "HEATER_PIPE")
    cfe.sb.subscribe(SETTINGS_MID, pipe)
    if cfe.sb.receive_buffer(pipe, 500) is None:
        cfe.evs.send_err(1, "no settings")
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
