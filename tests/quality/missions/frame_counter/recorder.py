"""Records frames, and reports any that is not the next one."""

import struct

from cfepy.app import Cfe

FRAME_MID = 0x0891


def RECORDER_AppMain(cfe: Cfe) -> None:
    cfe.evs.register()
    pipe = cfe.sb.create_pipe(8, "RECORDER_PIPE")
    cfe.sb.subscribe(FRAME_MID, pipe)
    due = 0
    while cfe.es.run_loop():
        packet = cfe.sb.receive_buffer(pipe)
        if packet is not None:
            number = struct.unpack_from("<I", packet, 16)[0]
            if number != due:
                cfe.evs.send_err(1, f"frame {number} came, {due} was due")
            due = number + 1
