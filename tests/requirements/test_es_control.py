"""NASA's requirements for control of applications and tasks by applications (cES1309 to 1314, 1319, 1332)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.es.records import APP_EXIT
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_CHILD_TASK_CREATE,
    CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_FILE_IO_ERR,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
)
from tests.es.harness import Lab
from tests.requirements.asking import Make, ask, idle
from tests.requirements.covers import covers
from tests.statuses import status_of

END_S = 8
"""Longer than an application has for its end."""


class Family:
    """Code of an application with a child task. Records the times at which they run."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.starts = 0
        self.beats = 0

    def main(self, cfe: Cfe) -> None:
        self.starts += 1
        cfe.es.create_child_task(f"{self.name}_CHILD", lambda: self._child(cfe), 4096, 60)
        idle(cfe)

    def _child(self, cfe: Cfe) -> None:
        while True:
            self.beats += 1
            cfe.os.task_delay(100)

    def is_running(self, lab: Lab) -> bool:
        """Return whether the child task does anything."""
        before = self.beats
        lab.mission.run_for(1)
        return self.beats > before


# -- control -----------------------------------------------------------------------------------------------------------


def test_cES1309_an_application_deletes_another_with_its_child_tasks(make_lab: Make) -> None:
    family = Family("IDLE")
    _, lab = ask(make_lab, lambda cfe: cfe.es.delete_app(cfe.es.get_app_id_by_name("IDLE")), END_S, idle=family.main)
    assert "CFE_ES 8: Stop Application IDLE Completed." in lab.log()
    assert lab.es.app_named("IDLE") is None
    for name in ("IDLE", "IDLE_CHILD"):
        assert status_of(lab.es.get_task_id_by_name, name) == CFE_ES_ERR_NAME_NOT_FOUND
    assert family.starts == 1
    assert family.beats > 0
    assert not family.is_running(lab)


def test_cES1310_an_application_restarts_another(make_lab: Make) -> None:
    family = Family("IDLE")

    def question(cfe: Cfe) -> int:
        target = cfe.es.get_app_id_by_name("IDLE")
        cfe.es.restart_app(target)
        return target

    first, lab = ask(make_lab, question, END_S, idle=family.main)
    second = lab.es.get_app_id_by_name("IDLE")
    assert f"CFE_ES 10: Restart Application IDLE Completed, AppID={second}" in lab.log()
    assert second != first
    assert family.starts == 2
    assert family.is_running(lab)


def test_cES1332_an_application_reloads_another_from_a_file(make_lab: Make) -> None:
    old, new = Family("OLD"), Family("NEW")

    def question(cfe: Cfe) -> None:
        cfe.es.reload_app(cfe.es.get_app_id_by_name("IDLE"), "/cf/new.so")

    _, lab = ask(make_lab, question, END_S, idle=old.main, new=new.main)
    app_id = lab.es.get_app_id_by_name("IDLE")
    assert f"CFE_ES 12: Reload Application IDLE Completed, AppID={app_id}" in lab.log()
    assert lab.es.get_app_info(app_id).file_name == "/cf/new.so"
    assert (old.starts, new.starts) == (1, 1)
    assert not old.is_running(lab)
    assert new.is_running(lab)


@covers("cES1309.1", "cES1310.1")
def test_cES1309_1_an_unknown_application_cannot_be_controlled(make_lab: Make) -> None:
    def question(cfe: Cfe) -> list[int]:
        es = cfe.es
        core = es.get_app_id_by_name("CFE_TBL")
        return [
            status_of(es.delete_app, 0),
            status_of(es.restart_app, 0),
            status_of(es.reload_app, 0, "/cf/idle.so"),
            status_of(es.delete_app, core),
        ]

    found, lab = ask(make_lab, question)
    assert found == [CFE_ES_ERR_RESOURCEID_NOT_VALID] * 4
    for text in (
        "Invalid Application ID received for Delete, AppID = 0",
        "Invalid Application ID received for Restart, AppID = 0",
        "Invalid Application ID received for Reload, AppID = 0",
        "Cannot Delete a CORE Application: CFE_TBL.",
    ):
        assert f"CFE_ES_LockUserAppRecord: {text}" in lab.log()


