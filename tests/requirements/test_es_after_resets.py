"""NASA's requirements for data kept over a reset, data made anew, and the following start (cES1501 to 1523)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.attachment import Attachment
from cfepy.es import packets as pk
from cfepy.evs import packets as evs
from cfepy.ids import OS_TASK_BASE
from cfepy.mission import Mission
from cfepy.osal.limits import OS_READ_ONLY
from cfepy.sb import SoftwareBus
from cfepy.sb import packets as sb
from cfepy.status import CFE_ES_BAD_ARGUMENT, CfeError
from cfepy.tbl import packets as tbl
from cfepy.time import packets as time
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.requirements.covers import covers
from tests.requirements.flight import POWERON_RESET, PROCESSOR_RESET, Flight
from tests.requirements.ground import Ground
from tests.requirements.resets import POWERON, PROCESSOR, booted, housekeeping, reset

CORE_TASKS = {
    "CFE_EVS",
    "CFE_SB",
    "CFE_ES",
    "ES_BG_TASK",
    "CFE_TIME",
    "TIME_TONE_TASK",
    "TIME_ONEHZ_TASK",
    "CFE_TBL",
}
CORE_NOOPS = {"CFE_ES": pk.NOOP, "CFE_EVS": evs.NOOP, "CFE_SB": sb.NOOP, "CFE_TIME": time.NOOP, "CFE_TBL": tbl.NOOP}


@pytest.fixture
def ground(tmp_path: Path) -> Iterator[Ground]:
    with booted(tmp_path) as mission:
        yield Ground(mission)


# -- kept and lost data ------------------------------------------------------------------------------------------------


@covers("cES1511", "cES1522")
def test_cES1511_the_system_log_survives_a_processor_reset(ground: Ground) -> None:
    ground.mission.cfe.es.write_to_sys_log("before the reset")
    reset(ground, PROCESSOR)
    values, log = housekeeping(ground), ground.mission.cfe.es.syslog.read()
    assert values["SysLogMode"] == 1
    assert b"before the reset\n" in log
    assert log.index(b"before the reset") < log.index(b"CFE_ES_ResetCFE: PROCESSOR RESET called") < len(log)
    assert log.count(b"CFE_ES_Main in EARLY_INIT state") == 2


@covers("cES1501", "cES1523")
def test_cES1501_the_system_log_does_not_survive_a_power_on_reset(ground: Ground) -> None:
    ground.command(pk.OVER_WRITE_SYS_LOG, Mode=1)
    ground.mission.cfe.es.write_to_sys_log("before the reset")
    reset(ground, POWERON)
    assert housekeeping(ground)["SysLogMode"] == 0
    assert ground.mission.cfe.es.syslog.read().count(b"CFE_ES_Main in EARLY_INIT state") == 1
    assert b"before the reset" not in ground.mission.cfe.es.syslog.read()


@covers("cES1522", "cES1523")
def test_cES1522_mode_of_the_system_log_is_set_by_the_platform(fly: Callable[..., Flight]) -> None:
    flight = fly(pk.HK_TLM_MID, es_default_por_syslog_mode=1, es_default_pr_syslog_mode=0)

    def mode() -> int:
        value: int = flight.ask(pk.SEND_HK, pk.HK_TLM)["SysLogMode"]
        return value

    assert mode() == 1
    flight.reset(PROCESSOR_RESET)
    assert mode() == 0
    flight.reset(POWERON_RESET)
    assert mode() == 1


@covers("cES1503", "cES1507")
def test_cES1503_the_ram_disk_is_new_after_a_power_on_reset(ground: Ground) -> None:
    ground.mission.files.write_file("/ram/file", b"data")
    reset(ground, POWERON)
    assert not ground.mission.files.exists("/ram/file")
    ground.mission.files.write_file("/ram/file", b"data")
    assert ground.mission.cfe.os.file_sys_stat_volume("/ram").total_blocks == 4096


@covers("cES1513", "cES1517")
def test_cES1513_the_ram_disk_survives_a_processor_reset(ground: Ground) -> None:
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


def objects(ground: Ground) -> list[tuple[int, str]]:
    """Kind and name of all that the operating system has."""
    os, found = ground.mission.cfe.os, list[tuple[int, str]]()
    os.for_each_object(0, lambda each, _: found.append((os.identify_object(each), os.get_resource_name(each))))
    return found


@pytest.mark.parametrize("kind", [PROCESSOR, POWERON])
@covers("cES1505", "cES1515")
def test_cES1505_the_executive_has_its_objects_after_any_reset(ground: Ground, kind: int) -> None:
    before = objects(ground)
    assert {name for what, name in before if what == OS_TASK_BASE} == {*CORE_TASKS, "LOOPER"}
    reset(ground, kind)
    assert objects(ground) == before
    for pipe in ("EVS_CMD_PIPE", "SB_CMD_PIPE", "ES_CMD_PIPE", "TIME_CMD_PIPE", "TBL_CMD_PIPE"):
        assert ground.mission.cfe.sb.get_pipe_id_by_name(pipe)
    for service, noop in CORE_NOOPS.items():
        assert any(event.startswith(f"{service} ") for event in ground.command(noop))


@pytest.mark.parametrize("kind", [PROCESSOR, POWERON])
@covers("cES1506", "cES1516")
def test_cES1506_the_non_volatile_disk_is_mounted_after_any_reset(ground: Ground, kind: int) -> None:
    reset(ground, kind)
    os = ground.mission.cfe.os
    assert os.file_sys_stat_volume("/cf").total_blocks > 0
    filedes = os.open_create("/cf/looper.py", 0, OS_READ_ONLY)
    assert os.read(filedes, 16) == b"\ndef looper_main"


def test_cES1515_1_an_executive_that_loses_its_objects_in_a_reset_panics(
    ground: Ground, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise CfeError(CFE_ES_BAD_ARGUMENT, "no memory")

    monkeypatch.setattr(SoftwareBus, "early_init", fail)
    with pytest.raises(CfeError):
        reset(ground, PROCESSOR)
    assert ground.lines("CFE_ES_CreateObjects")[-1] == (
        "CFE_ES_CreateObjects: Error returned from EarlyInit for CFE_SB: EC = 0xC400000A"
    )
    assert "CFE_PSP_Panic called with error code = 0x00000006. Exiting." in ground.mission.console.lines


@pytest.mark.parametrize("what", ["function", "application"])
def test_an_executive_without_its_objects_panics(tmp_path: Path, what: str) -> None:
    def fail(*_: object, **__: object) -> Any:
        raise CfeError(CFE_ES_BAD_ARGUMENT, "no memory")

    class Broken(Attachment):
        def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
            return type("BrokenBus", (base,), {"early_init": fail})

    broken = [Broken()] if what == "function" else []
    mission = Mission(write_mission(tmp_path, "!"), console=Console(quiet=True), attachments=broken)
    if what == "function":
        said = "Error returned from EarlyInit for CFE_SB: EC = 0xC400000A"
    else:
        mission.processor.osal.task_create = fail  # type: ignore[method-assign]
        said = "OS_TaskCreate error creating core App: CFE_ES: EC = 0xC8000005"
    with pytest.raises(CfeError):
        mission.run_for(2)
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
    es = ground.mission.cfe.es
    app = es.get_app_info(es.get_app_id_by_name("LOOPER"))
    assert (app.file_name, app.entry_point) == ("/cf/looper.so", "looper_main")
    assert (app.priority, app.stack_size, app.exception_action) == (50, 16384, 0)
    assert es.get_lib_info(es.get_lib_id_by_name("TOOLS")).file_name == "/cf/tools.so"


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
    assert (len(ground.lines("TOOLS ready")), len(ground.lines("LOOPER starts"))) == (2, 2)


@covers("cES1519", "cES1519.1", "cES1519.2")
def test_cES1519_default_startup_script_is_used_without_one_on_the_ram_disk(ground: Ground) -> None:
    reset(ground, PROCESSOR)
    assert ground.lines("CFE_ES_StartApplications")[-2:] == [
        "CFE_ES_StartApplications: Cannot Open Volatile Startup file: /ram/cfe_es_startup.scr, Trying Nonvolatile.",
        "CFE_ES_StartApplications: Opened ES App Startup file: /cf/cfe_es_startup.scr",
    ]
    es = ground.mission.cfe.es
    assert [app.name for app in es.apps if not app.is_core] == ["LOOPER"]
    assert [lib.name for lib in es.libs] == ["TOOLS"]
    assert (len(ground.lines("TOOLS ready")), len(ground.lines("LOOPER starts"))) == (2, 2)
