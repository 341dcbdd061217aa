"""`Universe`: the process environment of a Python program: modules, threads, environment, streams, signals, entropy.

A Universe belongs to one node of one simulated computer. It replaces the process that `rosrun` starts, from `__main__`
to the exit status. The modules that it makes (`cfepy.nodes.stdlib`) call back into it. Two universes share no mutable
state.
"""

from __future__ import annotations

import errno
import io
import os
import random
import sys
import zlib
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial
from importlib.machinery import SourceFileLoader
from types import ModuleType
from typing import TYPE_CHECKING, Any, NoReturn

from cfepy.interpreter.host_system import check_own_builtins
from cfepy.interpreter.node_interrupt import NodeInterrupt
from cfepy.nodes.busy_waits import HOOK, turn_hook
from cfepy.nodes.files import OpenFiles, file_points
from cfepy.nodes.importer import Factory, Importer, ShownNames
from cfepy.nodes.module_origins import Provision
from cfepy.nodes.node_sources import doubts_of
from cfepy.nodes.node_tracebacks import traceback_text
from cfepy.nodes.stdlib import os_module, signal_module, sys_module, time_module
from cfepy.nodes.stdlib.descriptors import SocketTable
from cfepy.nodes.stdlib.locks import make_lock_types
from cfepy.nodes.stdlib.replacements import for_nodes
from cfepy.nodes.stdlib.streams import ConsoleStream, NoInput, TypedInput
from cfepy.rtos import Task, TaskExit, is_end_of_task

if TYPE_CHECKING:
    from cfepy.nodes.accesses import Accesses
    from cfepy.nodes.files import Overlay
    from cfepy.nodes.stdlib.terminal import Key, Terminal
    from cfepy.osal import Network
    from cfepy.rtos import Kernel

__all__ = ["Factory", "StartThread", "Universe"]

StartThread = Callable[[str, Callable[[], object], int], Task]

# A signal is delivered while the main task waits, at most one virtual millisecond later, not in the middle of a call.
_LOOKS = 100
_LOOK_NS = 10_000
_TERMINAL = "/dev/tty"
_KEPT_ENVIRONMENT = ("HOME", "PATH")
EXIT_BITS = 0xFF  # bits of a program's exit status that its parent sees