def test_cES1310_2_restart_and_reload_need_the_file(make_lab: Make) -> None:
    def question(cfe: Cfe) -> list[int]:
        es = cfe.es
        es.loader.mains.pop("/cf/idle.so")  # type: ignore[attr-defined]  # the file is gone
        return [
            status_of(es.restart_app, es.get_app_id_by_name("IDLE")),
            status_of(es.reload_app, es.get_app_id(), "/cf/nowhere.so"),
        ]

    found, lab = ask(make_lab, question, END_S)
    assert found == [CFE_ES_FILE_IO_ERR] * 2
    assert "CFE_ES_RestartApp: Cannot Restart Application IDLE, File /cf/idle.so does not exist." in lab.log()
    assert "CFE_ES_ReloadApp: Cannot Reload Application ONE, File /cf/nowhere.so does not exist." in lab.log()
    assert [app.name for app in lab.es.apps if not app.is_core] == ["IDLE", "ONE"]


def test_cES1310_3_an_application_whose_restart_fails_is_deleted(make_lab: Make) -> None:
    """The file disappears between the request, which succeeds, and the new start. The event then has the status."""

    def question(cfe: Cfe) -> int:
        es, target = cfe.es, cfe.es.get_app_id_by_name("IDLE")
        es.restart_app(target)
        es.loader.mains.pop("/cf/idle.so")  # type: ignore[attr-defined]
        cfe.os.task_delay(200)  # it leaves its loop
        return status_of(es.restart_app, target)

    found, lab = ask(make_lab, question, END_S)
    assert found == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert "CFE_ES_LockUserAppRecord: Cannot Restart Application IDLE, It is not running." in lab.log()
    assert "CFE_ES_LoadModule: Could not load file:/cf/idle.so. EC = -1" in lab.log()
    assert "CFE_ES 40: Restart Application IDLE Failed: AppCreate Error 0xC8000005." in lab.log()
    assert lab.es.app_named("IDLE") is None


def test_cES1319_an_application_ends_itself(make_lab: Make) -> None:
    def ends(cfe: Cfe) -> None:
        cfe.es.run_loop()
        cfe.sb.create_pipe(4, "ENDS_PIPE")
        cfe.os.queue_create("ENDS_QUEUE", 3, 8)
        cfe.es.create_child_task("ENDS_CHILD", lambda: cfe.os.task_delay(10**6), 4096, 60)
        cfe.os.task_delay(300)
        cfe.es.exit_app(APP_EXIT)

    lab = make_lab(ends=ends)
    tasks, booked = len(lab.es.tasks()), lab.mission.memory.used
    lab.start("ends")
    lab.mission.run_for(3)
    assert lab.es.app_named("ENDS") is None
    assert (len(lab.es.tasks()), lab.mission.memory.used) == (tasks, booked)
    assert status_of(lab.cfe.sb.get_pipe_id_by_name, "ENDS_PIPE")
    assert "CFE_ES_ExitApp: Application ENDS called CFE_ES_ExitApp" in lab.log()
    assert "CFE_ES 13: Exit Application ENDS Completed." in lab.log()


def test_cES1319_an_odd_status_counts_as_an_error(make_lab: Make) -> None:
    lab = make_lab(odd=lambda cfe: cfe.es.exit_app(99))
    lab.start("odd")
    lab.mission.run_for(3)
    assert "CFE_ES_ExitApp: Called with invalid status (99)." in lab.log()
    assert "CFE_ES 14: Exit Application ODD Completed." in lab.log()


# -- child tasks -------------------------------------------------------------------------------------------------------


def test_cES1311_a_child_task_belongs_to_its_application(make_lab: Make) -> None:
    counts: list[int] = []

    def child(cfe: Cfe) -> None:
        while True:
            counts.append(cfe.es.get_app_id())
            cfe.os.task_delay(100)

    def question(cfe: Cfe) -> tuple[int, int, str]:
        task_id = cfe.es.create_child_task("CHILD", lambda: child(cfe), 4096, 60)
        cfe.os.task_delay(500)
        return cfe.es.get_app_id(), task_id, cfe.es.get_task_info(task_id).app_name

    (app_id, task_id, owner), lab = ask(make_lab, question)
    assert {*counts} == {app_id}
    assert owner == "ONE"
    assert lab.es.get_task_id_by_name("CHILD") == task_id


