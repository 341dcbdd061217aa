"""Sends the settings at once, without the startup sync."""

from cfepy.app import Cfe
from cfepy.msg import telemetry

SETTINGS_MID = 0x0891


def SETTINGS_AppMain(cfe: Cfe) -> None:
    cfe.evs.register()
    cfe.sb.transmit_msg(telemetry(SETTINGS_MID))
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
