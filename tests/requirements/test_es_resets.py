"""NASA's requirements for resets of the processor (cES1009, 1010, 1024, 1025, 1317, 1318, 15xx, 1709)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.console import Console
from cfepy.es import packets as pk
from cfepy.mission import Mission
from cfepy.psp.psp import (
    RST_SUBTYPE_HW_SPECIAL_COMMAND,
    RST_SUBTYPE_HW_WATCHDOG,
    RST_SUBTYPE_UNDEFINED_RESET,
    RST_TYPE_POWERON,
    RST_TYPE_PROCESSOR,
)
from cfepy.status import CFE_ES_BAD_ARGUMENT, CfeError
from tests.mission.flights import write_mission
from tests.requirements.covers import covers
from tests.requirements.ground import Ground

PROCESSOR, POWERON = RST_TYPE_PROCESSOR, RST_TYPE_POWERON
STARTUP = """
    CFE_LIB, tools, tools_init, TOOLS, 0, 0, 0x0, 0;
    CFE_APP, looper, looper_main, LOOPER, 50, 16384, 0x0, 0;
    !
"""
SOURCES = {
    "tools": """
        def tools_init(cfe):
            cfe.os.printf("TOOLS ready")
            return 0
    """,
    "looper": """
        def looper_main(cfe):
            cfe.os.printf("LOOPER starts")
            while cfe.es.run_loop():
                cfe.os.task_delay(100)
    """,
    "resets": """
        def resets_main(cfe):
            cfe.es.reset_cfe(1)
            cfe.os.printf("came back from a reset")
    """,
    "powers": """
        def powers_main(cfe):
            cfe.es.reset_cfe(2)
            cfe.os.printf("came back from a reset")
    """,
    "broken": """
        def broken_main(cfe):
            cfe.es.run_loop()
            raise ValueError("always")
    """,
}


@pytest.fixture
def ground(tmp_path: Path) -> Iterator[Ground]:
    with Mission(write_mission(tmp_path, STARTUP, **SOURCES), console=Console(quiet=True)) as mission:
        mission.run(2)
        yield Ground(mission)


def housekeeping(ground: Ground) -> dict[str, int]:
    return ground.answer(pk.SEND_HK, pk.HK_TLM)


def reset(ground: Ground, kind: int) -> None:
    ground.command(pk.RESTART, 3, RestartType=kind)


def causes(ground: Ground) -> list[tuple[int, int, str]]:
    """What the exception and reset log says: type, subtype, description."""
    slots = ground.mission.cfe.es.reset.er_log.slots
    return [(entry.reset_type, entry.reset_subtype, entry.description) for entry in slots if entry is not None]


# -- asking for a reset ------------------------------------------------------------------------------------------------


@covers("cES1009", "cES1509", "cES1500", "cES1502")
def test_cES1009_a_power_on_reset_by_command(ground: Ground) -> None:
    reset(ground, PROCESSOR)
    assert len(causes(ground)) == 2
    reset(ground, POWERON)
    assert ground.lines("CFE_ES_ResetCFE")[-1] == (
        "CFE_ES_ResetCFE: POWERON RESET called from CFE_ES_ResetCFE (Commanded)."
    )
    assert "CFE_PSP: Exiting cFE with POWERON Reset status." in ground.mission.console.lines
    values = housekeeping(ground)
    assert (values["ResetType"], values["ResetSubtype"], values["ProcessorResets"]) == (POWERON, 1, 0)
    assert causes(ground) == [(POWERON, 1, "POWER ON RESET due to Power Cycle (Power Cycle)")]
    assert len(ground.lines("LOOPER starts")) == 3


@covers("cES1010", "cES1510", "cES1512", "cES1520", "cES1521")
def test_cES1010_a_processor_reset_by_command(ground: Ground) -> None:
    ground.command(pk.SET_MAX_PR_COUNT, MaxPRCount=5)
    reset(ground, PROCESSOR)
    values = housekeeping(ground)
    assert (values["ResetType"], values["ResetSubtype"], values["BootSource"]) == (PROCESSOR, 1, 1)
    assert (values["ProcessorResets"], values["MaxProcessorResets"]) == (1, 5)
    assert (values["ERLogIndex"], values["ERLogEntries"]) == (2, 2)
    assert causes(ground) == [
        (POWERON, 1, "POWER ON RESET due to Power Cycle (Power Cycle)"),
        (PROCESSOR, 5, "PROCESSOR RESET called from CFE_ES_ResetCFE (Commanded)."),
    ]
    assert len(ground.lines("LOOPER starts")) == 2


@pytest.mark.parametrize(("app", "kind"), [("resets", PROCESSOR), ("powers", POWERON)])
@covers("cES1317", "cES1318")
def test_cES1317_an_application_asks_for_a_reset(ground: Ground, app: str, kind: int) -> None:
    fields = {"AppEntryPoint": f"{app}_main", "AppFileName": app, "Priority": 60}
    ground.command(pk.START_APP, 3, Application=app.upper(), **fields)
    assert ground.mission.cfe.es.get_reset_type().reset_type == kind
    assert ground.mission.record.resets[0].reset_type == kind
    assert not ground.lines("came back")
    with pytest.raises(CfeError) as caught:
        ground.mission.cfe.es.reset_cfe(3)
    assert caught.value.status == CFE_ES_BAD_ARGUMENT
    assert ground.lines("CFE_ES_ResetCFE")[-1] == "CFE_ES_ResetCFE: Invalid Reset Type: 3."


# -- counting them -----------------------------------------------------------------------------------------------------


def test_cES1024_the_count_of_processor_resets_can_be_set_to_zero(ground: Ground) -> None:
    reset(ground, PROCESSOR)
    assert housekeeping(ground)["ProcessorResets"] == 1
    assert ground.command(pk.RESET_PR_COUNT) == ["CFE_ES 72: Set Processor Reset Count to Zero"]
    assert housekeeping(ground)["ProcessorResets"] == 0


def test_cES1025_the_limit_of_processor_resets_can_be_set(ground: Ground) -> None:
    assert ground.command(pk.SET_MAX_PR_COUNT, MaxPRCount=7) == ["CFE_ES 73: Maximum Processor Reset Count set to: 7"]
    assert housekeeping(ground)["MaxProcessorResets"] == 7


def test_cES1709_too_many_processor_resets_become_a_power_on_reset(ground: Ground) -> None:
    for count in (1, 2):
        reset(ground, PROCESSOR)
        assert housekeeping(ground)["ProcessorResets"] == count
    reset(ground, PROCESSOR)
    assert [each.reset_type for each in ground.mission.record.resets] == [PROCESSOR, PROCESSOR, POWERON]
    assert ground.lines("CFE_ES_ResetCFE")[-1] == (
        "CFE_ES_ResetCFE: POWER ON RESET due to max proc resets (Commanded)."
    )
    assert housekeeping(ground)["ProcessorResets"] == 0


def test_cES1709_exceptions_count_too(ground: Ground) -> None:
    fields = {"AppEntryPoint": "broken_main", "AppFileName": "broken", "Priority": 60, "ExceptionAction": 1}
    for _ in range(3):
        ground.command(pk.START_APP, 3, Application="BROKEN", **fields)
    assert [each.reset_type for each in ground.mission.record.resets] == [PROCESSOR, PROCESSOR, POWERON]
    scans = ground.lines("CFE_ES_RunExceptionScan: P") + ground.lines("CFE_ES_RunExceptionScan: M")
    assert scans == [
        "CFE_ES_RunExceptionScan: Processor Reset count not reached (0/2)",
        "CFE_ES_RunExceptionScan: Processor Reset count not reached (1/2)",
        "CFE_ES_RunExceptionScan: Maximum Processor Reset count reached (2)",
    ]


@pytest.mark.parametrize(
    ("kind", "subtype", "kept", "text"),
    [
        (POWERON, RST_SUBTYPE_HW_SPECIAL_COMMAND, 3, "POWER ON RESET due to HW Special Cmd (Hw Spec Cmd)"),
        (POWERON, RST_SUBTYPE_UNDEFINED_RESET, 7, "POWER ON RESET due to other cause (See Subtype)"),
        (PROCESSOR, RST_SUBTYPE_HW_WATCHDOG, 4, "PROCESSOR RESET due to Watchdog (Watchdog)."),
        (PROCESSOR, RST_SUBTYPE_UNDEFINED_RESET, 4, "PROCESSOR RESET due to Watchdog (Watchdog)."),
        (
            PROCESSOR,
            RST_SUBTYPE_HW_SPECIAL_COMMAND,
            3,
            "PROCESSOR RESET due to Hardware Special Command (Hw Spec Cmd).",
        ),
    ],
)
@covers("cES1500", "cES1510")
def test_cES1500_the_subtype_of_a_reset_is_told_apart(
    ground: Ground, kind: int, subtype: int, kept: int, text: str
) -> None:
    """As at a boot for which nobody asked."""
    es = ground.mission.cfe.es
    es.setup_reset_variables(kind, subtype, 1)
    assert es.get_reset_type() == (kind, kept)
    assert causes(ground)[-1] == (kind, subtype, text)
    said = text.replace("(Hw Spec", "(HW Spec") if kind == PROCESSOR else f"{text}."
    assert ground.lines("CFE_ES_SetupResetVariables")[-1] == f"CFE_ES_SetupResetVariables: {said}"


@pytest.mark.parametrize(
    ("subtype", "cause"), [(RST_SUBTYPE_HW_WATCHDOG, "Watchdog"), (RST_SUBTYPE_HW_SPECIAL_COMMAND, "HW Spec Cmd")]
)
def test_cES1709_resets_by_the_hardware_count_too(ground: Ground, subtype: int, cause: str) -> None:
    ground.command(pk.SET_MAX_PR_COUNT, MaxPRCount=0)
    ground.mission.cfe.es.setup_reset_variables(PROCESSOR, subtype, 1)
    ground.mission.run(3)
    assert ground.lines("CFE_ES_SetupResetVariables")[1] == (
        f"CFE_ES_SetupResetVariables: POWER ON RESET due to max proc resets ({cause})."
    )
    assert ground.mission.record.resets[0].reset_type == POWERON


# -- what is kept and what is not --------------------------------------------------------------------------------------


@covers("cES1511", "cES1522")
def test_cES1511_the_system_log_outlives_a_processor_reset(ground: Ground) -> None:
    ground.mission.cfe.es.write_to_sys_log("before the reset")
    reset(ground, PROCESSOR)
    values, log = housekeeping(ground), ground.mission.cfe.es.syslog.read()
    assert values["SysLogMode"] == 1
    assert b"before the reset\n" in log
    assert log.index(b"before the reset") < log.index(b"CFE_ES_ResetCFE: PROCESSOR RESET called") < len(log)
    assert log.count(b"CFE_ES_Main in EARLY_INIT state") == 2


@covers("cES1501", "cES1523")
def test_cES1501_the_system_log_does_not_outlive_a_power_on_reset(ground: Ground) -> None:
    ground.command(pk.OVER_WRITE_SYS_LOG, Mode=1)
    ground.mission.cfe.es.write_to_sys_log("before the reset")
    reset(ground, POWERON)
    assert housekeeping(ground)["SysLogMode"] == 0
    assert ground.mission.cfe.es.syslog.read().count(b"CFE_ES_Main in EARLY_INIT state") == 1
    assert b"before the reset" not in ground.mission.cfe.es.syslog.read()


@covers("cES1503", "cES1507")
def test_cES1503_the_ram_disk_is_new_after_a_power_on_reset(ground: Ground) -> None:
    ground.mission.files.write_file("/ram/file", b"data")
    reset(ground, POWERON)
    assert not ground.mission.files.exists("/ram/file")
    ground.mission.files.write_file("/ram/file", b"data")
    assert ground.mission.cfe.os.file_sys_stat_volume("/ram").total_blocks == 4096


@covers("cES1513", "cES1517")
def test_cES1513_the_ram_disk_outlives_a_processor_reset(ground: Ground) -> None:
    ground.mission.files.write_file("/ram/file", bytes(512 * 2048))
    reset(ground, PROCESSOR)
    assert ground.file("/ram/file") == bytes(512 * 2048)
    assert ground.lines("CFE_ES_InitializeFileSystems") == [
        "CFE_ES_InitializeFileSystems: Volatile Disk has 50 Percent free space."
    ]


def test_cES1517_1_a_ram_disk_without_room_is_formatted(ground: Ground) -> None:
    ground.mission.files.write_file("/ram/file", bytes(512 * 3000))
    reset(ground, PROCESSOR)
    assert not ground.mission.files.exists("/ram/file")
    assert ground.lines("CFE_ES_InitializeFileSystems") == [
        "CFE_ES_InitializeFileSystems: Volatile Disk has 26 Percent free space.",
        "CFE_ES_InitializeFileSystems: Insufficient Free Space on Volatile Disk, Reformatting.",
    ]


@pytest.mark.parametrize("kind", [PROCESSOR, POWERON])
@covers("cES1505", "cES1506", "cES1515", "cES1516")
def test_cES1505_the_executive_has_its_objects_after_any_reset(ground: Ground, kind: int) -> None:
    names = [task.task_name for task in ground.mission.cfe.es.tasks()]
    reset(ground, kind)
    es = ground.mission.cfe.es
    assert [task.task_name for task in es.tasks()] == names
    assert ground.mission.cfe.sb.get_pipe_id_by_name("ES_CMD_PIPE")
    assert ground.mission.files.read_file("/cf/looper.py")


@pytest.mark.parametrize("what", ["function", "application"])
def test_cES1515_1_an_executive_without_its_objects_panics(tmp_path: Path, what: str) -> None:
    def fail(*_: object, **__: object) -> Any:
        raise CfeError(CFE_ES_BAD_ARGUMENT, "no memory")

    mission = Mission(write_mission(tmp_path, "!"), console=Console(quiet=True))
    if what == "function":
        mission.cfe.sb.early_init = fail  # type: ignore[method-assign]
        said = "Error returned when calling function: CFE_SB_EarlyInit: EC = 0xC400000A"
    else:
        mission.processor.osal.task_create = fail  # type: ignore[method-assign]
        said = "OS_TaskCreate error creating core App: CFE_EVS: EC = 0xC8000005"
    with pytest.raises(CfeError):
        mission.run(2)
    assert Ground(mission).lines("CFE_ES_CreateObjects")[-1] == f"CFE_ES_CreateObjects: {said}"
    assert "CFE_PSP_Panic called with error code = 0x00000006. Exiting." in mission.console.lines
    mission.close()


# -- the startup script ------------------------------------------------------------------------------------------------


@covers("cES1508", "cES1508.1", "cES1508.2")
def test_cES1508_the_startup_script_is_worked_off_after_power_on(ground: Ground) -> None:
    ground.mission.files.write_file("/ram/cfe_es_startup.scr", b"!")
    reset(ground, POWERON)
    assert (
        ground.lines("CFE_ES_StartApplications")
        == ["CFE_ES_StartApplications: Opened ES App Startup file: /cf/cfe_es_startup.scr"] * 2
    )
    assert (len(ground.lines("TOOLS ready")), len(ground.lines("LOOPER starts"))) == (2, 2)
    values = housekeeping(ground)
    assert (values["RegisteredExternalApps"], values["RegisteredLibs"]) == (1, 1)


@covers("cES1518", "cES1518.1", "cES1518.2")
def test_cES1518_a_script_on_the_ram_disk_comes_first_after_a_processor_reset(ground: Ground) -> None:
    script = b"CFE_LIB,tools,tools_init,PATCHED,0,0,0,0;CFE_APP,looper,looper_main,OTHER,50,16384,0,0;!"
    ground.mission.files.write_file("/ram/cfe_es_startup.scr", script)
    reset(ground, PROCESSOR)
    assert ground.lines("CFE_ES_StartApplications")[-1] == (
        "CFE_ES_StartApplications: Opened ES App Startup file: /ram/cfe_es_startup.scr"
    )
    es = ground.mission.cfe.es
    assert [app.name for app in es.apps if not app.is_core] == ["OTHER"]
    assert [lib.name for lib in es.libs] == ["PATCHED"]


@covers("cES1519", "cES1519.1", "cES1519.2")
def test_cES1519_else_it_is_the_one_that_is_always_there(ground: Ground) -> None:
    reset(ground, PROCESSOR)
    assert ground.lines("CFE_ES_StartApplications")[-2:] == [
        "CFE_ES_StartApplications: Cannot Open Volatile Startup file: /ram/cfe_es_startup.scr, Trying Nonvolatile.",
        "CFE_ES_StartApplications: Opened ES App Startup file: /cf/cfe_es_startup.scr",
    ]
    es = ground.mission.cfe.es
    assert [app.name for app in es.apps if not app.is_core] == ["LOOPER"]
    assert [lib.name for lib in es.libs] == ["TOOLS"]