@covers("cES1311.1", "cES1311.2")
def test_cES1311_1_invalid_child_tasks_are_refused(make_lab: Make) -> None:
    nested: list[int] = []

    def child(cfe: Cfe) -> None:
        nested.append(status_of(cfe.es.create_child_task, "DEEP", print, 4096, 60))
        nested.append(status_of(cfe.es.delete_child_task, cfe.es.get_app_info(cfe.es.get_app_id()).main_task_id))

    def question(cfe: Cfe) -> list[int]:
        cfe.es.create_child_task("CHILD", lambda: child(cfe), 4096, 60)
        cfe.os.task_delay(10)
        return [
            status_of(cfe.es.create_child_task, "CHILD", print, 4096, 60),
            status_of(cfe.es.create_child_task, "NO_STACK", print, 0, 60),
            status_of(cfe.es.create_child_task, None, print, 4096, 60),
        ]

    found, lab = ask(make_lab, question)
    assert found == [CFE_STATUS_EXTERNAL_RESOURCE_FAIL, CFE_STATUS_EXTERNAL_RESOURCE_FAIL, CFE_ES_BAD_ARGUMENT]
    assert nested == [CFE_ES_ERR_CHILD_TASK_CREATE, CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK]
    host = status_of(lab.es.create_child_task, "LONELY", print, 4096, 60)
    assert host == CFE_ES_ERR_RESOURCEID_NOT_VALID
    for text in (
        "CFE_ES_StartAppTask: AppCreate Error: TaskCreate CHILD Failed. EC = -15!",
        "CFE_ES_CreateChildTask: Error: Cannot call from a Child Task (for Task 'DEEP').",
        "CFE_ES_CreateChildTask: Invalid calling context when creating Task 'LONELY'",
        "CFE_ES_CreateChildTask: TaskName Parameter is NULL",
    ):
        assert text in lab.log()


@covers("cES1312", "cES1312.1")
def test_cES1312_a_child_task_can_be_deleted_but_not_a_main_task(make_lab: Make) -> None:
    counts: list[int] = []

    def child(cfe: Cfe) -> None:
        while True:
            counts.append(1)
            cfe.os.task_delay(100)

    def question(cfe: Cfe) -> list[int]:
        es = cfe.es
        task_id = es.create_child_task("CHILD", lambda: child(cfe), 4096, 60)
        cfe.os.task_delay(500)
        es.delete_child_task(task_id)
        counted = len(counts)
        cfe.os.task_delay(300)
        assert len(counts) == counted == 5
        return [
            status_of(es.delete_child_task, es.get_task_id()),
            status_of(es.delete_child_task, task_id),
            status_of(es.delete_child_task, 0),
        ]

    found, lab = ask(make_lab, question, 2)
    assert found == [
        CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK,
        CFE_ES_ERR_RESOURCEID_NOT_VALID,
        CFE_ES_ERR_RESOURCEID_NOT_VALID,
    ]
    main = lab.es.get_task_id_by_name("ONE")
    assert f"CFE_ES_DeleteChildTask: Error: Task {main} is a cFE Main Task." in lab.log()
    assert "CFE_ES_DeleteChildTask: Error: Invalid Task ID: 0" in lab.log()


@covers("cES1314", "cES1314.1")
def test_cES1314_a_child_task_can_end_itself_but_not_a_main_task(make_lab: Make) -> None:
    reached: list[str] = []

    def child(cfe: Cfe) -> None:
        reached.append("begun")
        cfe.es.exit_child_task()
        reached.append("never")

    def question(cfe: Cfe) -> int:
        task_id = cfe.es.create_child_task("CHILD", lambda: child(cfe), 4096, 60)
        cfe.os.task_delay(200)
        cfe.es.exit_child_task()
        return status_of(cfe.es.get_task_name, task_id)

    found, lab = ask(make_lab, question)
    assert found == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert reached == ["begun"]
    main = lab.es.get_task_id_by_name("ONE")
    assert f"CFE_ES_ExitChildTask: Error: Cannot Call from a cFE App Main Task. ID = {main}" in lab.log()