class Universe:
    """Environment of one unmodified program.

    Args:
        kernel: kernel of the simulated computer.
        name: name of the node. It appears in output and task names, and (with `seed`) seeds the node's random numbers.
        script: path of the program.
        argv: arguments of the program, without the program itself.
        env: its environment; None for only the host's HOME and PATH.
        cwd: its working directory; None for the host's.
        search_paths: folders in which it finds modules, after the script's own folder.
        library_paths: folders of libraries, searched after all of the node's folders.
        fallback_paths: folders of replacements for packages that may not be installed, searched last.
        seed: seed of the run.
        epoch_ns: time of day in ns since 1970 (UTC) at which the kernel's clock is 0.
        call_cost_ns: virtual CPU time in ns of a polling call (clock, lock, event). With 0, a polling loop never ends.
        stdout: receives each line that the program prints, with the node's name before it; None stores the lines in
            `output`.
        provision: replacements for the host's modules; None for those of a node.
        modules: factories of further modules by name, such as rospy. A dotted name requires that its package exists.
        find_module: returns a factory for a name that `modules` does not contain, or None if it does not know the name.
        shown_names: returns the public names that a module of a library shows (`Importer`), or None if it shows all.
        priority: priority of its tasks, 0 to 255.
        ordered_sets: whether sets in the node's code iterate in insertion order.
        keys: keys typed at its terminal (`cfepy.nodes.stdlib.terminal`). With None it has no terminal, and its input is
            at the end of the file.
        network: network of its sockets; None refuses sockets.
        root: folder that replaces the computer's root directory, "" for none. Files that exist there are read from
            there, and the program sees them at their usual path.
        overlay: files of its run, which already include that root; None lets the program read and write the host's
            files.
        accesses: where the accesses of its code are reported; None for no reports.
        traps: gets the loops of its code that wait without a sleep.
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
        provision: Provision | None = None,
        modules: Mapping[str, Factory] | None = None,
        find_module: Callable[[str], Factory | None] = lambda name: None,
        shown_names: ShownNames = lambda name: None,
        priority: int = 100,
        ordered_sets: bool = False,
        keys: Sequence[Key] | None = None,
        network: Network | None = None,
        root: str = "",
        overlay: Overlay | None = None,
        accesses: Accesses | None = None,
        traps: list[object] | None = None,
        on_thread_start: StartThread | None = None,
        entry: tuple[str, str] | None = None,
        program: str | os.PathLike[str] = "",
    ) -> None:
        check_own_builtins()
        self.kernel = kernel
        self.name = name
        self._root = root
        self.overlay = overlay
        self.script = self.shown(os.path.abspath(script)) if script else ""
        self.argv = [self.shown(os.fspath(program or script)), *argv]
        self.entry = entry
        self.host_name = "cfepy"
        self.pid = process_number(name)
        self.priority = priority
        self.cwd = self.shown(os.path.abspath(cwd if cwd is not None else os.getcwd()))
        self.rng = random.Random(f"{seed}/{name}")
        self.serial = 0  # serial number of locks and threads, by which they hash
        # The current task polled: it uses virtual CPU time, and others get their turn.
        self.charge: Callable[[], object] = partial(kernel.charge, call_cost_ns) if call_cost_ns else _free
        self.ordered_sets = ordered_sets
        self.make_hidden_objects: Callable[[], object] = _free  # those that programs find only through `gc`
        self.main_task: Task | None = None
        self.exit_status: int | None = None
        self.on_bad_end: Callable[[], object] = lambda: None  # called when the program has ended with an error
        self.error: BaseException | None = None  # error that ended the script
        self.thread_errors: list[BaseException] = []
        self.thread_count = 0
        self.exit_hooks: list[tuple[Callable[..., Any], tuple[Any, ...], dict[str, Any]]] = []
        self.output: list[str] = []
        self._sink = stdout if stdout is not None else self.output.append
        self._start = on_thread_start
        self._tasks: dict[Task, None] = {}
        self._finished_cpu_ns = 0
        self._ending = False
        self._has_left = False  # by `os._exit`, after which threads that unwind print nothing
        self._thread_ends: dict[int, list[Callable[[], None]]] = {}
        kept = {key: os.environ[key] for key in _KEPT_ENVIRONMENT if key in os.environ}
        self.file_points = file_points(kernel)
        self.environ = os_module.Environ(kept if env is None else env)
        self.stdout = ConsoleStream("<stdout>", 1, self._write_line)
        self.last_words = ""  # the last line of its standard error
        self.stderr = ConsoleStream("<stderr>", 2, self._write_error_line)
        self.terminal = self._make_terminal(keys) if keys is not None else None
        self.stdin: io.TextIOBase = TypedInput(self.terminal) if self.terminal is not None else NoInput()
        self.sockets = SocketTable(self, network)
        self.files = OpenFiles(self.resolve if overlay is None else self.absolute, overlay, self.file_points)
        self.signals = signal_module.SignalTable(self)
        self.clock = time_module.VirtualClock(self, epoch_ns)
        self.locks = make_lock_types(self)
        folders = [os.path.dirname(self.script)] if self.script else []
        provided = for_nodes() if provision is None else provision
        self.importer = Importer(
            self,
            folders=[*folders, *(os.fspath(folder) for folder in search_paths)],
            libraries=[os.fspath(folder) for folder in library_paths],
            fallbacks=[os.fspath(folder) for folder in fallback_paths],
            ordered=ordered_sets,
            provision=replace(provided, factories={**provided.factories, **(modules or {})}),
            find_factory=find_module,
            shown_names=shown_names,
            accesses=accesses,
        )
        self.builtins = sys_module.builtins_module(self, ordered_sets)
        found = [] if traps is None else traps
        vars(self.builtins)[HOOK] = turn_hook(kernel, call_cost_ns, lambda: self.name, found)
        self._adopt: Callable[[dict[str, Any]], None] | None = None
        if accesses is not None and accesses.is_on:
            vars(self.builtins).update(accesses.hooks())
            self._adopt = accesses.adopt
        self.importer.modules["builtins"] = self.builtins
        self.importer.load("sys")

    def run_script(self) -> int:
        """Execute the script as `__main__` in the current task, until its last non-daemon thread has ended.

        Call it only once.

        Returns:
            The exit status: 0, the status passed to `sys.exit`, or 1 after an uncaught error. `error` holds that error.

        Raises:
            TaskExit: if the task was ended from outside. The node's threads are then ended too, without its exit hooks.
        """
        return _run_script(self)

    def adopts(self, variables: dict[str, Any]) -> None:
        """Register the variables of the script's module as mission variables."""
        if self._adopt is not None:
            self._adopt(variables)

    def spawn(self) -> Task:
        """Start a task that executes the script."""
        return self.kernel.spawn(self.name, self.run_script, self.priority)

    def _make_terminal(self, keys: Sequence[Key]) -> Terminal:
        from cfepy.nodes.stdlib.terminal import Terminal  # not available on every system, and rarely needed

        return Terminal(self, keys, self.deliver_signal)

    # -- threads -----------------------------------------------------------------------------------------------------

    @property
    def main_ident(self) -> int:
        """The thread identifier of the task that runs the script, 0 before it started."""
        return self.main_task.ident if self.main_task is not None else 0

    @property
    def is_ending(self) -> bool:
        """Whether the program has ended, or ends now."""
        return self._ending

    @property
    def tasks(self) -> tuple[Task, ...]:
        """The node's living tasks, oldest first."""
        return tuple(task for task in self._tasks if not task.done)

    @property
    def cpu_ns(self) -> int:
        """Virtual CPU time that the node's tasks have used, in ns."""
        return self._finished_cpu_ns + sum(task.cpu_ns for task in self._tasks)

    def start_thread(self, entry: Callable[[], object]) -> Task:
        """Start a thread of the node: a task at its creator's priority that its owner can end."""
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
            self._tasks[task] = None  # a task that is ended before its first run does not register itself
        return task

    def adopt_current(self) -> None:
        """Add the current task to the node."""
        self._tasks[self.kernel.current] = None

    def release_current(self) -> None:
        """Clean up for the current task, which is about to end: drop its data and release those that join it."""
        task = self.kernel.current
        for forget in self._thread_ends.pop(task.ident, ()):
            forget()
        self._finished_cpu_ns += task.cpu_ns
        self._tasks.pop(task, None)

    def at_thread_end(self, ident: int, action: Callable[[], None]) -> None:
        """Run an action when the thread `ident` ends."""
        self._thread_ends.setdefault(ident, []).append(action)

    def end_threads(self) -> None:
        """End all tasks of the node except the current one, which this may end too, so it is done only once."""
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
        self.stdout.finish()
        self.stderr.finish()
        self._has_left = True
        self.end_threads()
        raise TaskExit

    def run_exit_hooks(self) -> None:
        """Run the functions registered with `atexit`, last one first; an error in one is shown, and the rest
        still run.
        """
        while self.exit_hooks:
            function, args, options = self.exit_hooks.pop()
            try:
                function(*args, **options)
            except SystemExit:
                pass
            except (Exception, NodeInterrupt) as error:
                self.print_error(f"Exception ignored in atexit callback {function!r}:\n{traceback_text(error)}")

    def deliver_signal(self, number: int) -> None:
        """Run the node's handler of a signal in the current task, which must belong to the node.

        An exception of the handler, such as the KeyboardInterrupt of SIGINT, is raised in the main task, by the call in
        which it waits.
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

    def absolute(self, path: Any) -> str:
        """Return an absolute path; relative paths start at the node's working directory.

        Raises:
            OSError: ENXIO, if the path is the host's terminal (/dev/tty).
        """
        plain = os.fsdecode(path)
        if plain == _TERMINAL:
            raise OSError(errno.ENXIO, os.strerror(errno.ENXIO), _TERMINAL)
        return plain if os.path.isabs(plain) else os.path.join(self.cwd, plain)

    def resolve(self, path: Any) -> Any:
        """Return the host path of a program's path, for reading.

        Raises:
            OSError: ENXIO, if the path is the host's terminal (/dev/tty).
        """
        if isinstance(path, int):
            return path
        whole = self.absolute(path)
        if self.overlay is not None:
            whole = self.overlay.place(self.overlay.real(whole))
        elif self._root:
            whole = self._below_root(whole)
        return os.fsencode(whole) if isinstance(path, bytes) else whole

    def places(self, folder: str) -> list[str]:
        """Return the host paths of a program's folder, the run's own files first."""
        if self.overlay is None:
            return [self.resolve(folder)]
        try:
            found = self.overlay.places(self.overlay.real(self.absolute(folder)))
        except OSError:  # such as a path into an archive
            return [self.absolute(folder)]
        for place in found[:-1]:
            sys.path_importer_cache.pop(place, None)  # the cache uses the real time of the folder
        return found

    def claimed(self, path: str) -> str:
        """Return the host path of a program's path, for changes.

        Raises:
            OSError: if the file cannot be changed.
        """
        if self.overlay is None:
            return str(self.resolve(path))
        return self.overlay.claim(self.overlay.real(self.absolute(path)))

    def shown(self, path: str) -> str:
        """Return a path of the host as the program sees it."""
        return (path if self.overlay is None else self.overlay.shown(path)).removeprefix(self._root)

    def _below_root(self, path: Any) -> str:
        """Return the host path of a path: below the root, if it or its folder exists there, otherwise the
        host's own.
        """
        plain = os.fsdecode(path)
        inside = self._root + self.shown(plain)
        is_new = not os.path.lexists(plain) and os.path.isdir(os.path.dirname(inside))
        return inside if is_new or os.path.lexists(inside) else plain

    def change_directory(self, path: str | os.PathLike[str]) -> None:
        """`os.chdir`."""
        if self.overlay is not None:
            try:
                target = self.overlay.real(self.absolute(path))
                self.overlay.check_entry(target)
            except OSError as error:
                error.filename = path
                raise
        else:
            target = os.path.normpath(self.resolve(path))
            os.listdir(target)  # raises the errors of os.chdir
        self.cwd = self.shown(target)

    # -- output ------------------------------------------------------------------------------------------------------

    def print_error(self, text: str) -> None:
        """Write to the node's current `sys.stderr`."""
        stream = getattr(self.importer.modules["sys"], "stderr", None) or self.stderr
        stream.write(text)
        stream.flush()

    def _write_line(self, line: str) -> None:
        if not self._has_left:
            self._sink(f"[{self.name}] {line}")

    def _write_error_line(self, line: str) -> None:
        if not self._has_left:
            self.last_words = line or self.last_words
        self._write_line(line)


