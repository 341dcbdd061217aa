"""Faults on time, memory, calls, pipes, network and the processor: that they happen, and which tasks notice."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.es.records import STATE_NAMES
from cfepy.faults import FaultInjector, FaultPlan
from cfepy.mission import Mission
from cfepy.osal.network import Datagram, Place
from cfepy.status import CfeError
from cfepy.writing.console import Console
from tests.faults.worlds import fly, row, told, values
from tests.mission.flights import write_mission

NODE_STARTUP = "CFE_APP, clock.py, __main__, CLOCK, 100, 8192, 0x0, 0;\n!"
CLOCK = """
    import time
    import rospy
    rospy.init_node("clock")
    rate = rospy.Rate(10)
    last, told = rospy.Time.now(), time.time()
    while not rospy.is_shutdown():
        rate.sleep()
        now = rospy.Time.now()
        if abs((now - last).to_sec() - 0.1) > 0.01:
            print("jump of", round((now - last).to_sec() - 0.1, 2), round(time.time() - told - 0.1, 2))
        last, told = now, time.time()
"""
STARTUP = "CFE_APP, worker, worker_main, WORKER, 50, 16384, 0x0, 0;\n!"


# -- time --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("by", [100, -3])
def test_the_clock_of_cfe_jumps(tmp_path: Path, by: int) -> None:
    usual = fly(tmp_path)
    mission = fly(tmp_path, {"jump_clock": by, "at": 2})
    assert mission.cfe.time.get_tai().seconds == usual.cfe.time.get_tai().seconds + by
    assert mission.cfe.time.get_met() == usual.cfe.time.get_met()
    assert mission.cfe.os.get_local_time() - usual.cfe.os.get_local_time() == by * 10_000_000
    assert row(mission, "jump_clock-1")["at_s"] == [2.0]


@pytest.mark.parametrize("by", [5, -5])
def test_ros_nodes_notice_the_jump_and_continue_at_their_rate(tmp_path: Path, by: int) -> None:
    mission = fly(tmp_path, {"jump_clock": by, "at": 1.95}, startup=NODE_STARTUP, clock=CLOCK, seconds=4)
    lines = [line for line in mission.console.lines if "jump of" in line]
    assert lines[0].endswith(f"jump of {by:.1f} {by:.1f}")
    assert len(lines) <= 2


def test_jump_is_limited_to_one_of_the_clocks(tmp_path: Path) -> None:
    cfe = fly(tmp_path, {"jump_clock": 5, "at": 1.95, "clock": "cfe"}, startup=NODE_STARTUP, clock=CLOCK)
    assert not any("jump of" in line for line in cfe.console.lines)
    ros = fly(tmp_path, {"jump_clock": 5, "at": 1.95, "clock": "ros"}, startup=NODE_STARTUP, clock=CLOCK)
    assert any("jump of" in line for line in ros.console.lines)
    assert cfe.cfe.time.get_tai().seconds == ros.cfe.time.get_tai().seconds + 5


def test_the_clock_drifts(tmp_path: Path) -> None:
    usual = fly(tmp_path, seconds=6)
    mission = fly(tmp_path, {"drift_clock": 1000, "after": 1, "until": 4.5}, seconds=6)
    ahead = mission.cfe.os.get_local_time() - usual.cfe.os.get_local_time()
    assert ahead == 4 * 10_000  # 1 ms at 1, 2, 3 and 4 s, in ticks of 100 ns
    assert row(mission, "drift_clock-1")["times"] == 1


def test_drift_continues_after_a_reset(tmp_path: Path) -> None:
    reset = {"reset": "processor", "at": 2.5}
    usual = fly(tmp_path, reset, seconds=6)
    mission = fly(tmp_path, {"drift_clock": 1000, "after": 1, "until": 5.5}, reset, seconds=6)
    assert mission.cfe.os.get_local_time() - usual.cfe.os.get_local_time() == 3 * 10_000  # at 3, 4 and 5 s


def test_clock_enters_flywheel_without_tones(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"lose_1hz": "tone", "after": 2, "until": 12}, seconds=15)
    events = [line for line in mission.console.lines if "FLYWHEEL" in line]
    assert "Start FLYWHEEL" in events[-2]
    assert "Stop FLYWHEEL" in events[-1]
    assert row(mission, "lose_1hz-1")["times"] == 10


def test_lost_1hz_signals_are_not_processed(tmp_path: Path) -> None:
    usual = fly(tmp_path, seconds=8).cfe.time.tone.counters
    lost = fly(tmp_path, {"lose_1hz": "1hz", "count": 3, "after": 2}, seconds=8).cfe.time.tone.counters
    assert lost.local_interrupt == usual.local_interrupt - 3
    assert lost.tone_interrupt_error == 1 + usual.tone_interrupt_error


# -- pipes -------------------------------------------------------------------------------------------------------------


def test_full_pipe_overflows_and_accepts_messages_again(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"fill": "TAKER_PIPE", "at": 1.9, "for": 0.4})
    assert values(mission)[:6] == [0, 1, 2, 3, 8, 9]
    assert values(mission, "OTHER")[:6] == list(range(6))
    assert any("Pipe Overflow" in line and "TAKER_PIPE" in line for line in mission.console.lines)
    assert mission.cfe.sb.counters.pipe_overflow_error == 8


def test_unknown_pipe_is_reported(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"fill": "NO_PIPE", "at": 1.9})
    assert row(mission, "fill-1")["never"] == "the pipe NO_PIPE does not exist at 1.9 s"


# -- memory ------------------------------------------------------------------------------------------------------------

TABLE = """
    def worker_main(cfe):
        handle = cfe.tbl.register("Table", 8)
        cfe.tbl.load(handle, bytes(range(8)))
        status, block = 0, cfe.es.register_cds(8, "Block")
        kept = cfe.es.restore_from_cds(block) if getattr(block, "status", 0) else None
        cfe.es.copy_to_cds(block, bytes(range(8)))
        cfe.os.printf(f"WORKER begins, kept {kept}")
        cfe.es.run_loop()
        while cfe.es.run_loop():
            cfe.os.task_delay(500)
            cfe.os.printf(f"WORKER sees {bytes(cfe.tbl.get_address(handle)[0]).hex()}")
            cfe.tbl.release_address(handle)
