"""A child task measures, more urgent than the main task, which reports what was measured."""

from cfepy.app import Cfe


class Attitude:
    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
        self.angle, self.opposite = 0, 0
        cfe.evs.register()
        self.mutex = cfe.os.mut_sem_create("ATTITUDE_MUTEX")
        cfe.es.create_child_task("ATTITUDE_CHILD", self.measure, 16384, 90)

    def measure(self) -> None:
        while True:
            self.cfe.os.task_delay(7)
            self.set(self.angle + 1)

    def set(self, angle: int) -> None:
        self.angle = angle
        self.opposite = -angle

    def report(self) -> None:
        angle = self.angle
        self.cfe.evs.send_dbg(1, f"angle {angle}")
        if self.opposite != -angle:
            self.cfe.evs.send_err(2, f"angle {angle}, opposite {self.opposite}")


def ATTITUDE_AppMain(cfe: Cfe) -> None:
    attitude = Attitude(cfe)
    while cfe.es.run_loop():
        cfe.os.task_delay(25)
        attitude.report()
