"""Main task and child task share a card and its directory; each takes the two mutexes in an order of its own."""

from cfepy.app import Cfe

WRITE_MID, READ_MID = 0x0890, 0x0891


class Storage:
    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
        self.files = 0
        cfe.evs.register()
        self.card = cfe.os.mut_sem_create("CARD")
        self.directory = cfe.os.mut_sem_create("DIRECTORY")
        self.writes, self.reads = (cfe.sb.create_pipe(4, name) for name in ("STORAGE_WRITE", "STORAGE_READ"))
        cfe.sb.subscribe(WRITE_MID, self.writes)
        cfe.sb.subscribe(READ_MID, self.reads)
        cfe.es.create_child_task("STORAGE_READER", self.reader, 16384, 100)

    def write(self) -> None:
        os = self.cfe.os
        os.mut_sem_take(self.card)
        os.mut_sem_take(self.directory)
        self.files += 1
        os.mut_sem_give(self.directory)
        os.mut_sem_give(self.card)

    def reader(self) -> None:
        os = self.cfe.os
        while True:
            self.cfe.sb.receive_buffer(self.reads)
            os.mut_sem_take(self.directory)
            if self.files:
                os.mut_sem_take(self.card)
                os.mut_sem_give(self.card)
            os.mut_sem_give(self.directory)


def STORAGE_AppMain(cfe: Cfe) -> None:
    storage = Storage(cfe)
    while cfe.es.run_loop():
        cfe.sb.receive_buffer(storage.writes)
        storage.write()