"""


def test_table_image_changes_while_its_application_uses_it(tmp_path: Path) -> None:
    fault = {"corrupt_table": "WORKER.Table", "at": 2, "bytes": {"7": 0xFF}}
    mission = fly(tmp_path, fault, startup=STARTUP, worker=TABLE)
    seen = told(mission, "WORKER sees")
    assert seen[0].endswith("0001020304050607")
    assert seen[-1].endswith("00010203040506ff")


def test_a_file_is_damaged_before_it_is_loaded(tmp_path: Path) -> None:
    loader = """
        def worker_main(cfe):
            cfe.os.printf(f"WORKER reads {cfe.os.read(cfe.os.open_create('/cf/data.txt'), 20)}")
    """
    (tmp_path / "data.txt").write_bytes(b"abcdef")
    fault = {"corrupt_file": "/cf/data.txt", "bytes": {"0": 0x41, "-1": 0x46}}
    mission = fly(tmp_path, fault, startup=STARTUP, worker=loader)
    assert told(mission, "WORKER reads b'AbcdeF'")
    assert (tmp_path / "data.txt").read_bytes() == b"abcdef"
    assert row(mission, "corrupt_file-1")["at_s"] == [0.0]
    late = fly(tmp_path, {"corrupt_file": "/cf/none", "at": 1}, startup=STARTUP, worker=loader)
    assert row(late, "corrupt_file-1")["never"] == "the file /cf/none does not exist at 1 s"


@pytest.mark.slow
def test_processor_reset_finds_the_cds_invalid(tmp_path: Path) -> None:
    reset = {"reset": "processor", "at": 2.5}
    kept = fly(tmp_path, reset, startup=STARTUP, worker=TABLE, seconds=5)
    lost = fly(tmp_path, {"corrupt_memory": "cds", "at": 2}, reset, startup=STARTUP, worker=TABLE, seconds=5)
    assert told(kept, "WORKER begins")[1].endswith(str(bytes(range(8))))
    assert told(lost, "WORKER begins")[1].endswith("kept None")
    assert any("No valid CDS found" in line for line in lost.console.lines)


def test_a_block_of_the_cds(tmp_path: Path) -> None:
    fault = {"corrupt_memory": "cds", "block": "WORKER.Block", "at": 2, "bits": 1}
    mission = fly(tmp_path, fault, startup=STARTUP, worker=TABLE)
    handle = mission.cfe.es.get_cds_block_id_by_name("WORKER.Block")
    with pytest.raises(CfeError, match="CRC"):
        mission.cfe.es.restore_from_cds(handle)
    nobody = fly(tmp_path, fault | {"block": "WORKER.Other"}, startup=STARTUP, worker=TABLE)
    assert "WORKER.Other" in row(nobody, "corrupt_memory-1")["never"]


def test_the_eeprom(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"corrupt_memory": "eeprom", "at": 2, "bytes": {"16": 7}})
    assert mission.cfe.psp.retained.eeprom[16] == 7


# -- calls -------------------------------------------------------------------------------------------------------------

CALLER = """
    def attempt(cfe, what, *args):
        area, name = what.split(".")
        try:
            return getattr(getattr(cfe, area), name)(*args)
        except Exception as error:
            cfe.os.printf(f"WORKER {what}{args[1:]}: {error.name}")

    def worker_main(cfe):
        cfe.es.run_loop()
        queue = cfe.os.queue_create("WORK_QUEUE", 5, 8)
        for number in range(4):
            attempt(cfe, "os.queue_put", queue, bytes([number]))
        pool = cfe.es.pool_create(2000)
        for number in range(3):
            attempt(cfe, "es.get_pool_buf", pool, 16 + number)
        file = cfe.os.open_create("/ram/x", 1, 1)
        for number in range(3):
            attempt(cfe, "os.write", file, bytes([number]))
        for number in range(2):
            attempt(cfe, "os.bin_sem_create", f"S{number}", 1)
            attempt(cfe, "os.mut_sem_create", f"M{number}", 1)
