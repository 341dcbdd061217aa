"""The end of an application: what it held is given back; it may be started again (cfe_es_apps.c)."""

from __future__ import annotations

from cfepy.es import events as ev
from cfepy.es.apps import AppServices
from cfepy.es.records import (
    APP_ERROR,
    APP_EXIT,
    SYS_DELETE,
    SYS_EXCEPTION,
    SYS_RELOAD,
    SYS_RESTART,
    AppRecord,
)
from cfepy.status import CfeError, OsalError

# What was asked for, to the words of its event, the id when it is done and when starting again failed.
_REPORTS = {
    APP_EXIT: ("Exit", ev.EXIT_APP_INF_EID, ev.EXIT_APP_ERR_EID),
    APP_ERROR: ("Exit", ev.ERREXIT_APP_INF_EID, ev.ERREXIT_APP_ERR_EID),
    SYS_DELETE: ("Stop", ev.STOP_INF_EID, ev.STOP_ERR3_EID),
    SYS_RESTART: ("Restart", ev.RESTART_APP_INF_EID, ev.RESTART_APP_ERR3_EID),
    SYS_RELOAD: ("Reload", ev.RELOAD_APP_INF_EID, ev.RELOAD_APP_ERR3_EID),
}


class AppEnd(AppServices):
    """Cleaning up."""

    def process_control_request(self, app: AppRecord) -> None:
        """Clean up an application, start it again if that was asked for, and say so (CFE_ES_ProcessControlRequest)."""
        request = app.control_request
        history = self.history_of(app.name)
        history.error_exits += request == APP_ERROR
        self.cleanup_app(app)
        if request not in _REPORTS:
            self._report_odd_request(app.name, request)
            return
        action, event, failed = _REPORTS[request]
        detail, kind = "Completed.", ev.INFORMATION
        if request in (SYS_RESTART, SYS_RELOAD):
            try:
                detail = f"Completed, AppID={self.create_app(app.name, app.params)}"
                history.restarts += 1
            except CfeError as failure:
                event, kind, detail = failed, ev.ERROR, f"Failed: AppCreate Error {failure.hex}."
        self.ports.evs.send_event(event, kind, f"{action} Application {app.name} {detail}")

    def _report_odd_request(self, name: str, request: int) -> None:
        if request == SYS_EXCEPTION:
            event, text = ev.PCR_ERR1_EID, f"ES_ProcControlReq: Invalid State Application {name} EXCEPTION"
        else:
            event, text = ev.PCR_ERR2_EID, f"ES_ProcControlReq: Unknown State Application {name} ( {request} )"
        self.ports.evs.send_event(event, ev.ERROR, text)

    def cleanup_app(self, app: AppRecord) -> None:
        """End an application's tasks and give back everything it holds (CFE_ES_CleanUpApp).

        The tasks go first, so that their `finally` blocks still find what they clean up.
        """
        history = self.history_of(app.name)
        for task_id in [*(each for each in app.tasks if each != app.main_task_id), app.main_task_id]:
            self.end_task(app, task_id)
        for task in [task for task in self.kernel.tasks if task.owner is app]:
            history.cpu_ns += task.cpu_ns
            self.kernel.kill(task)
        for service in (self.ports.tbl, self.ports.sb, self.ports.time, self.ports.evs):
            service.cleanup_app(app.app_id)
        self.osal.delete_objects_of(app)
        self._release_pools(app)
        self.apps.delete(app.app_id)

    def end_task(self, app: AppRecord, task_id: int) -> None:
        """End one task of an application."""
        record = app.tasks.pop(task_id, None)
        if record is None:
            return
        if record.task is not None:
            self.history_of(app.name).cpu_ns += record.task.cpu_ns
            record.task.cpu_ns = 0
        try:
            self.osal.task_delete(task_id)
        except OsalError:
            pass  # the task ended by itself: nothing is left to delete

    def _release_pools(self, app: AppRecord) -> None:
        for pool_id, (owner, claim) in list(self.pool_owners.items()):
            if owner is app:
                self.pools.delete(pool_id)
                self.ports.memory.release(claim)
                del self.pool_owners[pool_id]
