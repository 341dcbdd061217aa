"""Detects something at each tick, and counts it together with the other detector."""

from cfepy.app import Cfe

TICK_MID = 0x0890


def run(cfe: Cfe, name: str) -> None:
    pipe = cfe.sb.create_pipe(4, name)
    cfe.sb.subscribe(TICK_MID, pipe)
    cfe.es.wait_for_startup_sync(1000)
    counter = cfe.es.get_gen_counter_id_by_name("DETECTIONS")
    while cfe.es.run_loop():
        cfe.sb.receive_buffer(pipe)
        cfe.es.set_gen_count(counter, cfe.es.get_gen_count(counter) + 1)


def NORTH_AppMain(cfe: Cfe) -> None:
    run(cfe, "NORTH_PIPE")


def SOUTH_AppMain(cfe: Cfe) -> None:
    run(cfe, "SOUTH_PIPE")
