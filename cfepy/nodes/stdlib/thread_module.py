"""`_thread` on the kernel, on which the standard library's own `threading`, `queue` and `concurrent.futures` are based.

A thread is a task with the priority of the thread that starts it. `threading.local` stores values by task: greenlet
tasks share one OS thread, and CPython's own `threading.local` stores values by OS thread. From Python 3.13 on
`threading` is based on joinable threads and their handles.
"""

from __future__ import annotations

import _thread
import sys
from collections.abc import Callable, Mapping, Sequence
from contextvars import Context
from types import ModuleType
from typing import TYPE_CHECKING, Any, NoReturn
from weakref import ref

from cfepy.interpreter.node_interrupt import NodeInterrupt
from cfepy.interpreter.own_code import called_as
from cfepy.nodes.made_modules import made
from cfepy.nodes.node_tracebacks import traceback_text
from cfepy.nodes.stdlib.futures import hash_by_serial
from cfepy.nodes.stdlib.locks import END, INNER, MAX_WAIT_S, as_waiter
from cfepy.rtos import is_end_of_task
from cfepy.schedules import ExploringKernel

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe
    from cfepy.rtos import Kernel, Task


def make_local(universe: Universe) -> type:
    """Return the class `_thread._local` of a universe."""
    kernel = universe.kernel
    get, put = object.__getattribute__, object.__setattr__

    def forget_at_end(self: Any, ident: int) -> None:
        """Values are freed with their thread, or with the object if that is freed first."""
        weak = ref(self)

        def forget() -> None:
            alive = weak()
            if alive is not None:
                get(alive, "_local__state")[0].pop(ident, None)

        universe.at_thread_end(ident, forget)

    def switch(self: Any) -> None:
        states, args, options = get(self, "_local__state")
        ident = kernel.current.ident
        names = states.get(ident)
        if names is None:
            states[ident] = names = {}
            forget_at_end(self, ident)
            put(self, "__dict__", names)
            type(self).__init__(self, *args, **options)
        elif get(self, "__dict__") is not names:
            put(self, "__dict__", names)

    class _local:
        """Attributes with a separate value for each thread."""

        __slots__ = ("__dict__", "__weakref__", "_local__state")

        def __new__(cls, *args: Any, **options: Any) -> _local:
            if (args or options) and cls.__init__ is object.__init__:
                raise TypeError("Initialization arguments are not supported")
            self = super().__new__(cls)
            ident = kernel.current.ident
            states: dict[int, dict[str, Any]] = {ident: get(self, "__dict__")}
            put(self, "_local__state", (states, args, options))
            forget_at_end(self, ident)
            return self

        def __getattribute__(self, name: str) -> Any:
            switch(self)
            return get(self, name)

        def __setattr__(self, name: str, value: Any) -> None:
            switch(self)
            put(self, name, value)

        def __delattr__(self, name: str) -> None:
            switch(self)
            object.__delattr__(self, name)

    _local.__module__ = "_thread"
    return _local


class ThreadHandle:
    """A thread that can be joined.

    Args:
        gate: a fresh lock of the universe; it is held until the thread is done.
        ident: identifier of a thread that already runs; None for a thread to be started.
        kernel: its observer learns which tasks have seen the end of the thread.
    """

    def __init__(self, gate: Any, ident: int | None = None, kernel: Kernel | None = None) -> None:
        self._kernel = kernel
        self.ident = ident
        self._done = False
        self._gate = gate
        gate.acquire()
        gate.points = END
        self.held_by(None)

    def is_done(self) -> bool:
        """Return whether the thread has ended."""
        if self._done and self._kernel is not None:
            self._kernel.tell(self._gate, "is_done")
        return self._done

    def held_by(self, task: Task | None) -> None:
        """Make those who join wait for this task, not for the one that created the handle."""
        self._gate.holder = task

    def _set_done(self) -> None:
        if not self._done:
            self._done = True
            self._gate.release()

    def join(self, timeout: float | None = None) -> None:
        """Wait for the end, at most `timeout` seconds."""
        if not self.is_done() and self._gate.acquire(True, -1 if timeout is None or timeout < 0 else timeout):
            self._gate.release()


def handle_names(universe: Universe, start: Callable[..., int], lock: Callable[[], Any]) -> dict[str, Any]:
    """Return the names that `_thread` also has from Python 3.13 on."""
    waited_for: list[ThreadHandle] = []

    def new_handle() -> ThreadHandle:
        return ThreadHandle(lock(), kernel=universe.kernel)

    def start_joinable(
        function: Callable[[], object], handle: ThreadHandle | None = None, daemon: bool = True
    ) -> ThreadHandle:
        thread = handle if handle is not None else new_handle()

        def run() -> None:
            task = universe.kernel.current
            thread.ident = task.ident
            thread.held_by(task)
            try:
                function()
            finally:
                thread._set_done()

        thread.ident = start(run)
        if not daemon:
            waited_for.append(thread)
        return thread

    def shutdown() -> None:
        while waited_for:
            waited_for.pop(0).join()

    return {
        "_ThreadHandle": new_handle,
        "_get_main_thread_ident": lambda: universe.main_ident,
        "_make_thread_handle": lambda ident: ThreadHandle(lock(), ident, universe.kernel),
        "_shutdown": shutdown,
        "start_joinable_thread": start_joinable,
    }