"""


def failures(folder: Path, *faults: dict[str, object]) -> list[str]:
    mission = fly(folder, *faults, startup=STARTUP, worker=CALLER, seconds=1)
    return [line.removeprefix("WORKER ") for line in told(mission, "WORKER ")]


@pytest.mark.slow
def test_the_nth_call_fails(tmp_path: Path) -> None:
    mine = {"app": "WORKER"}
    assert failures(tmp_path, {"fail": "OS_QueuePut", "number": 3, **mine}) == [
        "os.queue_put(b'\\x02',): OS_QUEUE_FULL"
    ]
    assert failures(tmp_path, {"fail": "es.get_pool_buf", "number": 2, **mine}) == [
        "es.get_pool_buf(17,): CFE_ES_ERR_MEM_BLOCK_SIZE"
    ]
    assert failures(tmp_path, {"fail": "CFE_ES_GetPoolBuf", "number": 1, "status": "CFE_ES_BAD_ARGUMENT", **mine}) == [
        "es.get_pool_buf(16,): CFE_ES_BAD_ARGUMENT"
    ]
    assert failures(tmp_path, {"fail": "OS_write", "number": 1, "object": "/ram/x"}) == [
        "os.write(b'\\x00',): OS_ERROR"
    ]
    assert failures(tmp_path, {"fail": "os.bin_sem_create", "object": "S1"}) == [
        "os.bin_sem_create(1,): OS_ERR_NO_FREE_IDS"
    ]
    assert failures(tmp_path, {"fail": "OS_MutSemCreate", "app": "WORKER", "number": 2})[0].endswith(
        "OS_ERR_NO_FREE_IDS"
    )
    assert failures(tmp_path, {"fail": "os.queue_put", "object": "OTHER_QUEUE"}) == []
    assert len(failures(tmp_path, {"fail": "os.queue_put", "object": "WORK_QUEUE"})) == 4


def test_each_processor_has_the_failing_call(tmp_path: Path) -> None:
    fault = {"fail": "OS_QueuePut", "app": "WORKER", "number": [1, 6]}
    reset = {"reset": "processor", "at": 2}
    mission = fly(tmp_path, fault, reset, startup=STARTUP, worker=CALLER, seconds=4)
    assert [line.split("(")[1][:7] for line in told(mission, "WORKER os.queue_put")] == ["b'\\x00'", "b'\\x01'"]


# -- network -----------------------------------------------------------------------------------------------------------


def datagrams(folder: Path, *faults: dict[str, object]) -> list[bytes]:
    """Return the data that an application's socket gets from ten external datagrams."""
    worker = """
        def worker_main(cfe):
            socket = cfe.os.socket_open(1, 1)
            address = cfe.os.socket_addr_init(1)
            cfe.os.socket_addr_set_port(address, 1234)
            cfe.os.socket_bind(socket, address)
            while cfe.es.run_loop():
                found = cfe.os.socket_recv_from(socket, 100, 1000)
                if found is not None:
                    cfe.os.printf(f"WORKER gets {found[0].hex()}")
    """
    injector = FaultInjector(FaultPlan.from_dict({"faults": list(faults)}))
    path = write_mission(folder, STARTUP, worker=worker)
    with Mission(path, console=Console(quiet=True), attachments=[injector]) as mission:
        mission.run_for(1)
        for number in range(5):
            mission.network.send(Datagram(Place("127.0.0.1", 5), Place("127.0.0.1", 1234), bytes([number])))
            mission.run_for(0.1)
        mission.run_for(1)
    return [bytes.fromhex(line.split()[-1]) for line in told(mission, "WORKER gets")]


