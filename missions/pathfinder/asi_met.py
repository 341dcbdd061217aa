"""ASI_MET, the weather station: it waits in select() for what its sensors measured. Of all it is the least urgent."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.msg import Layout, Telemetry

ASI_MET_DATA_MID = 0x0891
WORKING_US = 20_000

ASI_MET_HK_MID = 0x0892
ASI_MET_HK = Telemetry("ASI_MET_HK", ASI_MET_HK_MID, Layout("asi_met_hk", [("Samples", "u32")]))
TELEMETRY = [ASI_MET_HK]


def ASI_MET_Main(cfe: Cfe) -> None:
    """Measure in a loop."""
    select = cfe.os.symbol_lookup("VX_Select")
    pipe = cfe.sb.create_pipe(4, "ASI_MET_PIPE")
    cfe.sb.subscribe(ASI_MET_DATA_MID, pipe)
    samples = 0
    while cfe.es.run_loop():
        select(cfe, pipe)
        cfe.psp.compute(WORKING_US)
        samples += 1
        cfe.sb.transmit_msg(ASI_MET_HK.packet(Samples=samples))
