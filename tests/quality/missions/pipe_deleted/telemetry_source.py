"""Three packets of data, and the end of the pass."""

from cfepy.app import Cfe
from cfepy.msg import telemetry

DATA_MID, STOP_MID = 0x0890, 0x0891


def SOURCE_AppMain(cfe: Cfe) -> None:
    cfe.es.wait_for_startup_sync(1000)
    cfe.os.task_delay(100)
    for _ in range(3):
        cfe.sb.transmit_msg(telemetry(DATA_MID))
        cfe.os.task_delay(10)
    for mid in (DATA_MID, STOP_MID):
        cfe.sb.transmit_msg(telemetry(mid))
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