def test_datagrams(tmp_path: Path) -> None:
    plain = [bytes([number]) for number in range(5)]
    assert datagrams(tmp_path) == plain
    assert datagrams(tmp_path, {"drop": "udp:1234", "number": 2}) == [*plain[:1], *plain[2:]]
    assert datagrams(tmp_path, {"duplicate": "udp:*", "number": 2}) == [*plain[:2], *plain[1:]]
    assert datagrams(tmp_path, {"corrupt": "udp:1234", "number": 1, "bytes": {"0": 9}}) == [b"\x09", *plain[1:]]
    assert datagrams(tmp_path, {"delay": "udp:1234", "number": 1, "by": 0.15}) == [plain[1], plain[0], *plain[2:]]
    assert datagrams(tmp_path, {"reorder": "udp:1234", "number": 1}) == [plain[1], plain[0], *plain[2:]]
    assert datagrams(tmp_path, {"drop": "udp:99"}) == plain


# -- the processor -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("how", "reset_type", "is_fault", "why"),
    [
        ("processor", 1, False, "PROCESSOR RESET called"),
        ("poweron", 2, False, "POWERON RESET called"),
        ("exception", 1, True, "CFE_TBL: "),
        ("watchdog", 1, True, "the watchdog bites"),
    ],
)
@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_resets(tmp_path: Path, tasks: str, how: str, reset_type: int, is_fault: bool, why: str) -> None:
    mission = fly(tmp_path, {"reset": how, "at": 2}, seconds=5, tasks=tasks)
    (reset,) = mission.record.resets
    if how == "exception":
        assert "InjectedCrash: fault reset-1" in reset.reason
    assert (reset.reset_type, reset.fault, reset.at_ns // 10**8) == (reset_type, is_fault, 20)
    assert reset.reason.startswith(why)
    assert values(mission).count(0) == 2
    assert {STATE_NAMES[app.state] for app in mission.cfe.es.apps} == {"RUNNING"}
    assert row(mission, "reset-1")["times"] == 1


def test_two_resets_and_a_fault_after_them(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"reset": "processor", "at": [2, 3]}, {"crash": "TAKER", "at": 4.5}, seconds=6)
    assert len(mission.record.resets) == 2
    assert mission.record.history["TAKER"].deaths == 1
