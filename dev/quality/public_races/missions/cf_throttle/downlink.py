"""Creates the semaphore that throttles CF, as an application that sends telemetry to the ground does."""

from cfepy.app import Cfe


def main(cfe: Cfe) -> None:
    cfe.evs.register()
    cfe.os.count_sem_create("DOWNLINK_SEM", 0)
    cfe.es.wait_for_startup_sync(10_000)
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
