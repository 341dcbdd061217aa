"""NASA's requirements for Executive Services: housekeeping, applications by command and in files (cES10xx)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.es import packets as pk
from cfepy.fs import read_header
from cfepy.mission import Mission
from cfepy.msg import Command
from cfepy.psp.profile import load_profile
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.requirements.covers import covers
from tests.requirements.ground import Ground

STARTUP = """
    CFE_LIB, tools, tools_init, TOOLS, 0, 0, 0x0, 0;
    CFE_APP, looper, looper_main, LOOPER, 50, 16384, 0x0, 0;
    !
"""
TOOLS = """
    def tools_init(cfe):
        return 0
"""
LOOPER = """
    def child(cfe):
        while True:
            cfe.os.task_delay(1000)

    def looper_main(cfe):
        cfe.evs.register()
        cfe.es.create_child_task("LOOPER_CHILD", lambda: child(cfe), 4096, 60)
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
"""


@pytest.fixture
def ground(tmp_path: Path) -> Iterator[Ground]:
    sources = {"tools": TOOLS, "looper": LOOPER, "other": LOOPER.replace("_CHILD", "_BABY")}
    folder = write_mission(tmp_path, STARTUP, mission_yaml='cfe_version: "7.0.0"', **sources)
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(2)
        ground = Ground(mission)
        ground.show_debug_events("CFE_ES")
        yield ground


def counters(ground: Ground) -> tuple[int, int]:
    values = ground.answer(pk.SEND_HK, pk.HK_TLM)
    return values["CommandCounter"], values["CommandErrorCounter"]


def state_of(ground: Ground, app: str) -> int | None:
    record = ground.mission.cfe.es.app_named(app)
    return None if record is None else record.app_id


# -- housekeeping -----------------------------------------------------------------------------------------------------


def test_cES1000_housekeeping_reports_the_state_of_the_executive(ground: Ground) -> None:
    ground.command(pk.START_PERF_DATA, TriggerMode=2)
    ground.command(pk.SET_PERF_TRIGGER_MASK, TriggerMaskNum=1, TriggerMask=0x10)
    ground.command(pk.SET_MAX_PR_COUNT, MaxPRCount=5)
    ground.command(pk.RESTART, RestartType=9)
    ground.mission.cfe.es.perf_log_entry(3)
    values = ground.answer(pk.SEND_HK, pk.HK_TLM)
    es = ground.mission.cfe.es
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (3, 1)
    assert (values["RegisteredCoreApps"], values["RegisteredExternalApps"], values["RegisteredLibs"]) == (5, 1, 1)
    assert values["RegisteredTasks"] == len(es.tasks()) == 10  # of core apps 5 and their children 3, of LOOPER 2
    assert (values["ResetType"], values["ResetSubtype"], values["BootSource"]) == (2, 1, 1)
    assert (values["ProcessorResets"], values["MaxProcessorResets"]) == (0, 5)
    assert (values["SysLogSize"], values["SysLogMode"]) == (3072, 0)
    assert values["SysLogBytesUsed"] == len(es.syslog.read())
    assert values["SysLogEntries"] == es.syslog.read().count(b"\n")
    assert (values["ERLogIndex"], values["ERLogEntries"]) == (1, 1)
    assert (values["PerfState"], values["PerfMode"], values["PerfTriggerCount"]) == (1, 2, 0)
    assert (values["PerfDataStart"], values["PerfDataToWrite"]) == (0, 0)
    assert values["PerfDataCount"] == values["PerfDataEnd"] > 0
    assert values["PerfTriggerMask"] == [0, 0x10, 0, 0]
    assert values["PerfFilterMask"] == [0xFFFFFFFF] * 4
    assert values["CFECoreChecksum"] == ground.mission.processor.es_task.checksum
    assert [values[f"{part}MajorVersion"] for part in ("CFE", "OSAL", "PSP")] == [7, 7, 7]


def test_cES1000_heap_is_the_free_memory_of_a_board_with_limits(tmp_path: Path) -> None:
    board = load_profile("rx64m")
    with Mission(write_mission(tmp_path, "!"), board=board, console=Console(quiet=True)) as mission:
        mission.run_for(2)
        values = Ground(mission).answer(pk.SEND_HK, pk.HK_TLM)
        assert 0 < values["HeapBytesFree"] == values["HeapMaxBlockSize"] < board.sram_size
        assert values["HeapBlocksFree"] == 1


def test_cES1001_noop_sends_an_event(ground: Ground) -> None:
    build, noop = ground.command(pk.NOOP)
    assert build.startswith("CFE_ES 92: Build ")
    assert noop == "CFE_ES 3: No-op command:"


# -- starting applications ---------------------------------------------------------------------------------------------


@covers("cES1005", "cES1005.1")
def test_cES1005_an_application_starts_by_command(ground: Ground) -> None:
    (event,) = ground.command(
        pk.START_APP,
        Application="SECOND",
        AppEntryPoint="looper_main",
        AppFileName="/cf/other.so",
        StackSize=12000,
        ExceptionAction=1,
        Priority=77,
    )
    app_id = state_of(ground, "SECOND")
    assert event == f"CFE_ES 6: Started SECOND from /cf/other.so, AppID = {app_id}"
    values = ground.answer(pk.QUERY_ONE, pk.APP_TLM, Application="SECOND")
    assert (values["ResourceId"], values["Name"], values["FileName"]) == (app_id, "SECOND", "/cf/other.so")
    assert (values["EntryPoint"], values["ExceptionAction"]) == ("looper_main", 1)
    assert (values["StackSize"], values["Priority"]) == (12000, 77)
    task = ground.mission.cfe.os.task_get_info(values["MainTaskId"])
    assert (task.stack_size, task.priority) == (12000, 77)
    assert values["ExecutionCounter"] > 0


@pytest.mark.parametrize("file", ["/ram/uploaded.so", "/cf/uploaded.so"])
def test_cES1005_2_the_file_may_be_on_any_file_system(ground: Ground, file: str) -> None:
    source = b"def up_main(cfe):\n    while cfe.es.run_loop():\n        cfe.os.task_delay(100)\n"
    ground.mission.files.write_file(file, source)
    ground.command(pk.START_APP, Application="UP", AppEntryPoint="up_main", AppFileName=file)
    values = ground.answer(pk.QUERY_ONE, pk.APP_TLM, Application="UP")
    assert values["FileName"] == file
    assert values["ExecutionCounter"] > 0


def test_cES1005_3_an_undefined_application_is_refused(ground: Ground) -> None:
    before = counters(ground)
    events = ground.command(pk.START_APP, Application="X", AppEntryPoint="x_main", AppFileName="nowhere")
    assert events == ["CFE_ES 26: Failed to start X from /cf/nowhere.so, RC = 0xC8000005"]
    for fields, event in (
        ({"AppEntryPoint": "", "Application": "X", "AppFileName": "other"}, 28),
        ({"AppEntryPoint": "f", "Application": "", "AppFileName": "other"}, 29),
        ({"AppEntryPoint": "f", "Application": "X", "AppFileName": ""}, 27),
        ({"AppEntryPoint": "f", "Application": "X", "AppFileName": "other", "Priority": 256}, 31),
        ({"AppEntryPoint": "f", "Application": "X", "AppFileName": "other", "ExceptionAction": 2}, 32),
    ):
        (text,) = ground.command(pk.START_APP, **fields)
        assert text.startswith(f"CFE_ES {event}: CFE_ES_StartAppCmd: ")
    assert counters(ground) == (before[0], before[1] + 6)


def test_cES1005_4_an_application_that_runs_is_not_started_again(ground: Ground) -> None:
    before = counters(ground)
    fields = {"AppEntryPoint": "looper_main", "AppFileName": "looper"}
    events = ground.command(pk.START_APP, Application="LOOPER", **fields)
    assert events == ["CFE_ES 26: Failed to start LOOPER from /cf/looper.so, RC = 0xC400002E"]
    assert counters(ground) == (before[0], before[1] + 1)


# -- ending and restarting applications --------------------------------------------------------------------------------


def test_cES1006_an_application_is_deleted_with_its_child_tasks(ground: Ground) -> None:
    def alive() -> list[str]:
        return sorted(task.name for task in ground.mission.kernel.tasks if task.name.startswith("LOOPER"))

    assert alive() == ["LOOPER", "LOOPER_CHILD"]
    tasks = len(ground.mission.cfe.es.tasks())
    assert ground.command(pk.STOP_APP, 8, Application="LOOPER") == [
        "CFE_ES 7: Stop Application LOOPER Initiated.",
        "CFE_ES 8: Stop Application LOOPER Completed.",
    ]
    assert state_of(ground, "LOOPER") is None
    assert len(ground.mission.cfe.es.tasks()) == tasks - 2
    assert alive() == []


@pytest.mark.parametrize(
    ("command", "event"), [(pk.STOP_APP, "36: Stop"), (pk.RESTART_APP, "39: Restart"), (pk.RELOAD_APP, "43: Reload")]
)
@covers("cES1006.1", "cES1007.1", "cES1008.1")
def test_cES1006_1_an_undefined_application_cannot_be_controlled(ground: Ground, command: Command, event: str) -> None:
    before = counters(ground)
    assert ground.command(command, Application="NOBODY") == [
        f"CFE_ES {event} Application NOBODY, GetAppIDByName failed. RC = 0xC4000002."
    ]
    assert counters(ground) == (before[0], before[1] + 1)


def test_cES1007_an_application_is_restarted(ground: Ground) -> None:
    first = state_of(ground, "LOOPER")
    events = ground.command(pk.RESTART_APP, 8, Application="LOOPER")
    second = state_of(ground, "LOOPER")
    assert events == [
        "CFE_ES 9: Restart Application LOOPER Initiated.",
        f"CFE_ES 10: Restart Application LOOPER Completed, AppID={second}",
    ]
    assert second != first
    values = ground.answer(pk.QUERY_ONE, pk.APP_TLM, Application="LOOPER")
    assert (values["ResourceId"], values["FileName"], values["NumOfChildTasks"]) == (second, "/cf/looper.so", 1)
    assert values["ExecutionCounter"] > 0
    assert len(ground.mission.cfe.es.tasks()) == 10


@covers("cES1007.2", "cES1008.2")
def test_cES1007_2_restart_and_reload_need_the_file(ground: Ground) -> None:
    before = counters(ground)
    ground.mission.files.remove("/cf/looper.py")
    (Path(ground.mission.spec.folder) / "looper.py").unlink()
    assert ground.command(pk.RESTART_APP, 8, Application="LOOPER") == [
        "CFE_ES 38: Restart Application LOOPER Failed, RC = 0xC4000014"
    ]
    assert ground.command(pk.RELOAD_APP, 8, Application="LOOPER", AppFileName="/cf/nowhere.so") == [
        "CFE_ES 42: Reload Application LOOPER Failed, RC = 0xC4000014"
    ]
    assert counters(ground) == (before[0], before[1] + 2)
    assert state_of(ground, "LOOPER") is not None


@pytest.mark.parametrize(("action", "event"), [("Restart", 40), ("Reload", 44)])
@covers("cES1007.3", "cES1008.3")
def test_cES1007_3_an_application_that_does_not_start_again_is_deleted(ground: Ground, action: str, event: int) -> None:
    """The file is there, but the entry point is not in it any more."""
    folder = Path(ground.mission.spec.folder)
    (folder / "empty.py").write_text("nothing = 0\n", encoding="utf-8")
    errors = counters(ground)[1]
    if action == "Reload":
        events = ground.command(pk.RELOAD_APP, 8, Application="LOOPER", AppFileName="/cf/empty.so")
    else:
        (folder / "looper.py").write_text("nothing = 0\n", encoding="utf-8")
        ground.mission.files.volume("/cf").clear()
        events = ground.command(pk.RESTART_APP, 8, Application="LOOPER")
    assert events[-1] == f"CFE_ES {event}: {action} Application LOOPER Failed: AppCreate Error 0xC8000005."
    assert state_of(ground, "LOOPER") is None
    assert counters(ground)[1] == errors


def test_cES1008_an_application_is_reloaded_from_another_file(ground: Ground) -> None:
    events = ground.command(pk.RELOAD_APP, 8, Application="LOOPER", AppFileName="other")
    assert events == [
        "CFE_ES 11: Reload Application LOOPER Initiated.",
        f"CFE_ES 12: Reload Application LOOPER Completed, AppID={state_of(ground, 'LOOPER')}",
    ]
    values = ground.answer(pk.QUERY_ONE, pk.APP_TLM, Application="LOOPER")
    assert values["FileName"] == "/cf/other.so"
    assert values["ExecutionCounter"] > 0
    assert ground.mission.cfe.es.get_task_id_by_name("LOOPER_BABY")  # which only the other file makes


# -- telling about applications and tasks ------------------------------------------------------------------------------


def test_cES1011_an_application_is_described_in_a_packet(ground: Ground) -> None:
    values = ground.answer(pk.QUERY_ONE, pk.APP_TLM, Application="LOOPER")
    assert (values["Name"], values["FileName"], values["EntryPoint"]) == ("LOOPER", "/cf/looper.so", "looper_main")
    assert (values["Priority"], values["StackSize"], values["ExceptionAction"]) == (50, 16384, 0)
    assert (values["ResourceId"], values["Type"]) == (state_of(ground, "LOOPER"), 2)
    assert (values["MainTaskName"], values["NumOfChildTasks"]) == ("LOOPER", 1)
    assert values["ExecutionCounter"] > 5
    assert values["MainTaskId"] == ground.mission.cfe.es.get_task_id_by_name("LOOPER")
    memory = ("AddressesAreValid", "StartAddress", "CodeAddress", "CodeSize", "DataAddress", "DataSize")
    assert [values[name] for name in memory] == [0] * 6  # as on Linux: not known
    assert ground.command(pk.QUERY_ONE, Application="NOBODY") == [
        "CFE_ES 50: Failed to send NOBODY application data: GetAppIDByName Failed, RC = 0xC4000002"
    ]


def test_cES1012_all_applications_are_described_in_a_file(ground: Ground) -> None:
    (event,) = ground.command(pk.QUERY_ALL, FileName="/ram/apps.log")
    assert event == "CFE_ES 16: App Info file written to /ram/apps.log, Entries=7, FileSize=1632"
    data = ground.file("/ram/apps.log")
    header = read_header(data)
    assert (header.description, header.subtype) == ("ES Application Info file", 3)
    records = [pk.APP_INFO.unpack(data, at) for at in range(64, len(data), pk.APP_INFO.size)]
    names = ["CFE_EVS", "CFE_SB", "CFE_ES", "CFE_TIME", "CFE_TBL", "LOOPER", "TOOLS"]
    assert [record["Name"] for record in records] == names
    assert [record["Type"] for record in records] == [1, 1, 1, 1, 1, 2, 3]
    looper = records[5]
    assert (looper["ResourceId"], looper["MainTaskName"]) == (state_of(ground, "LOOPER"), "LOOPER")
    assert (looper["FileName"], looper["EntryPoint"]) == ("/cf/looper.so", "looper_main")
    assert (looper["Priority"], looper["StackSize"], looper["ExceptionAction"]) == (50, 16384, 0)
    assert (looper["NumOfChildTasks"], looper["ExecutionCounter"] > 5) == (1, True)
    for record in records:
        alone = ground.answer(pk.QUERY_ONE, pk.APP_TLM, Application=record["Name"])
        assert record.pop("ExecutionCounter") <= alone.pop("ExecutionCounter")
        assert record == alone


@pytest.mark.parametrize("command", [pk.QUERY_ALL, pk.QUERY_ALL_TASKS])
@covers("cES1012", "cES1032")
def test_cES1012_a_file_that_cannot_be_written_is_reported(ground: Ground, command: Command) -> None:
    before = counters(ground)
    what = "App" if command is pk.QUERY_ALL else "Task"
    (event,) = ground.command(command, FileName="/nowhere/x.log")
    assert event.endswith(f"Failed to write {what} Info file, OS_OpenCreate RC = -108")
    (event,) = ground.command(command, FileName="/ram/")
    assert event.endswith(f"Failed to write {what} Info file, CFE_FS_ParseInputFileNameEx RC = c6000002")
    ground.mission.files.write_file("/ram/big", bytes(2096900))
    (event,) = ground.command(command, FileName="/ram/x.log")
    fits = {"App": 188, "Task": 44}[what]
    assert f"Failed to write {what} Info file, Task write RC = {fits}, exp " in event
    assert counters(ground) == (before[0], before[1] + 3)


@pytest.mark.parametrize(
    ("command", "path"),
    [(pk.QUERY_ALL, "/ram/cfe_es_app_info.log"), (pk.QUERY_ALL_TASKS, "/ram/cfe_es_taskinfo.log")],
)
@covers("cES1012.1", "cES1032.1")
def test_cES1012_1_files_have_default_names(ground: Ground, command: Command, path: str) -> None:
    (event,) = ground.command(command)
    assert path in event
    assert len(ground.file(path)) > 64


def test_cES1032_all_tasks_are_described_in_a_file(ground: Ground) -> None:
    (event,) = ground.command(pk.QUERY_ALL_TASKS, FileName="tasks.log")
    assert event == "CFE_ES 87: Task Info file written to /ram/tasks.log, Entries=10, FileSize=784"
    data = ground.file("/ram/tasks.log")
    assert (read_header(data).description, read_header(data).subtype) == ("ES Task Info file", 23)
    records = [pk.TASK_INFO.unpack(data, at) for at in range(64, len(data), pk.TASK_INFO.size)]
    named = {record["TaskName"]: record for record in records}
    assert list(named)[:5] == ["CFE_EVS", "CFE_SB", "CFE_ES", "ES_BG_TASK", "CFE_TIME"]
    es = ground.mission.cfe.es
    assert [record["TaskId"] for record in records] == [es.get_task_id_by_name(name) for name in named]
    child = named["LOOPER_CHILD"]
    assert (child["AppName"], child["StackSize"], child["Priority"]) == ("LOOPER", 4096, 60)
    assert (child["AppId"], child["ExecutionCounter"]) == (state_of(ground, "LOOPER"), 0)
    assert named["LOOPER"]["ExecutionCounter"] > 5
