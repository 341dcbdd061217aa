"""Keeps position and checksum over resets, in two blocks of the Critical Data Store."""

import struct

from cfepy.app import Cfe
from cfepy.status import CFE_ES_CDS_ALREADY_EXISTS

TICK_MID = 0x0890
NUMBER = struct.Struct("<I")


def ORBIT_AppMain(cfe: Cfe) -> None:
    cfe.evs.register()
    blocks = [cfe.es.register_cds(NUMBER.size, name) for name in ("POSITION", "CHECKSUM")]
    if blocks[0].status == CFE_ES_CDS_ALREADY_EXISTS:
        position, checksum = (NUMBER.unpack(cfe.es.restore_from_cds(block))[0] for block in blocks)
        if checksum != position ^ 0xFFFF:
            cfe.evs.send_err(1, f"position {position} with checksum {checksum:#x}")
    else:
        position = 0
        for block, value in zip(blocks, (position, position ^ 0xFFFF), strict=True):
            cfe.es.copy_to_cds(block, NUMBER.pack(value))
    pipe = cfe.sb.create_pipe(4, "ORBIT_PIPE")
    cfe.sb.subscribe(TICK_MID, pipe)
    while cfe.es.run_loop():
        cfe.sb.receive_buffer(pipe)
        position += 1
        for block, value in zip(blocks, (position, position ^ 0xFFFF), strict=True):
            cfe.es.copy_to_cds(block, NUMBER.pack(value))
