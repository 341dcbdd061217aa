"""What a process is to a Python program, made of one object: modules, threads, environment, streams, signals, entropy.

A Universe belongs to one node of one simulated computer. The modules that it makes (see `cfepy.nodes.sharing`) call
back into it; two universes share nothing that can change. It stands for the process that `rosrun` starts.
"""

from __future__ import annotations

import errno
import importlib
import io
import os
import random
import zlib
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import ModuleType
from typing import TYPE_CHECKING, Any, NoReturn

from cfepy.nodes import (
    asyncio_module,
    datetime_module,
    importlib_module,
    lookup,
    os_module,
    psutil_module,
    random_module,
    report,
    serials,
    signal_module,
    sys_module,
    thread_module,
    time_module,
)
from cfepy.nodes.importer import Factory, Importer
from cfepy.nodes.locks import make_lock_types
from cfepy.nodes.open_files import OpenFiles
from cfepy.nodes.script import EXIT_BITS, run_script
from cfepy.nodes.sharing import refused_modules
from cfepy.nodes.signal_module import NodeInterrupt
from cfepy.nodes.socket_table import SocketTable
from cfepy.nodes.streams import ConsoleStream, NoInput, TypedInput
from cfepy.rtos import Task, TaskExit

if TYPE_CHECKING:
    from cfepy.nodes.terminal import Key, Terminal
    from cfepy.osal.network import Network
    from cfepy.rtos import Kernel

__all__ = ["Factory", "StartThread", "Universe"]

StartThread = Callable[[str, Callable[[], object], int], Task]

# A signal waits for the main task to wait, at most a virtual millisecond: better there than in the middle of a call.
_LOOKS = 100
_LOOK_NS = 10_000
_TERMINAL = "/dev/tty"
_KEPT_ENVIRONMENT = ("HOME", "PATH")


