"""Resets of the processor inside a run: lost data, kept data, and no leaked objects."""

from __future__ import annotations

import gc
import sys
import threading
from collections import Counter
from pathlib import Path

import pytest

from cfepy import msg
from cfepy.ids import get_base
from cfepy.mission import Mission
from cfepy.osal.limits import OS_OBJECT_CREATOR_ANY
from cfepy.psp.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR, PanicError
from cfepy.rtos.context import drain
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

KEEPER = """
    STARTS = 0

    def keeper_main(cfe):
        global STARTS
        STARTS += 1
        area = cfe.psp.get_user_reserved_area()
        area[0] = area[0] + 1 & 0xFF
        cfe.evs.register()
        pipe = cfe.sb.create_pipe(3, "KEEPER_PIPE")
        cfe.sb.subscribe(0x1882, pipe)
        cfe.os.printf(f"start {STARTS}, boot {area[0]}, pipe {pipe:#x}, type {cfe.psp.get_restart_type().reset_type}")
        while cfe.es.run_loop():
            cfe.sb.receive_buffer(pipe, 500)
"""
STARTUP = "CFE_APP, keeper, keeper_main, KEEPER, 50, 16384, 0x0, 0;\n!"


def make(folder: Path, tasks: str = "thread", **sources: str) -> Mission:
    path = write_mission(folder, STARTUP, **({"keeper": KEEPER} | sources))
    return Mission(path, console=Console(quiet=True), tasks=tasks)


def starts(mission: Mission) -> list[str]:
    return [line for line in mission.console.lines if line.startswith("start ")]


def restart(reset_type: int) -> bytes:
    return bytes(msg.command(0x1806, 2, bytes([reset_type, 0])))


def command_reset(mission: Mission, reset_type: int) -> None:
    mission.cfe.sb.transmit_msg(restart(reset_type), is_origination=False)
    mission.run_for(3)


def test_processor_reset_loses_ram_and_keeps_reserved_memory(tmp_path: Path) -> None:
    with make(tmp_path) as mission:
        mission.run_for(3)
        first = mission.processor
        command_reset(mission, RST_TYPE_PROCESSOR)
        assert mission.processor is not first
        assert starts(mission) == ["start 1, boot 1, pipe 0x160006, type 2", "start 1, boot 2, pipe 0x160006, type 1"]
        (reset,) = mission.record.resets
        assert (reset.reset_type, reset.fault) == (RST_TYPE_PROCESSOR, False)
        assert reset.at_ns == 3_000_000_000
        assert mission.kernel.now == 6_000_000_000
        assert mission.booted is not None
        assert mission.booted < 1_000_000_000 < 3_000_000_000 < (mission.processor.booted or 0)


def test_a_power_on_reset_loses_everything(tmp_path: Path) -> None:
    with make(tmp_path) as mission:
        mission.run_for(3)
        mission.files.write_file("/ram/kept.txt", b"?")
        command_reset(mission, RST_TYPE_POWERON)
        assert starts(mission)[1] == "start 1, boot 1, pipe 0x160006, type 2"
        assert not mission.files.exists("/ram/kept.txt")


def test_ram_disk_survives_a_processor_reset(tmp_path: Path) -> None:
    with make(tmp_path) as mission:
        mission.run_for(3)
        mission.files.write_file("/ram/kept.txt", b"?")
        command_reset(mission, RST_TYPE_PROCESSOR)
        assert mission.files.read_file("/ram/kept.txt") == b"?"


def test_a_reset_by_the_host_between_two_pieces_of_a_run(tmp_path: Path) -> None:
    with make(tmp_path) as mission:
        mission.run_for(2)
        mission.processor.psp.restart(RST_TYPE_PROCESSOR, "the test wants it")
        mission.run_for(2)
        assert [reset.reason for reset in mission.record.resets] == ["the test wants it"]
        assert len(starts(mission)) == 2


def test_report_counts_across_resets(tmp_path: Path) -> None:
    with make(tmp_path) as mission:
        mission.run_for(3)
        before = mission.record.traffic(mission.cfe.sb, ())[0x0808].sent
        command_reset(mission, RST_TYPE_PROCESSOR)
        assert mission.record.traffic(mission.cfe.sb, ())[0x0808].sent > before
        assert mission.record.history["KEEPER"].cpu_ns >= 0


def test_finally_blocks_of_apps_run_before_the_next_boot(tmp_path: Path) -> None:
    source = """
    def keeper_main(cfe):
        try:
            cfe.es.run_loop()
            cfe.os.task_delay(100_000)
        finally:
            cfe.os.printf("start of the end")
            cfe.psp.restart(1)
    """
    with make(tmp_path, keeper=source) as mission:
        mission.run_for(2)
        command_reset(mission, RST_TYPE_PROCESSOR)
        assert len(starts(mission)) == 1
        assert len(mission.record.resets) == 1


def test_mission_that_resets_at_every_boot_ends_at_its_time_limit(tmp_path: Path) -> None:
    with make(tmp_path, keeper="def keeper_main(cfe):\n    cfe.psp.restart(1)\n") as mission:
        mission.run_for(10)
        assert mission.kernel.now == 10_000_000_000
        assert len(mission.record.resets) > 5


