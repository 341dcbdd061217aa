"""A child task takes packets from a pipe; when the pass is over, the main task deletes the pipe."""

from cfepy.app import Cfe
from cfepy.sb import POLL

DATA_MID, STOP_MID = 0x0890, 0x0891


class Downlink:
    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
        self.open = True
        cfe.evs.register()
        self.work = cfe.os.count_sem_create("DOWNLINK_WORK", 0)
        self.mutex = cfe.os.mut_sem_create("DOWNLINK_MUTEX")
        self.data = cfe.sb.create_pipe(8, "DOWNLINK_DATA")
        self.orders = cfe.sb.create_pipe(8, "DOWNLINK_ORDERS")
        cfe.sb.subscribe(DATA_MID, self.data)
        for mid in (DATA_MID, STOP_MID):
            cfe.sb.subscribe(mid, self.orders)
        cfe.es.create_child_task("DOWNLINK_CHILD", self.child, 16384, 100)

    def child(self) -> None:
        while True:
            self.cfe.os.count_sem_take(self.work)
            if self.open:
                self.cfe.sb.receive_buffer(self.data, POLL)

    def order(self, packet: bytes) -> None:
        if packet[:2] == DATA_MID.to_bytes(2, "big"):
            self.cfe.os.count_sem_give(self.work)
        elif self.open:
            self.open = False
            self.cfe.sb.delete_pipe(self.data)


def DOWNLINK_AppMain(cfe: Cfe) -> None:
    downlink = Downlink(cfe)
    while cfe.es.run_loop():
        packet = cfe.sb.receive_buffer(downlink.orders)
        if packet is not None:
            downlink.order(packet)
