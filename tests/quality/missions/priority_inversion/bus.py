"""An urgent and an unimportant application share a bus, guarded by a binary semaphore; a third one computes long."""

from cfepy.app import Cfe
from cfepy.msg import telemetry

CYCLE_MID = 0x0891


def BUS_AppMain(cfe: Cfe) -> None:
    bus = cfe.os.bin_sem_create("BUS_LOCK", 1)
    cfe.es.wait_for_startup_sync(1000)
    while cfe.es.run_loop():
        cfe.os.task_delay(99)
        cfe.os.bin_sem_take(bus)
        cfe.psp.compute(1000)
        cfe.os.bin_sem_give(bus)
        cfe.sb.transmit_msg(telemetry(CYCLE_MID))


def RADIO_AppMain(cfe: Cfe) -> None:
    cfe.es.wait_for_startup_sync(1000)
    cfe.os.task_delay(60)
    while cfe.es.run_loop():
        cfe.psp.compute(60_000)
        cfe.os.task_delay(40)


def WEATHER_AppMain(cfe: Cfe) -> None:
    cfe.es.wait_for_startup_sync(1000)
    bus = cfe.os.bin_sem_get_id_by_name("BUS_LOCK")
    cfe.os.task_delay(30)
    while cfe.es.run_loop():
        cfe.os.bin_sem_take(bus)
        cfe.psp.compute(2000)
        cfe.os.bin_sem_give(bus)
        cfe.os.task_delay(98)
