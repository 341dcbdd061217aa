"""The child task is more urgent, so a queue of one job is enough: it has always taken the job before the next one."""

from cfepy.app import Cfe
from cfepy.status import OsalError

JOB_MID = 0x0890


class Spooler:
    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
        cfe.evs.register()
        self.queue = cfe.os.queue_create("JOBS", 1, 4)
        self.pipe = cfe.sb.create_pipe(4, "SPOOLER_PIPE")
        cfe.sb.subscribe(JOB_MID, self.pipe)
        cfe.es.create_child_task("SPOOLER_CHILD", self.child, 16384, 90)

    def child(self) -> None:
        while True:
            self.cfe.os.queue_get(self.queue)

    def take(self) -> None:
        self.cfe.sb.receive_buffer(self.pipe)
        try:
            self.cfe.os.queue_put(self.queue, b"job!")
        except OsalError:
            self.cfe.evs.send_err(1, "a job is lost")


def SPOOLER_AppMain(cfe: Cfe) -> None:
    spooler = Spooler(cfe)
    while cfe.es.run_loop():
        spooler.take()
