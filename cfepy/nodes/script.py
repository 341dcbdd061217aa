"""Running a program to its end, as `python script.py` does: `__main__`, threads, exit hooks, exit status."""

from __future__ import annotations

from importlib.machinery import SourceFileLoader
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.report import traceback_text
from cfepy.nodes.signal_module import NodeInterrupt
from cfepy.nodes.sources import code_of_file
from cfepy.rtos import TaskExit

EXIT_BITS = 0xFF  # what of a program's exit status its parent gets to see

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def run_script(universe: Universe) -> int:
    """Execute the universe's script as `__main__` in the current task, until its last non-daemon thread has ended.

    Args:
        universe: whose script it is; it runs once.

    Returns:
        The exit status: 0, what `sys.exit` was given, or 1 after an uncaught error, which is in `universe.error`.

    Raises:
        TaskExit: the task was ended from outside; the node's threads are ended too, its exit hooks do not run.
    """
    universe.main_task = universe.kernel.current
    universe.adopt_current()
    if universe.terminal is not None:
        universe.terminal.start_typing()
    try:
        status = _execute(universe)
        status = _shut_down(universe) or status
        universe.exit_status = status
    except TaskExit:
        if universe.exit_status is None:
            raise
    finally:
        universe.end_threads()
        universe.sockets.close_all()
        universe.files.close_all()
        universe.release_current()
        universe.stdout.finish()
        universe.stderr.finish()
    return universe.exit_status


def _execute(universe: Universe) -> int:
    module = ModuleType("__main__")
    loader = SourceFileLoader("__main__", universe.script)
    vars(module).update(
        __builtins__=vars(universe.builtins),
        __cached__=None,
        __file__=universe.script,
        __loader__=loader,
        __package__=None,
    )
    universe.importer.modules["__main__"] = module
    try:
        place = universe.resolve(universe.script)
        exec(code_of_file(place, universe.ordered_sets, universe.script), vars(module))
    except BaseException as error:
        return _status_of(universe, error)
    return 0


def _status_of(universe: Universe, error: BaseException) -> int:
    """The exit status that an error ends the program with; it is shown as Python does."""
    if isinstance(error, SystemExit):
        return _exit_code(universe, error.code)
    if not isinstance(error, (Exception, NodeInterrupt)):
        raise error  # the end of the task, or a Ctrl-C of the host's user
    universe.error = error
    _show(universe, error)
    return 130 if isinstance(error, NodeInterrupt) else 1


def _exit_code(universe: Universe, code: Any) -> int:
    if code is None:
        return 0
    if isinstance(code, int):
        return code & EXIT_BITS
    universe.print_error(f"{code}\n")
    return 1


def _show(universe: Universe, error: BaseException) -> None:
    hook = universe.importer.modules["sys"].excepthook
    try:
        hook(type(error), error, error.__traceback__)
    except Exception as second:
        universe.print_error(f"Error in sys.excepthook:\n{traceback_text(second)}")
        universe.print_error(f"\nOriginal exception was:\n{traceback_text(error)}")


def _shut_down(universe: Universe) -> int:
    """What the interpreter does at its end: join threads, run exit hooks."""
    threading = universe.importer.modules.get("threading")
    status = 0
    if threading is not None:
        try:
            threading._shutdown()
        except BaseException as error:
            status = _status_of(universe, error)
    universe.run_exit_hooks()
    return status
