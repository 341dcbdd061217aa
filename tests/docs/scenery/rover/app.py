"""An application with a mistake for `cfepy check`."""

from cfepy.app import Cfe
from cfepy.msg import Layout, Telemetry

ROVER_HK = Telemetry("ROVER_HK_TLM", 0x0890, Layout("RoverHk", Count="u8"))


def ROVER_AppMain(cfe: Cfe) -> None:
    """Tell once that it is there."""
    cfe.sb.create_pipe(4, "ROVER")
    cfe.sb.transmitt_msg(ROVER_HK.packet(Count=1))
