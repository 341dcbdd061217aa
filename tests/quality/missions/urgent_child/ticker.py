"""Three jobs at once."""

from cfepy.app import Cfe
from cfepy.msg import telemetry

MIDS = (0x0890, 0x0890, 0x0890)


def TICKER_AppMain(cfe: Cfe) -> None:
    cfe.es.wait_for_startup_sync(1000)
    cfe.os.task_delay(100)
    for _ in range(1):
        for mid in MIDS:
            cfe.sb.transmit_msg(telemetry(mid))
        cfe.os.task_delay(10)
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
