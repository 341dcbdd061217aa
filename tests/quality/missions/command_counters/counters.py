"""Main task and child task count commands in one counter, each by one line."""

from cfepy.app import Cfe

MIDS = (0x0890, 0x0891)
COMMANDS = 6


class Counters:
    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
        self.commands = 0
        cfe.evs.register()
        self.mutex = cfe.os.mut_sem_create("COUNTERS_MUTEX")
        self.pipes = [cfe.sb.create_pipe(4, f"COUNTERS_{number}") for number in range(2)]
        for mid, pipe in zip(MIDS, self.pipes, strict=True):
            cfe.sb.subscribe(mid, pipe)
        cfe.es.create_child_task("COUNTERS_CHILD", self.child, 16384, 100)

    def child(self) -> None:
        while True:
            self.take(1)

    def take(self, number: int) -> None:
        if self.cfe.sb.receive_buffer(self.pipes[number], 300) is not None:
            self.commands += 1

    def report(self) -> None:
        if self.commands not in (0, COMMANDS):
            self.cfe.evs.send_err(1, f"{self.commands} commands")


def COUNTERS_AppMain(cfe: Cfe) -> None:
    counters = Counters(cfe)
    cfe.es.wait_for_startup_sync(1000)
    while cfe.es.run_loop():
        for _ in range(COMMANDS // 2):
            counters.take(0)
        cfe.os.task_delay(20)
        counters.report()
