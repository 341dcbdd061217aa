"""`_thread` on the kernel: what the standard library's own `threading`, `queue` and `concurrent.futures` stand on.

A thread is a task at the priority of the thread that starts it.
"""

from __future__ import annotations

import _thread
import sys
from collections.abc import Callable, Mapping, Sequence
from contextvars import Context
from types import ModuleType
from typing import TYPE_CHECKING, Any, NoReturn

from cfepy.nodes.local import make_local
from cfepy.nodes.locks import MAX_WAIT_S, without_holder
from cfepy.nodes.report import traceback_text
from cfepy.nodes.serials import hash_by_serial
from cfepy.nodes.signal_module import NodeInterrupt
from cfepy.nodes.synth import made
from cfepy.rtos import ExploringKernel, TaskExit

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def thread_module(universe: Universe) -> ModuleType:
    """The module `_thread` of a universe."""
    kernel = universe.kernel
    lock, rlock = universe.locks
    sentinels: dict[int, Any] = {}

    def get_ident() -> int:
        return kernel.current.ident

    def set_sentinel() -> Any:
        """The lock whose release tells that the calling thread is gone."""
        ident = kernel.current.ident
        sentinel = sentinels[ident] = lock()
        universe.at_thread_end(ident, lambda: _release(sentinels.pop(ident, None)))
        return sentinel

    def start(
        function: Callable[..., object], args: Sequence[Any] = (), options: Mapping[str, Any] | None = None
    ) -> int:
        given = dict(options or {})
        return universe.start_thread(lambda: _body(universe, function, tuple(args), given)).ident

    names = made(
        "_thread",
        LockType=lock,
        RLock=rlock,
        TIMEOUT_MAX=MAX_WAIT_S,
        _ExceptHookArgs=_thread._ExceptHookArgs,
        _count=lambda: universe.thread_count,
        _excepthook=lambda args: show_thread_error(universe, args),
        _local=make_local(universe),
        _set_sentinel=set_sentinel,
        _is_main_interpreter=lambda: True,
        allocate=lock,
        allocate_lock=lock,
        daemon_threads_allowed=lambda: True,
        error=RuntimeError,
        exit=_exit,
        exit_thread=_exit,
        get_ident=get_ident,
        get_native_id=get_ident,
        interrupt_main=lambda number=2: universe.deliver_signal(number),
        lock=lock,
        stack_size=lambda size=0: 0,
        start_new=start,
        start_new_thread=start,
    )
    if hasattr(_thread, "_ThreadHandle"):
        from cfepy.nodes.thread_handle import handle_names

        vars(names).update(handle_names(universe, start, lock))
    return names


def _body(
    universe: Universe, function: Callable[..., object], args: tuple[Any, ...], options: Mapping[str, Any]
) -> None:
    """A thread that was started below `threading`: its error is shown, and the program goes on."""
    try:
        Context().run(function, *args, **options)
    except (Exception, NodeInterrupt) as error:
        universe.thread_errors.append(error)
        universe.print_error(f"Exception ignored in thread started by: {function!r}\n{traceback_text(error)}")


def show_thread_error(universe: Universe, args: Any) -> None:
    """`threading.excepthook`: the error of a thread ends the thread and not the node.

    Args:
        universe: the node's universe.
        args: as `threading.excepthook` gets them.
    """
    if issubclass(args.exc_type, (TaskExit, SystemExit)):
        return
    error = args.exc_value if args.exc_value is not None else args.exc_type()
    if not isinstance(error, (Exception, NodeInterrupt)):
        raise error  # a Ctrl-C of the host's user
    universe.thread_errors.append(error)
    name = args.thread.name if args.thread is not None else universe.kernel.current.ident
    universe.print_error(f"Exception in thread {name}:\n{traceback_text(error)}")


def fix_threading(universe: Universe, module: Any) -> None:
    """After `threading` was loaded: threads hash by serial number, and asking an event takes CPU time.

    `concurrent.futures` iterates a set of threads; a loop on `event.is_set()` would otherwise never let others run.
    """
    is_set, make_invoke = module.Event.is_set, module._make_invoke_excepthook

    def make_quiet_invoke() -> Callable[[Any], None]:
        """The end of a task, which is how a daemon thread ends with its program, is no error of the node."""
        invoke: Callable[[Any], None] = make_invoke()
        return lambda thread: None if isinstance(sys.exc_info()[1], TaskExit) else invoke(thread)

    def charged_is_set(event: Any) -> bool:
        universe.charge()
        return bool(is_set(event))

    if isinstance(universe.kernel, ExploringKernel):
        allocate_lock = module._allocate_lock  # which makes the locks by which `Condition` wakes its waiters
        module._allocate_lock = lambda: without_holder(allocate_lock())
    module._make_invoke_excepthook = make_quiet_invoke
    hash_by_serial(universe, module.Thread)
    module.Event.is_set = charged_is_set
    module.Event.isSet = charged_is_set


def _release(sentinel: Any) -> None:
    if sentinel is not None and sentinel.locked():
        sentinel.release()


def _exit() -> NoReturn:
    raise SystemExit
