"""Owns the mission's counter of detections, and tells what it counts."""

from cfepy.app import Cfe

REPORT_MID = 0x0892


def AUDITOR_AppMain(cfe: Cfe) -> None:
    cfe.evs.register()
    counter = cfe.es.register_gen_counter("DETECTIONS")
    pipe = cfe.sb.create_pipe(4, "AUDITOR_PIPE")
    cfe.sb.subscribe(REPORT_MID, pipe)
    while cfe.es.run_loop():
        cfe.sb.receive_buffer(pipe)
        cfe.os.task_delay(5)
        cfe.evs.send_info(1, f"{cfe.es.get_gen_count(counter)} detections")