def process_number(name: str) -> int:
    """Return the first choice for a node's process number: a hash of its name, from 1000 to 30999.

    If another node already has the number, `ProcessNumbers.take` finds a free one.

    Args:
        name: name of the node.
    """
    return 1000 + zlib.crc32(name.encode()) % 30000


class ProcessNumbers:
    """The process numbers in use: each node of a mission has its own, which is also the port in its URIs.

    Args:
        taken: ports that no node can have, because they are used otherwise.
    """

    def __init__(self, taken: Collection[int] = ()) -> None:
        self._taken = set(taken)

    def take(self, wanted: int) -> int:
        """Reserve and return the first number from `wanted` on that no other node has.

        Args:
            wanted: the preferred number; see `process_number`.
        """
        while wanted in self._taken:
            wanted += 1
        self._taken.add(wanted)
        return wanted

    def give(self, number: int) -> None:
        """Release the number of a node that has ended."""
        self._taken.remove(number)


def _free() -> None:
    """Do nothing, for calls without cost in virtual time."""


def _run_script(universe: Universe) -> int:
    universe.main_task = universe.kernel.current
    universe.adopt_current()
    if universe.terminal is not None:
        universe.terminal.start_typing()
    try:
        status = _execute(universe)
        if status:
            universe.on_bad_end()
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
        if universe.entry is not None:
            name, function = universe.entry
            main = getattr(universe.importer.load(name), function)
            universe.importer.load("sys").exit(main())
        code = universe.importer.own_code(universe.resolve(universe.script), universe.script, is_main=True)
        universe.adopts(vars(module))
        for doubt in doubts_of(code):  # only for the program itself: modules come from Python's byte code cache
            universe.importer.load("warnings").warn_explicit(doubt.text, doubt.category, universe.script, doubt.line)
        exec(code, vars(module))
    except BaseException as error:
        return _status_of(universe, error)
    return 0


def _status_of(universe: Universe, error: BaseException) -> int:
    """Return the exit status for an error that ends the program; it is shown as in Python."""
    if isinstance(error, SystemExit):
        return _exit_code(universe, error.code)
    if not isinstance(error, (Exception, NodeInterrupt)):
        raise error  # the end of the task, or a Ctrl-C of the host's user
    if is_end_of_task(error):
        raise TaskExit
    universe.error = error
    _show(universe, error)
    return 130 if type(error) is NodeInterrupt else 1  # not for classes derived from it, as in CPython


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
    """Join threads and run exit hooks, as the interpreter does at its end."""
    threading = universe.importer.modules.get("threading")
    status = 0
    if threading is not None:
        try:
            threading._shutdown()
        except BaseException as error:
            status = _status_of(universe, error)
    universe.run_exit_hooks()
    return status
