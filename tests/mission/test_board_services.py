"""Requests of applications to OSAL and the board, in whole missions: loading code, the watchdog, EEPROM."""

from __future__ import annotations

from pathlib import Path

from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

STARTUP = "CFE_APP, app, MAIN, APP, 50, 4096, 0x0, 0;\n"


def flight(folder: Path, app: str, seconds: float, board: str = "linux", **sources: str) -> list[str]:
    """Return the console of a mission with one application."""
    console = Console(quiet=True)
    with Mission(write_mission(folder, STARTUP, app=app, **sources), board=board, console=console) as mission:
        mission.run_for(seconds)
    return console.lines


def test_an_application_loads_code(tmp_path: Path) -> None:
    lines = flight(
        tmp_path,
        """
        from cfepy.app import CfeError

        def MAIN(cfe):
            module = cfe.os.module_load("TOOLS", "/cf/tools.so")
            twice = cfe.os.module_symbol_lookup(module, "twice")
            cfe.os.printf(f"{twice(21)} {cfe.os.symbol_lookup('twice') is twice} {cfe.os.module_info(module).filename}")
            cfe.os.module_unload(module)
            try:
                cfe.os.module_load("TOOLS", "/cf/none.so")
            except CfeError as error:
                cfe.os.printf(f"refused: {error.name}")
        """,
        1,
        tools="""
        def twice(number):
            return 2 * number
        """,
    )
    assert "42 True /cf/tools.so" in lines
    assert "refused: OS_ERROR" in lines


def test_hanging_application_is_ended_by_the_watchdog(tmp_path: Path) -> None:
    lines = flight(
        tmp_path,
        """
        def MAIN(cfe):
            cfe.os.printf(f"start {tuple(cfe.psp.get_restart_type())}")
            cfe.psp.watchdog_set(2000)
            cfe.psp.watchdog_enable()
            for _ in range(3):
                cfe.os.task_delay(1500)
                cfe.psp.watchdog_service()
            cfe.os.task_delay(60_000)
        """,
        9,
        board="rx64m",
    )
    assert [line for line in lines if line.startswith("start")] == ["start (2, 1)", "start (1, 4)"]
    assert "CFE_PSP: Reset SubType: 4" in lines


def test_eeprom_and_ram_disk_survive_a_processor_reset(tmp_path: Path) -> None:
    (tmp_path / "mission.yaml").write_text("memory: direct\n", encoding="utf-8")
    lines = flight(
        tmp_path,
        """
        def MAIN(cfe):
            eeprom = cfe.psp.mem_range_get(1).start_addr
            boots = cfe.psp.mem_read8(eeprom)
            there = cfe.os.files.exists("/ram/kept")
            cfe.os.printf(f"boot {boots} {there} {cfe.os.files.mount_points()}")
            cfe.psp.eeprom_write8(eeprom, boots + 1)
            cfe.os.files.write_file("/ram/kept", b"")
            cfe.os.mkfs("/ramdev1", "RAM1", 512, 8)
            cfe.os.mount("/ramdev1", "/scratch")
            cfe.os.task_delay(100)
            if boots < 2:
                cfe.psp.restart(1 if boots == 0 else 2)
        """,
        20,
    )
    assert [line for line in lines if line.startswith("boot")] == [
        "boot 0 False ['/cf', '/ram']",
        "boot 1 True ['/cf', '/ram']",
        "boot 2 False ['/cf', '/ram']",
    ]


def test_wrong_address_ends_the_flight_software_as_on_linux(tmp_path: Path) -> None:
    lines = flight(
        tmp_path,
        """
        def MAIN(cfe):
            cfe.psp.mem_validate_range(16, 4, 1)
            try:
                cfe.psp.mem_set(16, 0, 4)
            finally:
                cfe.os.printf("ends")
        """,
        20,
    )
    assert "cfepy.psp.addresses.BadAddress: SIGSEGV (invalid memory), address 0x10" in "\n".join(lines)
    assert not any("Restart" in line for line in lines)


def test_stored_exception_context_survives_the_reset(tmp_path: Path) -> None:
    console = Console(quiet=True)
    app = """
    def MAIN(cfe):
        if cfe.psp.get_restart_type().reset_type == 2:
            raise ValueError("first time only")
        cfe.os.printf(f"context: {cfe.psp.exception_copy_context(0x1110000, 256)}")
    """
    reset_on_exception = STARTUP.replace("0;", "1;")
    with Mission(write_mission(tmp_path, reset_on_exception, app=app), console=console) as mission:
        mission.run_for(10)
    text = "\n".join(console.lines)
    assert "CFE_ES_RunExceptionScan: ExceptionID 0x1110000 in TaskID" in text
    assert "context: b'app.py:4" in text
