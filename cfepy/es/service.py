"""Executive Services: what an application asks of it (cfe_es_api.c); the parts are put together here."""

from __future__ import annotations

from cfepy.es.cds_api import CdsApi
from cfepy.es.child_tasks import ChildTaskApi
from cfepy.es.counters import CounterApi
from cfepy.es.faults import FaultApi
from cfepy.es.pool_api import PoolApi
from cfepy.es.records import (
    APP_RUN,
    EARLY_INIT,
    LATE_INIT,
    RUNNING,
    STOPPED,
    SYSTEM_APPS_INIT,
    SYSTEM_OPERATIONAL,
    SYSTEM_SHUTDOWN,
    AppRecord,
)
from cfepy.fs import CRC_16, calculate_crc
from cfepy.ports import SYSTEM_CORE_READY
from cfepy.status import CFE_ES_OPERATION_TIMED_OUT, CfeError, status_to_string


class ExecutiveServices(ChildTaskApi, FaultApi, CdsApi, CounterApi, PoolApi):
    """One processor's ES; the arguments are those of `EsCore`."""

    status_to_string = staticmethod(status_to_string)

    # -- the run loop ----------------------------------------------------------------------------------------------

    def run_loop(self, status: int = APP_RUN) -> bool:
        """Whether the calling application shall go on; also tells ES that it runs (CFE_ES_RunLoop).

        Args:
            status: APP_RUN to go on; anything else makes the answer False.
        """
        self.increment_task_counter()
        if status != APP_RUN:
            return False
        app = self.app_of_caller()
        if app is None:
            self.write_to_sys_log("CFE_ES_RunLoop: Error getting AppID for the caller")
            return False
        app.state = max(app.state, RUNNING)
        return app.control_request == APP_RUN

    def control_request(self) -> int:
        """What is asked of the calling application: APP_RUN, or why it shall end (C's *RunStatus after RunLoop)."""
        return self.calling_app().control_request

    def wait_for_system_state(self, state: int, timeout_ms: int) -> None:
        """Wait until the mission reached a system state, looking every 50 ms (CFE_ES_WaitForSystemState).

        Args:
            state: SYSTEM_*. The call also says how far the calling application is: who waits for others has done its
                own part.
            timeout_ms: the longest time.

        Raises:
            CfeError: CFE_ES_OPERATION_TIMED_OUT.
        """
        app = self.app_of_caller()
        if app is not None:
            app.state = max(app.state, _state_of_who_waits_for(state, app.is_core))
        remaining = timeout_ms
        while self.system_state < state:
            if remaining <= 0:
                raise CfeError(CFE_ES_OPERATION_TIMED_OUT, f"system state {state} not reached in {timeout_ms} ms")
            pause = min(remaining, self.config.es_startup_sync_poll_ms)
            self.osal.task_delay(pause)
            remaining -= pause

    def wait_for_startup_sync(self, timeout_ms: int) -> None:
        """Wait until the mission is operational; a timeout is not an error (CFE_ES_WaitForStartupSync)."""
        try:
            self.wait_for_system_state(SYSTEM_OPERATIONAL, timeout_ms)
        except CfeError as late:
            if late.status != CFE_ES_OPERATION_TIMED_OUT:
                raise

    def apps_below(self, state: int) -> list[AppRecord]:
        """External applications that have not reached a state yet and have not ended either."""
        return [app for app in self.apps if not app.is_core and app.state < state]

    def reached(self, state: int) -> bool:
        """Whether all external applications reached a state."""
        return not self.apps_below(state)

    # -- the performance log ---------------------------------------------------------------------------------------

    def perf_log_add(self, marker: int, entry_exit: int) -> None:
        """Record that a marked place in the code was reached, if data are collected (CFE_ES_PerfLogAdd).

        Args:
            marker: number of the place, 0 to 127.
            entry_exit: 0 where the code begins, 1 where it ends; of any other number the last bit counts.
        """
        self.perf_log.add(marker, entry_exit)

    def perf_log_entry(self, marker: int) -> None:
        """As `perf_log_add`, where the code begins (CFE_ES_PerfLogEntry)."""
        self.perf_log.add(marker, 0)

    def perf_log_exit(self, marker: int) -> None:
        """As `perf_log_add`, where the code ends (CFE_ES_PerfLogExit)."""
        self.perf_log.add(marker, 1)

    # -- the rest --------------------------------------------------------------------------------------------------

    def calculate_crc(self, data: bytes, crc: int = 0, kind: int = CRC_16) -> int:
        """Check value of some bytes (CFE_ES_CalculateCRC); see `cfepy.fs.calculate_crc`."""
        return calculate_crc(data, crc, kind)


def _state_of_who_waits_for(system_state: int, is_core: bool) -> int:
    if is_core:
        return RUNNING if system_state >= SYSTEM_CORE_READY else EARLY_INIT
    if system_state >= SYSTEM_SHUTDOWN:
        return STOPPED
    if system_state >= SYSTEM_OPERATIONAL:
        return RUNNING
    return LATE_INIT if system_state >= SYSTEM_APPS_INIT else EARLY_INIT