class Universe:
    """The world of one unmodified program.

    Args:
        kernel: the simulated computer's kernel.
        name: the node's name: in output, task names, and (with `seed`) where its random numbers come from.
        script: path of the program.
        argv: its arguments, without the program itself.
        env: its environment; None gives it the host's HOME and PATH and nothing else.
        cwd: its working directory; None is the host's.
        search_paths: folders for its imports, after the script's own.
        library_paths: folders of libraries, after all folders of the node's.
        fallback_paths: folders of stand-ins for what may not be installed, after everything else.
        seed: of the run.
        epoch_ns: the time of day in ns since 1970 (UTC) when the kernel's clock is 0.
        call_cost_ns: virtual CPU time of a call that polls (clock, lock, event); with 0 a polling loop never ends.
        stdout: takes each line that the program prints, with the node's name before it; None keeps the lines in
            `output`.
        modules: factories of further modules by name, such as rospy; a name with dots needs its package to be there.
        find_module: asked for a factory of any name that `modules` does not have; None is "not mine".
        priority: of its tasks, 0 to 255.
        ordered_sets: sets in the node's code iterate in insertion order.
        keys: what is typed at its terminal (`cfepy.nodes.terminal`); None leaves it without one, its input at the end.
        network: what its sockets are plugged into; None refuses them.
        root: folder that stands for the computer's root: what is there is taken from there, and the program believes
            that it is where it was ("" for none).
        on_thread_start: `(task name, entry, priority) -> Task`, starts the task of a thread, so that the owner of the
            node also owns its threads; None uses `Kernel.spawn`.
    """

    def __init__(
        self,
        kernel: Kernel,
        *,
        name: str,
        script: str | os.PathLike[str] = "",
        argv: Sequence[str] = (),
        env: Mapping[str, str] | None = None,
        cwd: str | os.PathLike[str] | None = None,
        search_paths: Sequence[str | os.PathLike[str]] = (),
        library_paths: Sequence[str | os.PathLike[str]] = (),
        fallback_paths: Sequence[str | os.PathLike[str]] = (),
        seed: int = 0,
        epoch_ns: int = 0,
        call_cost_ns: int = 1000,
        stdout: Callable[[str], object] | None = None,
        modules: Mapping[str, Factory] | None = None,
        find_module: Callable[[str], Factory | None] = lambda name: None,
        priority: int = 100,
        ordered_sets: bool = False,
        keys: Sequence[Key] | None = None,
        network: Network | None = None,
        root: str = "",
        on_thread_start: StartThread | None = None,
    ) -> None:
        self.kernel = kernel
        self.name = name
        self._root = root
        self.script = self.shown(os.path.abspath(script)) if script else ""
        self.argv = [self.shown(os.fspath(script)), *argv]
        self.host_name = "cfepy"
        self.pid = 1000 + zlib.crc32(name.encode()) % 30000
        self.priority = priority
        self.cwd = self.shown(os.path.abspath(cwd if cwd is not None else os.getcwd()))
        self.rng = random.Random(f"{seed}/{name}")
        self.serial = 0  # of locks and threads, which hash by it
        # The current task made a call that polls: it takes virtual CPU time, and others get their turn.
        self.charge: Callable[[], object] = partial(kernel.charge, call_cost_ns) if call_cost_ns else _free
        self.ordered_sets = ordered_sets
        self.main_task: Task | None = None
        self.exit_status: int | None = None
        self.error: BaseException | None = None  # what ended the script
        self.thread_errors: list[BaseException] = []
        self.thread_count = 0
        self.exit_hooks: list[tuple[Callable[..., Any], tuple[Any, ...], dict[str, Any]]] = []
        self.output: list[str] = []
        self._sink = stdout if stdout is not None else self.output.append
        self._start = on_thread_start
        self._tasks: dict[Task, None] = {}
        self._finished_cpu_ns = 0
        self._ending = False
        self._thread_ends: dict[int, list[Callable[[], None]]] = {}
        kept = {key: os.environ[key] for key in _KEPT_ENVIRONMENT if key in os.environ}
        self.environ = os_module.Environ(kept if env is None else env)
        self.stdout = ConsoleStream("<stdout>", 1, self._write_line)
        self.stderr = ConsoleStream("<stderr>", 2, self._write_line)
        self.terminal = self._make_terminal(keys) if keys is not None else None
        self.stdin: io.TextIOBase = TypedInput(self.terminal) if self.terminal is not None else NoInput()
        self.sockets = SocketTable(self, network)
        self.files = OpenFiles(self.resolve)
        self.signals = signal_module.SignalTable(self)
        self.clock = time_module.VirtualClock(self, epoch_ns)
        self.locks = make_lock_types(self)
        folders = [os.path.dirname(self.script)] if self.script else []
        self.importer = Importer(
            self,
            folders=[*folders, *(os.fspath(folder) for folder in search_paths)],
            libraries=[os.fspath(folder) for folder in library_paths],
            fallbacks=[os.fspath(folder) for folder in fallback_paths],
            ordered=ordered_sets,
            factories={**_made_modules(), **(modules or {})},
            find_factory=find_module,
            fixes=_FIXES,
        )
        self.builtins = sys_module.builtins_module(self, ordered_sets)
        self.importer.modules["builtins"] = self.builtins
        self.importer.load("sys")

    def run_script(self) -> int:
        """Execute the script in the current task; see `cfepy.nodes.script.run_script`."""
        return run_script(self)

    def spawn(self) -> Task:
        """Start a task that executes the script."""
        return self.kernel.spawn(self.name, self.run_script, self.priority)

    def _make_terminal(self, keys: Sequence[Key]) -> Terminal:
        from cfepy.nodes.terminal import Terminal  # not on every system, and rarely needed

        return Terminal(self, keys, self.deliver_signal)

    # -- threads -----------------------------------------------------------------------------------------------------

    @property
    def main_ident(self) -> int:
        """The thread identifier of the task that runs the script, 0 before it started."""
        return self.main_task.ident if self.main_task is not None else 0

    @property
    def tasks(self) -> tuple[Task, ...]:
        """The node's living tasks, oldest first."""
        return tuple(task for task in self._tasks if not task.done)

    @property
    def cpu_ns(self) -> int:
        """Virtual CPU time that the node's tasks have used, in ns."""
        return self._finished_cpu_ns + sum(task.cpu_ns for task in self._tasks)

    def start_thread(self, entry: Callable[[], object]) -> Task:
        """Start a thread of the node: a task at its starter's priority, that its owner can end."""
        self.thread_count += 1
        name = f"{self.name}.{self.thread_count}"
        current = self.kernel.current
        priority = self.priority if current is self.kernel.host else current.base_priority

        def body() -> None:
            self.adopt_current()
            try:
                entry()
            except SystemExit:
                pass
            finally:
                self.release_current()

        start = self._start if self._start is not None else self.kernel.spawn
        task = start(name, body, priority)
        if not task.done:
            self._tasks[task] = None  # one that is ended before it ever ran does not adopt itself
        return task

    def adopt_current(self) -> None:
        """The current task belongs to the node from now on."""
        self._tasks[self.kernel.current] = None

    def release_current(self) -> None:
        """The current task is about to end: forget what it kept, and let those go on that join it."""
        task = self.kernel.current
        for forget in self._thread_ends.pop(task.ident, ()):
            forget()
        self._finished_cpu_ns += task.cpu_ns
        self._tasks.pop(task, None)

    def at_thread_end(self, ident: int, action: Callable[[], None]) -> None:
        """Have something done when the thread `ident` ends."""
        self._thread_ends.setdefault(ident, []).append(action)

    def end_threads(self) -> None:
        """End all tasks of the node but the current one, which may itself be ended because of this: do it once."""
        if self._ending:
            return
        self._ending = True
        for task in reversed(self.tasks):
            if task is not self.kernel.current:
                self.kernel.kill(task)

    # -- the process -------------------------------------------------------------------------------------------------

    def exit_now(self, status: int) -> NoReturn:
        """`os._exit`: the node ends here, with all its threads and without its exit hooks."""
        self.exit_status = status & EXIT_BITS
        self.end_threads()
        raise TaskExit

    def run_exit_hooks(self) -> None:
        """Run what was registered with `atexit`, last one first; an error in one is shown, and the rest still run."""
        while self.exit_hooks:
            function, args, options = self.exit_hooks.pop()
            try:
                function(*args, **options)
            except SystemExit:
                pass
            except Exception as error:
                self.print_error(f"Exception ignored in atexit callback {function!r}:\n{report.traceback_text(error)}")

    def deliver_signal(self, number: int) -> None:
        """Let the node's handler of a signal run in the current task, which must be one of the node's.

        What it raises, the KeyboardInterrupt of SIGINT among it, comes out of the call that the main task waits in.
        """
        try:
            self.signals.deliver(number)
        except (Exception, NodeInterrupt, SystemExit) as error:
            main = self.main_task
            if main is None or main is self.kernel.current:
                raise
            for _ in range(_LOOKS):
                if self.kernel.is_waiting(main):
                    break
                self.kernel.delay(_LOOK_NS)
            self.kernel.interrupt(main, error)

    def resolve(self, path: Any) -> Any:
        """A path as the host sees it: relative ones start at the node's working directory.

        Raises:
            OSError: ENXIO, it is the host's terminal.
        """
        if isinstance(path, int):
            return path
        plain = os.fspath(path)
        if plain == _TERMINAL:
            raise OSError(errno.ENXIO, os.strerror(errno.ENXIO), _TERMINAL)
        if not os.path.isabs(plain):
            path = os.path.join(os.fsencode(self.cwd) if isinstance(plain, bytes) else self.cwd, plain)
        return self._below_root(path) if self._root else path

    def shown(self, path: str) -> str:
        """A path of the host as the program sees it."""
        return path.removeprefix(self._root)

    def _below_root(self, path: Any) -> str:
        """Where a path leads: below the root, if it or its folder is there; else it is the host's own."""
        plain = os.fsdecode(path)
        inside = self._root + self.shown(plain)
        is_new = not os.path.lexists(plain) and os.path.isdir(os.path.dirname(inside))
        return inside if is_new or os.path.lexists(inside) else plain

    def change_directory(self, path: str | os.PathLike[str]) -> None:
        """`os.chdir`."""
        target = os.path.normpath(self.resolve(path))
        os.listdir(target)  # raises what os.chdir would
        self.cwd = self.shown(target)

    # -- output ------------------------------------------------------------------------------------------------------

    def print_error(self, text: str) -> None:
        """Write to what the node has as `sys.stderr` now."""
        stream = getattr(self.importer.modules["sys"], "stderr", None) or self.stderr
        stream.write(text)
        stream.flush()

    def _write_line(self, line: str) -> None:
        self._sink(f"[{self.name}] {line}")


