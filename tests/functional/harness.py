"""A test as the main function of the application CFE_TEST, in a mission that has booted.

The mission has the environment of NASA's functional tests: a library ASSERT_LIB, and SAMPLE_APP with its table.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from cfepy.app import Cfe
from cfepy.es import SYSTEM_OPERATIONAL
from cfepy.es.records import Entry, Loader
from cfepy.mission import Mission
from cfepy.rtos import TaskExit
from cfepy.status import CFE_SUCCESS, CfeError, OsalError
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

CMD_MID, TLM_MID = 0x1802, 0x0802
"""MsgIds that no other application uses."""

APP, APP_FILE, APP_ENTRY = "CFE_TEST", "/cf/cfe_testcase.so", "CFE_TestMain"
LIBRARY, LIBRARY_FILE, LIBRARY_ENTRY = "ASSERT_LIB", "/cf/cfe_assert.so", "CFE_Assert_LibInit"
SHARED_TABLE = "SAMPLE_APP.ExampleTable"
SAMPLE_EVENT = 1
"""The one event that CFE_TEST has a filter for."""

CHILD_STACK, CHILD_PRIORITY = 4096, 200
LONGEST_S = 60
STARTUP = f"""\
CFE_LIB, {LIBRARY_FILE}, {LIBRARY_ENTRY}, {LIBRARY}, 0, 0, 0x0, 0;
CFE_APP, /cf/sample_app.so, SAMPLE_APP_Main, SAMPLE_APP, 61, 16384, 0x0, 0;
CFE_APP, {APP_FILE}, {APP_ENTRY}, {APP}, 100, 16384, 0x0, 0;
"""
ASSERT_LIB = f"""
    def {LIBRARY_ENTRY}(cfe):
        return 0
"""


class LoaderOfTest:
    """The mission's loader, except for one file: loading that file gives a function of the host."""

    def __init__(self, loader: Loader, main: Entry) -> None:
        self.exists = loader.exists
        self.load_library = loader.load_library
        self._load = loader.load
        self._main = main

    def load(self, file: str, symbol: str, app_name: str) -> Entry:
        return self._main if file == APP_FILE else self._load(file, symbol, app_name)


class Attempt:
    """A call of a function in some task of a mission, and its result; errors are kept for the host."""

    def __init__(self, function: Callable[[], object]) -> None:
        self._function = function
        self._error: BaseException | None = None
        self._was_ended = False
        self.is_over = False

    def __call__(self) -> None:
        try:
            self._function()
        except TaskExit:
            self._was_ended = True
            raise
        except BaseException as error:
            self._error = error
        finally:
            self.is_over = True

    def confirm(self, may_exit: bool = False) -> None:
        """Raise the call's exception. Assert that the call ran to its end, unless its task may exit."""
        if self._error is not None:
            raise self._error
        assert self.is_over, "the task has not come to its end"
        assert may_exit or not self._was_ended, "the task was ended on the way"


def make_mission(folder: Path) -> Mission:
    """Return a mission that is ready to boot."""
    return Mission(write_mission(folder, STARTUP, cfe_assert=ASSERT_LIB), console=Console(quiet=True))


def run_as_application(mission: Mission, function: Callable[[], object]) -> None:
    """Boot a mission in which CFE_TEST calls a function as soon as all is up. Raises the function's exception."""
    cfe = mission.cfe
    attempt = Attempt(function)

    def main() -> None:
        cfe.evs.register([(SAMPLE_EVENT, 0)])
        cfe.es.wait_for_system_state(SYSTEM_OPERATIONAL, 10_000)
        attempt()

    cfe.es.loader = LoaderOfTest(cfe.es.loader, main)
    for _ in range(LONGEST_S):
        mission.run_for(1)
        if attempt.is_over:
            break
    attempt.confirm()


def call_outside(cfe: Cfe, function: Callable[[], object]) -> None:
    """Call a function in a task that belongs to no application, and wait for its end.

    Raises the function's exception.
    """
    attempt = Attempt(function)
    task_id = cfe.os.task_create("NonCfe", attempt, CHILD_STACK, CHILD_PRIORITY)
    task = cfe.es.kernel.tasks[-1]
    task.owner = None  # a task made by an application would belong to it
    _wait_for_end(cfe, lambda: cfe.os.task_get_info(task_id))
    attempt.confirm()


def call_in_child(cfe: Cfe, function: Callable[[], object]) -> None:
    """Call a function in a child task, and wait until the task is gone. Raises the function's exception."""
    attempt = Attempt(function)
    task_id = cfe.es.create_child_task("CHILD_TASK_1", attempt, CHILD_STACK, CHILD_PRIORITY)
    _wait_for_end(cfe, lambda: cfe.es.get_task_name(task_id))
    attempt.confirm(may_exit=True)


def _wait_for_end(cfe: Cfe, ask: Callable[[], object]) -> None:
    for _ in range(20):
        try:
            ask()
        except (CfeError, OsalError):
            return
        cfe.os.task_delay(100)
    raise AssertionError("the task is still there")


def answer_of(call: Callable[..., int], *arguments: object) -> int:
    """Return the status of a call whose result is a status; see `status_of`."""
    try:
        return call(*arguments)
    except CfeError as error:
        return error.status


def status_of(call: Callable[..., object], *arguments: object) -> int:
    """How NASA's function answers: the status of the error that a call raises, CFE_SUCCESS when it raises none."""
    try:
        call(*arguments)
    except CfeError as error:
        return error.status
    return CFE_SUCCESS
