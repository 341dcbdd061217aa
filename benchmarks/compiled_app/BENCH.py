"""The same as fsw/src/bench.c, in Python."""

from __future__ import annotations

from cfepy import msg
from cfepy.app import Cfe

TIMES = 30000
FEW = 3000
MSG_ID = 0x1899


def BENCH_Main(cfe: Cfe) -> None:
    """The main function."""

    def tell(what: str, count: int) -> None:
        cfe.es.write_to_sys_log(f"BENCH {what}: {count}")

    cfe.evs.register()
    pipe = cfe.sb.create_pipe(10, "BENCH")
    cfe.sb.subscribe(MSG_ID, pipe)
    packet = msg.init(MSG_ID, 80)
    table = cfe.tbl.register("Bench", 64)
    cfe.tbl.load(table, bytes(64))
    cfe.es.run_loop()
    total = 0
    tell("begin", 0)
    for _ in range(TIMES):
        cfe.sb.transmit_msg(packet)
        cfe.sb.receive_buffer(pipe, 0)
    tell("sb", TIMES)
    for i in range(TIMES):
        cfe.evs.send_event(1, 1, "masked event %d of %s", i, "bench")
    tell("masked event", TIMES)
    for i in range(FEW):
        cfe.evs.send_event(1, 2, "event %d of %s", i, "bench")
    tell("event", FEW)
    for i in range(TIMES):
        image, _ = cfe.tbl.get_address(table)
        total += image[i % 16]
        cfe.tbl.release_address(table)
    tell("table", TIMES)
