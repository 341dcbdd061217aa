"""An application that exhausts every resource: it gets NASA's status, and its own objects are released."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.mission.test_random_commands import left

STARTUP = "CFE_APP, taker, taker_main, TAKER, 50, 16384, 0x0, 0;\n!"
TAKER = """
    def taker_main(cfe):
        cfe.evs.register()
        os, es, sb = cfe.os, cfe.es, cfe.sb

        def take(what, function):
            for number in range(600):
                try:
                    function(number)
                except Exception as refusal:
                    status = getattr(refusal, "status", None)
                    os.printf(f"took {what}: {number}, status {status & 0xFFFFFFFF:#x}")
                    return

        if es.run_loop():
            pipe = sb.create_pipe(3, "FIRST")
            take("pipes", lambda number: sb.create_pipe(3, f"P{number}"))
            take("MsgIds", lambda number: sb.subscribe(0x900 + number, pipe))
            take("buffers", lambda number: sb.allocate_message_buffer(2000))
            take("queues", lambda number: os.queue_create(f"Q{number}", 3, 4))
            take("binary", lambda number: os.bin_sem_create(f"B{number}", 0))
            take("counting", lambda number: os.count_sem_create(f"C{number}", 0))
            take("condvars", lambda number: os.cond_var_create(f"C{number}"))
            take("rwlocks", lambda number: os.rw_lock_create(f"R{number}"))
            take("timers", lambda number: os.timer_create(f"T{number}", lambda timer: None))
            take("sockets", lambda number: os.socket_open(1, 1))
            take("directories", lambda number: os.directory_open("/ram"))
            take("children", lambda number: es.create_child_task(f"C{number}", lambda: os.task_delay(10**6), 4096, 100))
            take("pools", lambda number: es.pool_create(5000))
            take("mutexes", lambda number: os.mut_sem_create(f"M{number}"))
            take("tables", lambda number: cfe.tbl.register(f"T{number}", 100))
            take("counters", lambda number: es.register_gen_counter(f"C{number}"))
            take("blocks", lambda number: es.register_cds(100, f"C{number}"))
        while es.run_loop():
            os.task_delay(1000)
    """
NO_FREE_IDS = "0xfffffff2"
LINUX = {
    "pipes": (58, "0xca000004"),
    "MsgIds": (241, "0xca000009"),
    "buffers": (123, "0xca000008"),
    "queues": (0, NO_FREE_IDS),
    "binary": (17, NO_FREE_IDS),
    "counting": (20, NO_FREE_IDS),
    "condvars": (4, NO_FREE_IDS),
    "rwlocks": (20, NO_FREE_IDS),
    "timers": (4, NO_FREE_IDS),
    "sockets": (50, NO_FREE_IDS),
    "directories": (4, NO_FREE_IDS),
    "children": (55, "0xc8000005"),
    "pools": (4, "0xc8000005"),
    "mutexes": (0, NO_FREE_IDS),
    "tables": (128, "0xcc000006"),
    "counters": (8, "0xc400002b"),
    "blocks": (511, "0xc400002b"),
}


@pytest.mark.parametrize("board", [None, "rx64m"])
def test_application_that_exhausts_every_resource_gets_nasas_statuses(tmp_path: Path, board: str | None) -> None:
    folder = write_mission(tmp_path, STARTUP, taker=TAKER, mission_yaml="safe: true\n")
    with Mission(folder, console=Console(quiet=True), board=board) as mission:
        mission.run_for(3)
        took = [line for line in mission.console.lines if line.startswith("took ")]
        assert len(took) == len(LINUX)
        if board is None:
            assert took == [f"took {what}: {count}, status {status}" for what, (count, status) in LINUX.items()]
        es = mission.cfe.es
        es.restart_app(es.get_app_id_by_name("TAKER"))
        mission.run_for(8)
        again = [line for line in mission.console.lines if line.startswith("took ")][len(took) :]
        assert again[:-2] == took[:-2]  # generic counters and blocks of the CDS have no owner and stay
        es.delete_app(es.get_app_id_by_name("TAKER"))
        mission.run_for(8)
        kept = left(mission)
    (tmp_path / "startup.scr").write_text("!", encoding="utf-8")
    with Mission(folder, console=Console(quiet=True), board=board) as empty:
        empty.run_for(3)
        assert kept == left(empty)
