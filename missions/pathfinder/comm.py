"""COMM, the communication with Earth, of medium urgency: it packs what was gathered for the radio, which takes long."""

from __future__ import annotations

from cfepy.app import Cfe

EVERY_US = 250_000
FIRST_US = 89_500
PACKING_US = 160_000


def COMM_Main(cfe: Cfe) -> None:
    """Pack a frame four times a second."""
    due = cfe.os.bin_sem_create("FRAME", 0)
    timer = cfe.os.timer_create("FRAME", lambda _: cfe.os.bin_sem_give(due))
    cfe.os.timer_set(timer, FIRST_US, EVERY_US)
    while cfe.es.run_loop():
        cfe.os.bin_sem_take(due)
        cfe.psp.compute(PACKING_US)
