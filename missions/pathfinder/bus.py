"""BC_SCHED and BC_DIST, the two tasks that run the 1553 bus, eight times a second.

The bus runs by itself what BC_SCHED has set up for a cycle. When its traffic is over, BC_DIST is woken, and hands out
what the instruments sent. When the cycle is nearly over, BC_SCHED is woken, to set up the next one. It is the more
urgent of the two, and by then BC_DIST has to be through: if it is not, the data on board are of no known age, and
BC_SCHED lets the computer be reset. It serves the watchdog only after a good cycle.
"""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.msg import Layout, Telemetry

CYCLE_US = 125_000
TRAFFIC_OVER_US = 60_000  # after the beginning of a cycle
SET_UP_US = 110_000
WATCHDOG_MS = 150
SETTING_UP_US = 1000
HANDING_OUT_US = 8000

ASI_MET_DATA = Telemetry("ASI_MET_DATA", 0x0891, Layout("asi_met_data", [("Cycle", "u32"), ("Pressure", "u32")]))
TELEMETRY = [ASI_MET_DATA]
DISTRIBUTED = "DISTRIBUTED"  # given by BC_DIST when it is through


def BC_SCHED_Main(cfe: Cfe) -> None:
    """Set up cycle after cycle, as long as BC_DIST keeps up."""
    distributed = cfe.os.bin_sem_create(DISTRIBUTED, 1)
    due = _alarm(cfe, "SET_UP", SET_UP_US)
    cfe.psp.watchdog_set(WATCHDOG_MS)
    cfe.psp.watchdog_enable()
    while cfe.es.run_loop():
        cfe.os.bin_sem_take(due)
        if not cfe.os.bin_sem_timed_wait(distributed, 0):
            cfe.es.write_to_sys_log("BC_SCHED: BC_DIST is not through with the last cycle; the bus stops")
            return
        cfe.psp.watchdog_service()
        cfe.psp.compute(SETTING_UP_US)


def BC_DIST_Main(cfe: Cfe) -> None:
    """Distribute the data of the bus: to ASI_MET through a pipe, to all others by shared memory."""
    pipe_write = cfe.os.symbol_lookup("VX_PipeWrite")
    traffic_over = _alarm(cfe, "TRAFFIC", TRAFFIC_OVER_US)
    cycle = 0
    while cfe.es.run_loop():
        cfe.os.bin_sem_take(traffic_over)
        cfe.psp.compute(HANDING_OUT_US)
        cycle += 1
        pipe_write(cfe, ASI_MET_DATA.packet(Cycle=cycle, Pressure=670))
        cfe.os.bin_sem_give(cfe.os.bin_sem_get_id_by_name(DISTRIBUTED))


def _alarm(cfe: Cfe, name: str, first_us: int) -> int:
    """Return a semaphore that the hardware of the bus gives at the same instant of each cycle."""
    semaphore = cfe.os.bin_sem_create(name, 0)
    timer = cfe.os.timer_create(name, lambda _: cfe.os.bin_sem_give(semaphore))
    cfe.os.timer_set(timer, first_us, CYCLE_US)
    return semaphore