def _free() -> None:
    """A call that takes no virtual time."""


_FIXES: dict[str, Callable[[Universe, ModuleType], None]] = {
    "asyncio": asyncio_module.fix_asyncio,
    "concurrent.futures._base": serials.fix_futures,
    "random": random_module.fix_random,
    "threading": thread_module.fix_threading,
    "traceback": lambda universe, module: report.hide_in(module),
}


def _late_module(file: str, function: str) -> Factory:
    """The factory of a module that few nodes import, and not every system has."""

    def factory(universe: Universe) -> ModuleType:
        module: ModuleType = getattr(importlib.import_module(f"cfepy.nodes.{file}"), function)(universe)
        return module

    return factory


def _made_modules() -> dict[str, Factory]:
    return {
        **refused_modules(),
        "_curses": _late_module("curses_module", "curses_module"),
        "_signal": signal_module.signal_module,
        "_socket": _late_module("socket_module", "socket_module"),
        "_thread": thread_module.thread_module,
        "atexit": signal_module.atexit_module,
        "dataclasses": lookup.dataclasses_module,
        "datetime": datetime_module.datetime_module,
        "fcntl": _late_module("termios_module", "fcntl_module"),
        "functools": lookup.functools_module,
        "gc": _late_module("process_modules", "gc_module"),
        "importlib": importlib_module.importlib_module,
        "importlib.util": importlib_module.importlib_util_module,
        "inspect": lookup.inspect_module,
        "io": sys_module.io_module,
        "locale": _late_module("process_modules", "locale_module"),
        "numpy": random_module.numpy_module,
        "numpy.random": random_module.numpy_random_module,
        "os": os_module.os_module,
        "resource": _late_module("process_modules", "resource_module"),
        "select": _late_module("select_module", "select_module"),
        "psutil": psutil_module.psutil_module,
        "signal": signal_module.signal_module,
        "socket": _late_module("socket_module", "socket_module"),
        "sys": sys_module.sys_module,
        "termios": _late_module("termios_module", "termios_module"),
        "time": time_module.time_module,
        "typing": lookup.typing_module,
    }
