"""Controls heaters by a table. The child task goes on reading after it has released the table's address."""

import struct

from cfepy.app import Cfe

TICK_MID, LOAD_MID = 0x0890, 0x0891
LIMITS = struct.Struct("<HH")  # low, high; high is always low + 10


class Heater:
    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
        cfe.evs.register()
        self.table = cfe.tbl.register("Limits", LIMITS.size)
        for _ in range(2):  # the address of a table that was loaded once does not lock it, as in NASA's cFE
            cfe.tbl.load(self.table, LIMITS.pack(10, 20))
        self.ticks, self.loads = (cfe.sb.create_pipe(4, name) for name in ("HEATER_TICKS", "HEATER_LOADS"))
        cfe.sb.subscribe(TICK_MID, self.ticks)
        cfe.sb.subscribe(LOAD_MID, self.loads)
        cfe.es.create_child_task("HEATER_CHILD", self.child, 16384, 100)

    def child(self) -> None:
        while True:
            self.cfe.sb.receive_buffer(self.ticks)
            self.control()

    def control(self) -> None:
        image, _ = self.cfe.tbl.get_address(self.table)
        low = int.from_bytes(image[:2], "little")
        self.cfe.tbl.release_address(self.table)
        self.cfe.evs.send_dbg(2, f"heating from {low} degrees")
        high = int.from_bytes(image[2:], "little")
        if high != low + 10:
            self.cfe.evs.send_err(1, f"from {low} to {high} degrees")


def HEATER_AppMain(cfe: Cfe) -> None:
    heater = Heater(cfe)
    low = 10
    while cfe.es.run_loop():
        cfe.sb.receive_buffer(heater.loads)
        low += 20
        cfe.tbl.load(heater.table, LIMITS.pack(low, low + 10))
        cfe.tbl.manage(heater.table)
