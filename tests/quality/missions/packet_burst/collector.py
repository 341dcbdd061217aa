"""Collects measurements; its pipe holds two, since the sensor waits for its bus after each."""

import struct

from cfepy.app import Cfe

DATA_MID = 0x0891


def COLLECTOR_AppMain(cfe: Cfe) -> None:
    cfe.evs.register()
    pipe = cfe.sb.create_pipe(2, "COLLECTOR_PIPE")
    cfe.sb.subscribe(DATA_MID, pipe)
    due = 0
    while cfe.es.run_loop():
        packet = cfe.sb.receive_buffer(pipe)
        if packet is not None:
            number = struct.unpack_from("<I", packet, 16)[0]
            if number != due:
                cfe.evs.send_err(1, f"measurement {due} is missing")
            due = number + 1