def thread_module(universe: Universe) -> ModuleType:
    """Return the module `_thread` of a universe."""
    kernel = universe.kernel
    lock, rlock = universe.locks
    sentinels: dict[int, Any] = {}

    def get_ident() -> int:
        return kernel.current.ident

    def set_sentinel() -> Any:
        """Return the lock whose release signals the end of the calling thread."""
        ident = kernel.current.ident
        sentinel = sentinels[ident] = lock()
        sentinel.holder = kernel.current
        sentinel.points = END
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
        vars(names).update(handle_names(universe, start, lock))
    return names


def _body(
    universe: Universe, function: Callable[..., object], args: tuple[Any, ...], options: Mapping[str, Any]
) -> None:
    """Run a thread started without `threading`: its error is shown, and the program continues."""
    try:
        Context().run(function, *args, **options)
    except (Exception, NodeInterrupt) as error:
        if is_end_of_task(error):
            return
        universe.thread_errors.append(error)
        universe.print_error(f"Exception ignored in thread started by: {function!r}\n{traceback_text(error)}")


def show_thread_error(universe: Universe, args: Any) -> None:
    """`threading.excepthook`: an error ends the thread and not the node.

    Args:
        universe: universe of the node.
        args: the argument of `threading.excepthook`.
    """
    if issubclass(args.exc_type, SystemExit) or is_end_of_task(args.exc_value):
        return
    error = args.exc_value if args.exc_value is not None else args.exc_type()
    if not isinstance(error, (Exception, NodeInterrupt)):
        raise error  # a Ctrl-C of the host's user
    universe.thread_errors.append(error)
    name = args.thread.name if args.thread is not None else universe.kernel.current.ident
    universe.print_error(f"Exception in thread {name}:\n{traceback_text(error)}")


def fix_threading(universe: Universe, module: Any) -> None:
    """Fix `threading` after loading: threads hash by serial number, and checking an event takes CPU time.

    `concurrent.futures` iterates over a set of threads. Without the CPU time, a loop that polls `event.is_set()` would
    never let other tasks run.
    """
    is_set, make_invoke = module.Event.is_set, module._make_invoke_excepthook

    def make_quiet_invoke() -> Callable[[Any], None]:
        """The end of a task, by which a daemon thread ends with its program, is not an error of the node."""
        invoke: Callable[[Any], None] = make_invoke()
        return lambda thread: None if is_end_of_task(sys.exc_info()[1]) else invoke(thread)

    def charged_is_set(event: Any) -> bool:
        kernel = universe.kernel
        if isinstance(kernel, ExploringKernel) and event._cond._lock.points is INNER:
            kernel.hush(universe.charge)
        else:
            universe.charge()
        result = bool(is_set(event))
        if result and isinstance(kernel, ExploringKernel) and kernel.observer is not None:
            kernel.observer.returned(event._cond._lock, "is_set", (), result)  # the setter of the event held that lock
        return result

    if isinstance(universe.kernel, ExploringKernel):
        allocate_lock = module._allocate_lock  # it makes the locks with which `Condition` wakes waiting threads
        module._allocate_lock = lambda: as_waiter(allocate_lock())
        for name in ("active_count", "enumerate"):  # their lock belongs to threading
            setattr(module, name, _after_point(universe.kernel, getattr(module, name)))
        for name in ("_start_new_thread", "_start_joinable_thread"):  # depends on the Python version
            if hasattr(module, name):
                setattr(module, name, _in_one_step(universe.kernel, getattr(module, name)))
    module._make_invoke_excepthook = make_quiet_invoke
    hash_by_serial(universe, module.Thread)
    module.Event.is_set = charged_is_set
    module.Event.isSet = charged_is_set


def _after_point(kernel: ExploringKernel, look: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function before which other tasks may run."""

    def looked() -> Any:
        kernel.point()
        return look()

    return called_as(looked, look.__name__)


def _in_one_step(kernel: ExploringKernel, start: Callable[..., Any]) -> Callable[..., Any]:
    """Return `Thread.start`'s way to start a thread: it waits until the thread has started, so no point is needed
    between.
    """

    def start_thread(*args: Any, **options: Any) -> Any:
        kernel.point()
        started = kernel.hush(start, *args, **options)
        kernel.forgive()
        return started

    return called_as(start_thread, "start_new_thread")


def _release(sentinel: Any) -> None:
    if sentinel is not None and sentinel.locked():
        sentinel.release()


def _exit() -> NoReturn:
    raise SystemExit