@pytest.mark.parametrize("pieces", [1, 7])
def test_trace_is_the_same_on_both_contexts_and_in_any_number_of_pieces(tmp_path: Path, pieces: int) -> None:
    digests = []
    for tasks in ("thread", "greenlet"):
        with make(tmp_path, tasks) as mission:
            mission.run_for(1)
            mission.cfe.sb.transmit_msg(restart(RST_TYPE_PROCESSOR), is_origination=False)
            for _ in range(pieces):
                mission.run_until(mission.kernel.now + 7_000_000_000 // pieces)
            digests.append(mission.trace.digest())
    assert digests[0] == digests[1]


def osal_objects(mission: Mission) -> Counter[int]:
    """Return the number of OSAL objects of each kind."""
    found: Counter[int] = Counter()
    mission.cfe.os.for_each_object(OS_OBJECT_CREATOR_ANY, lambda object_id, _: found.update([get_base(object_id)]))
    return found


def objects(mission: Mission) -> int:
    """Return the number of objects that can contain others. Lines of the console do not count."""
    mission.console.lines.clear()
    gc.collect()
    return len(gc.get_objects())


@pytest.mark.slow
def test_two_hundred_resets_leave_nothing_behind(tmp_path: Path) -> None:
    with make(tmp_path) as mission:
        mission.run_for(1)
        drain()
        threads, modules = threading.active_count(), len(sys.modules)
        osal_ids = osal_objects(mission)
        files = len(mission.files.list_dir("/ram"))
        sizes: list[int] = []
        for number in range(200):
            mission.processor.psp.restart(RST_TYPE_PROCESSOR if number % 3 else RST_TYPE_POWERON, "again")
            mission.run_for(1)
            if number % 50 == 49:
                sizes.append(objects(mission))
        assert max(sizes) - min(sizes) < 300, sizes  # the record of each reset, and noise
        assert len(mission.record.resets) == 200
        assert osal_objects(mission) == osal_ids
        assert len(mission.cfe.sb.pipes) == 6
        assert len(mission.kernel.tasks) == len(set(mission.kernel.tasks)) < 20
        assert len(sys.modules) == modules
        assert len(mission.files.list_dir("/ram")) == files
        assert threading.active_count() <= threads
        gc.collect()
        assert sum(isinstance(each, type(mission.processor)) for each in gc.get_objects()) <= 2


@pytest.mark.parametrize("count", [60, pytest.param(1000, marks=pytest.mark.slow)])
def test_many_restarts_of_an_app_leave_nothing_behind(tmp_path: Path, count: int) -> None:
    with make(tmp_path) as mission:
        es = mission.cfe.es
        mission.run_for(2)
        drain()
        threads, modules = threading.active_count(), len(sys.modules)
        tables = osal_objects(mission)
        routes, pipes, tasks = len(mission.cfe.sb.routes), len(mission.cfe.sb.pipes), len(mission.kernel.tasks)
        sizes: list[int] = []
        begun = 0
        for number in range(count):
            es.restart_app(es.get_app_id_by_name("KEEPER"))
            mission.run_for(7)
            if (number + 1) % (count // 4) == 0:
                begun += len(starts(mission))
                sizes.append(objects(mission))
        assert es.history["KEEPER"].restarts == count
        assert begun == count + 1
        assert max(sizes) - min(sizes) < 300, sizes
        assert osal_objects(mission) == tables
        assert (len(mission.cfe.sb.routes), len(mission.cfe.sb.pipes)) == (routes, pipes)
        assert mission.cfe.sb.subscriptions == sum(len(r.destinations) for r in mission.cfe.sb.routes.values())
        assert len(mission.kernel.tasks) == tasks
        assert len(sys.modules) == modules
        assert threading.active_count() <= threads


LEFTOVERS = """
    def keeper_main(cfe):
        os = cfe.os

        def hold(timer):
            try:
                os.task_delay(100_000)
            finally:
                sock = os.socket_open(1, 1)
                address = os.socket_addr_init(1)
                os.socket_addr_from_string(address, "127.0.0.1")
                os.socket_addr_set_port(address, 1234)
                os.socket_bind(sock, address)

        os.timer_set(os.timer_create("T", hold), 100_000, 0)
        while cfe.es.run_loop():
            os.task_delay(500)
    """


def test_objects_made_during_shutdown_do_not_survive_the_reset(tmp_path: Path) -> None:
    with make(tmp_path, keeper=LEFTOVERS) as mission:
        mission.run_for(2)
        mission.processor.psp.restart(RST_TYPE_PROCESSOR, "the test wants it")
        mission.run_for(0)
        assert not mission.network.datagrams.bound


def test_pending_reset_is_not_changed_by_another(tmp_path: Path) -> None:
    source = """
    def keeper_main(cfe):
        try:
            cfe.os.printf(f"start as {cfe.psp.get_restart_type().reset_type}")
            while cfe.es.run_loop():
                cfe.os.task_delay(500)
        finally:
            cfe.psp.restart(2, "too late")
    """
    with make(tmp_path, keeper=source) as mission:
        mission.run_for(2)
        mission.processor.psp.restart(RST_TYPE_PROCESSOR, "the test wants it")
        mission.run_for(2)
        assert starts(mission) == ["start as 2", "start as 1"]


def test_a_panic_ends_the_run(tmp_path: Path) -> None:
    source = """
    def keeper_main(cfe):
        cfe.os.task_delay(3000)
        cfe.psp.panic(-5)
    """
    with make(tmp_path, keeper=source) as mission:
        with pytest.raises(PanicError, match="code -5"):
            mission.run_for(10)
        assert not mission.record.resets
