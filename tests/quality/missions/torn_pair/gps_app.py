"""A receiver that loses its satellites: the quality goes to 0, and the position is noise."""

from cfepy.app import Cfe
from cfepy.msg import telemetry

QUALITY_MID, POSITION_MID = 0x0891, 0x0892


def GPS_AppMain(cfe: Cfe) -> None:
    cfe.es.wait_for_startup_sync(1000)
    cfe.os.task_delay(200)
    for quality, position in ((1, 7), (1, 8), (0, 255)):
        cfe.sb.transmit_msg(telemetry(QUALITY_MID, bytes([quality])))
        cfe.sb.transmit_msg(telemetry(POSITION_MID, bytes([position])))
        cfe.os.task_delay(10)
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
