"""The board: boot lines, clock, resets and the data that survives them, watchdog."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.osal import Osal
from cfepy.psp import BoardProfile, Psp, RestartType, Retained
from cfepy.rtos import Kernel
from cfepy.status import CFE_PSP_ERROR, CfeError, OsalError
from cfepy.writing.console import Console

MS = 1_000_000
TEST_BOARD = BoardProfile("test", memory="linux")
BOOT = """\
CFE_PSP: Default Reset SubType = 1
CFE_PSP: Default CPU ID = 1
CFE_PSP: Default Spacecraft ID = 66
CFE_PSP: Default CPU Name: cpu1
CFE_PSP: initializing module 'soft_timebase' with ID 0110ff00
CFE_PSP: Instantiated software timebase 'cFS-Master' running at 10000 usec
CFE_PSP: initializing module 'ram_notimpl' with ID 0110ff03
CFE_PSP: Physical RAM access not implemented
CFE_PSP: initializing module 'port_notimpl' with ID 0110ff04
CFE_PSP: I/O Port access not implemented
CFE_PSP: initializing module 'endian_api' with ID 0110ff07
CFE_PSP: Host CPU Endian=LITTLE
CFE_PSP: EEPROM Range (2) created: Start Address = 10000000, Size = 00080000 Status = 0
CFE_PSP: Starting the cFE with a POWER ON reset.
CFE_PSP: Clearing out CFE CDS Shared memory segment.
CFE_PSP: Clearing out CFE Reset Shared memory segment.
CFE_PSP: Clearing out CFE User Reserved Shared memory segment.
"""


class Board:
    """A PSP with everything below it."""

    def __init__(self, retained: Retained | None = None, profile: BoardProfile = TEST_BOARD, **hooks: Any) -> None:
        self.kernel = Kernel("thread")
        self.console = Console(quiet=True)
        self.osal = Osal(self.kernel, PlatformConfig(), self.console)
        self.psp = Psp(
            self.kernel,
            profile,
            PlatformConfig(),
            self.console,
            self.osal,
            retained=retained,
            **hooks,
        )


@pytest.fixture
def board() -> Iterator[Board]:
    """Return a board that has not been booted."""
    made = Board()
    with made.kernel:
        yield made


def test_boot_lines_match_nasas_linux_psp(board: Board) -> None:
    assert board.psp.boot() == RestartType(2, 1)
    assert board.console.lines == BOOT.splitlines()
    board.kernel.run(until_ns=55 * MS)
    assert board.osal.time_base_get_free_run(board.osal.time_base_get_id_by_name("cFS-Master")) == 50_000


def test_psp_reports_identity_time_and_version(board: Board) -> None:
    psp = board.psp
    board.kernel.run(until_ns=2_000_000_300)
    assert (psp.get_spacecraft_id(), psp.get_processor_id(), psp.get_processor_name()) == (66, 1, "cpu1")
    assert psp.get_time() == 20_000_003
    assert psp.get_timebase() == (2, 300)
    assert psp.get_timer_ticks_per_second() == psp.get_timer_low32_rollover() == 1_000_000_000
    assert psp.get_version_string() == "v7.0.0+dev0"
    assert (psp.get_version_code_name(), psp.get_version_number(), psp.get_build_number()) == ("Draco", (7, 0, 0, 0), 0)


def test_processor_reset_keeps_memory_and_power_on_reset_clears_it() -> None:
    retained = Retained(cds_bytes=64)
    first = Board(retained)
    with first.kernel:
        first.psp.boot()
        first.psp.write_to_cds(b"critical", 8)
        first.psp.get_reset_area()[:2] = b"rs"
        first.psp.get_user_reserved_area()[:2] = b"us"
        retained.kept["ES"] = "log"
        first.psp.restart(1)
    assert first.console.lines[-3:] == [
        "CFE_PSP: Exiting cFE with PROCESSOR Reset status.",
        "",
        "CFE_PSP: Shutdown initiated - Exiting cFE",
    ]
    second = Board(retained)
    with second.kernel:
        assert second.psp.boot() == RestartType(1, 1)
        assert second.psp.get_restart_type() == RestartType(1, 1)
        assert second.console.lines[-2:] == [
            "CFE_PSP: Normal exit from previous cFE instance",
            "CFE_PSP: Starting the cFE with a PROCESSOR reset.",
        ]
        assert second.psp.read_from_cds(8, 8) == b"critical"
        assert bytes(second.psp.get_reset_area()[:2]) == b"rs"
        assert retained.kept == {"ES": "log"}
        second.psp.restart(2)
    third = Board(retained)
    with third.kernel:
        assert third.psp.boot().reset_type == 2
        assert third.psp.read_from_cds(8, 8) == bytes(8)
        assert bytes(third.psp.get_user_reserved_area()[:2]) == bytes(2)
        assert not retained.kept


def test_abnormal_exit_is_reported_at_the_next_boot() -> None:
    retained = Retained()
    starts: list[tuple[int, str]] = []
    for _ in range(4):
        board = Board(retained)
        with board.kernel:
            reset_type = board.psp.boot().reset_type
        starts.append((reset_type, next((line for line in board.console.lines if "previous" in line), "")))
    abnormal = "CFE_PSP: Abnormal exit from previous cFE instance"
    assert starts == [(2, ""), (1, abnormal), (2, abnormal), (1, abnormal)]


def test_power_on_restart_removes_the_boot_record() -> None:
    retained = Retained()
    first = Board(retained)
    with first.kernel:
        first.psp.boot()
        first.psp.restart(2)
    assert first.console.lines[-6:] == [
        "CFE_PSP: Exiting cFE with POWERON Reset status.",
        "CFE_PSP: Critical Data Store Shared memory segment removed",
        "Reset Area Shared memory segment removed",
        "User Reserved Area Shared memory segment removed",
        "",
        "CFE_PSP: Shutdown initiated - Exiting cFE",
    ]
    second = Board(retained)
    with second.kernel:
        assert second.psp.boot(0, 5) == RestartType(2, 5)
        assert second.console.lines[0] == "CFE_PSP: Reset SubType: 5"
        assert not [line for line in second.console.lines if "previous" in line]


def test_access_beyond_the_cds_is_refused(board: Board) -> None:
    size = board.psp.get_cds_size()
    assert size == 131072
    for call in (
        lambda: board.psp.write_to_cds(b"ab", size - 1),
        lambda: board.psp.read_from_cds(size, 0),
        lambda: board.psp.read_from_cds(-1, 1),
        lambda: board.psp.read_from_cds(0, size + 1),
    ):
        with pytest.raises(OsalError) as caught:
            call()
        assert caught.value.status == CFE_PSP_ERROR
    board.psp.write_to_cds(b"ab", size - 2)


def test_restart_does_not_return(board: Board) -> None:
    log: list[str] = []
    board.osal.task_create("T", lambda: (board.psp.restart(1), log.append("back")), 100, 50)
    board.kernel.run(until_ns=1000 * MS)
    assert board.kernel.now == 0
    board.kernel.run(until_ns=60_000 * MS)
    assert log == []


def test_mission_may_handle_a_restart() -> None:
    kinds: list[int] = []
    board = Board(on_restart=lambda kind, reason, fault: kinds.append(kind))
    with board.kernel:
        board.psp.restart(2)
    assert kinds == [2]
    assert "CFE_PSP: Exiting cFE with POWERON Reset status." in board.console.lines


def test_panic(board: Board) -> None:
    with pytest.raises(CfeError, match="code 5"):
        board.psp.panic(5)
    assert board.console.lines == [
        "CFE_PSP_Panic called with error code = 0x00000005. Exiting.",
        "The cFE could not start.",
    ]


def test_endian_helpers() -> None:
    assert Psp.hto_be16(0x1234) == Psp.be16_to_h(0x1234) == 0x3412
    assert Psp.hto_be32(0x12345678) == 0x78563412
    assert Psp.be64_to_h(1) == 1 << 56
    assert (Psp.hto_le16(0x12345), Psp.le32_to_h(5), Psp.hto_le64(5)) == (0x2345, 5, 5)
    assert Psp.is_little_endian()
    assert not Psp.is_big_endian()


def _served(board: Board, psp: Psp, times: int, period_ms: int) -> None:
    def server() -> None:
        for _ in range(times):
            board.osal.task_delay(period_ms)
            psp.watchdog_service()

    board.osal.task_create("SERVER", server, 100, 50)


class Watched(Board):
    """A board with a watchdog that counts to 10 s at most. `resets` are the times in ms at which it expired."""

    def __init__(self, retained: Retained | None = None) -> None:
        self.resets: list[int] = []
        profile = BoardProfile("watched", watchdog_max_ms=10_000)
        super().__init__(retained, profile, on_restart=self._reset)

    def _reset(self, reset_type: int, reason: str, fault: bool) -> None:
        assert (reset_type, fault) == (1, True)
        assert "watchdog was not served" in reason
        self.resets.append(self.kernel.now // MS)


def test_watchdog_resets_when_it_is_not_serviced() -> None:
    board = Watched()
    with board.kernel:
        board.psp.watchdog_set(100)
        board.psp.watchdog_enable()
        _served(board, board.psp, 5, 80)
        board.kernel.run(until_ns=2000 * MS)
    assert board.resets == [500]
    assert board.psp.watchdog.bites == 1


def test_watchdog_reset_is_reported_at_the_next_boot() -> None:
    retained = Retained()
    board = Watched(retained)
    with board.kernel:
        board.psp.boot()
        board.psp.watchdog_set(100)
        board.psp.watchdog_enable()
        board.kernel.run(until_ns=2000 * MS)
        assert not [line for line in board.console.lines if "Exiting" in line]
    second = Board(retained)
    with second.kernel:
        assert second.psp.boot() == RestartType(1, 4)
        assert second.console.lines[0] == "CFE_PSP: Reset SubType: 4"
        assert "CFE_PSP: Abnormal exit from previous cFE instance" in second.console.lines
        second.psp.restart(1)
    third = Board(retained)
    with third.kernel:
        assert third.psp.boot() == RestartType(1, 1)


def test_disabled_watchdog_does_not_reset() -> None:
    board = Watched()
    with board.kernel:
        board.psp.watchdog_set(100)
        board.psp.watchdog_enable()
        board.psp.watchdog_disable()
        board.kernel.run(until_ns=2000 * MS)
        board.psp.watchdog_init()
        assert board.psp.watchdog_get() == 10_000
        board.psp.watchdog_set(10_001)
        assert board.psp.watchdog_get() == 10_000
    assert board.resets == []


def test_shorter_time_of_the_watchdog_takes_effect_at_once() -> None:
    board = Watched()
    with board.kernel:
        board.psp.watchdog_set(5000)
        board.psp.watchdog_enable()
        board.kernel.run(until_ns=10 * MS)
        board.psp.watchdog_set(100)
        board.kernel.run(until_ns=2000 * MS)
    assert board.resets == [110]


def test_watchdog_without_a_reset_function_keeps_its_value(board: Board) -> None:
    board.psp.watchdog_set(1)
    board.psp.watchdog_enable()
    board.kernel.run(until_ns=2000 * MS)
    assert board.psp.watchdog_get() == 1
    assert not board.kernel.tasks
    board.psp.watchdog_init()
    assert board.psp.watchdog_get() == 0xFFFFFFFF
