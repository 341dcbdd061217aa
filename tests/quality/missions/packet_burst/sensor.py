"""Reads a sensor over a bus that a child task drives, and sends what it read."""

import struct

from cfepy.app import Cfe
from cfepy.msg import telemetry

DATA_MID = 0x0891
READINGS = 6


def SENSOR_AppMain(cfe: Cfe) -> None:
    ask = cfe.os.bin_sem_create("BUS_ASK", 0)
    done = cfe.os.bin_sem_create("BUS_DONE", 0)

    def drive() -> None:
        while True:
            cfe.os.bin_sem_take(ask)
            cfe.os.bin_sem_give(done)

    cfe.es.create_child_task("SENSOR_BUS", drive, 16384, 100)
    cfe.es.wait_for_startup_sync(1000)
    cfe.os.task_delay(100)
    for number in range(READINGS):
        cfe.os.bin_sem_give(ask)
        cfe.os.bin_sem_take(done)
        cfe.sb.transmit_msg(telemetry(DATA_MID, struct.pack("<I", number)))
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
