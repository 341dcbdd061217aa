"""`Debugger`: stops a run, shows the place, and executes its user's commands: continue, step, inspect, open an app.

The user is asked inside the simulation, in the task in which the run stops, so everything is paused meanwhile.
Questions and answers do not change the run. To look into an application, Python's debugger (`AppDebugger`) is opened in
its task. It stops in the application's own lines, never in those of cfepy, and follows that one task. Operations of
other tasks happen within the line that waits for them.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, TextIO

from cfepy.extra.debugger.app_debugger import AppDebugger, leave_thread, look_at_end, look_into, own_frame
from cfepy.extra.debugger.breakpoints import Breakpoint, VariableCondition, breakpoints, finders
from cfepy.extra.debugger.journey import NOTHING_BEFORE, Journey, LineWay, RunMoment
from cfepy.extra.debugger.keepers import Keepers
from cfepy.ground import LiveNames
from cfepy.mission import Mission, MissionSpec
from cfepy.monitors import Observer, Sent, app_of
from cfepy.pilot.determinism_look import stack_of
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from cfepy.writing.escapes import safe

if TYPE_CHECKING:
    from cfepy.extra.debugger.gdb import GdbSession
    from cfepy.rtos import Kernel, Task
    from cfepy.sb import Pipe

TRACEBACK = "Traceback (most recent call last)"
HELP = """\
  c, continue    continue to the next breakpoint
  s, step        continue to the next event, message or line; so does an empty line
  w, where       show the current lines of the application
  tasks          show all tasks and their waits
  pipes          show all pipes and the number of waiting messages
  pdb            open Python's debugger in the running task
  q, quit        end the run here"""
BACK = """
  b, back        go back by one step
  rc             go back to the last breakpoint
  bt WHAT        go back to the last match of WHAT: a breakpoint as of --break, or an expression of variables"""
NO_WAY = "cannot go back"


class Debugger(Observer):
    """Stops the run that it is attached to.

    Args:
        spec: the mission.
        stops: the breakpoints; see `cfepy.extra.debugger.breakpoints`.
        step: stop at everything that happens, from the beginning or from `from_ns` on.
        app: open Python's debugger in the tasks of this application: at once, or at the first stop when there are
            `stops` or `from_ns`; and at the origin of an exception whose traceback is written to the console.
        from_ns: virtual time of the first stop; None for none.
        gdb: open gdb on the process instead, once.
        on_quit: ends the run.
        commands, stream: input from the user, and output to the user; None for this process's own.
        root: folder that contains the mission's files; their paths are shown without it.
        journey: lets the user go back, by other flights of the same run; None for no way back.
        keepers: processes that shorten the way back; None for none.

    Raises:
        UsageError: an invalid breakpoint.

    Attributes:
        count: stops so far.
    """

    def __init__(
        self,
        spec: MissionSpec,
        *,
        stops: Sequence[str] = (),
        step: bool = False,
        app: str | None = None,
        from_ns: int | None = None,
        gdb: GdbSession | None = None,
        on_quit: Callable[[], object] = lambda: None,
        commands: TextIO | None = None,
        stream: TextIO | None = None,
        root: str = "",
        journey: Journey | None = None,
        keepers: Keepers | None = None,
    ) -> None:
        super().__init__()
        self._root = root
        self.count = 0
        self._journey = journey
        self._keepers = keepers
        self._spec = spec
        self._moment = RunMoment(0)
        self._breakpoints = breakpoints(stops, spec, self._hit)
        self._finders, self._conditions = self._looked_for(spec)
        self._stepping = step and from_ns is None
        self._steps_from = from_ns
        self._then_steps = step
        self._app = app
        self._gdb = gdb
        self._looks = app is not None and not stops and from_ns is None
        self._error: BaseException | None = None  # the last one that was shown
        self._debuggers: dict[Task, AppDebugger] = {}
        self._on_quit = on_quit
        self._commands = sys.stdin if commands is None else commands
        self._stream = safe(sys.stdout if stream is None else stream)
        self._has_begun = self._is_over = False
        self._names: LiveNames
        self._mission: Mission

    # -- the attachment ----------------------------------------------------------------------------------------------

    def bus(self, base: Any) -> Any:
        for each in (*self._breakpoints, *self._finders):
            base = each.bus(base)
        return super().bus(base)

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        """Return a kernel whose tasks may stop when they begin, or continue after a wait."""
        debugger = self

        class StoppingKernel(super().kernel(base)):  # type: ignore[misc]  # mypy follows no class that is a result
            """A kernel whose tasks a debugger can stop."""

            def block(self) -> Any:
                value = super().block()
                debugger._look_around("goes on")
                return value

            def spawn(self, name: str, entry: Callable[[], object], *args: Any, **options: Any) -> Task:
                first = debugger._beginning(entry) if debugger._has_begun else entry
                task: Task = super().spawn(name, first, *args, **options)
                return task

        return StoppingKernel

    def begin(self, mission: Mission) -> None:
        super().begin(mission)
        self._mission = mission
        self._names = LiveNames(mission)
        for each in (*self._breakpoints, *self._finders):
            each.begin(mission)
        mission.kernel.frames_wanted = True
        self._has_begun = True

    def _beginning(self, entry: Callable[[], object]) -> Callable[[], object]:
        """Wrap a task's entry point, with a possible stop before it begins."""

        def begin() -> object:
            task = self._kernel.current
            if self._journey is not None and app_of(task) == self._app and self._gdb is None:
                self._debugger_of(task).count_lines()
            self._look_around("begins")
            return entry()

        return begin

    def conclude(self) -> None:
        """Offer the way back at the end of the run, too."""
        super().conclude()
        journey = self._journey
        if journey is None or self._is_over:
            return
        self._moment = self._after()
        was_search = journey.search is not None
        is_vain = journey.search is not None and journey.search.limit is None and not journey.ends_search()
        is_here = journey.arrives(self._moment)
        if journey.flies_again:
            self._on_quit = _nothing
            self._break_off()
            return
        if is_vain or journey.was_in_vain or (is_here and was_search):
            self._say(NOTHING_BEFORE)
        journey.was_in_vain = False
        if is_here or (journey.asks_at_end and not journey.is_silent):
            self._looks = False
            self._on_quit = _nothing  # the run has already ended
            self._say(f"{self._kernel.now / NS_PER_S:.9f} the end of the run")
            with self._mission.stall_watch.paused():
                self._ask()
            self._is_over = True

    def close(self) -> None:
        super().close()
        leave_thread()
        if self._gdb is not None:
            self._gdb.close()

    @property
    def missed(self) -> list[str]:
        """A line for each breakpoint that never matched, although the run went to its end."""
        return [] if self._is_over else [each.missed for each in self._breakpoints if each.missed is not None]

    # -- events --------------------------------------------------------------------------------------------------------

    def on_send(self, sent: Sent, packet: bytes | bytearray) -> None:
        self._look_around(f"sends {self._names[sent.msg_id]} (0x{sent.msg_id:04X}), {sent.size} bytes")

    def on_receive(self, sent: Sent | None, pipe: Pipe, task: Task, at_ns: int) -> None:
        what = "a message" if sent is None else self._names[sent.msg_id]
        self._look_around(f"takes {what} out of pipe {pipe.name}")

    def on_drop(self, msg_id: int, pipe: Pipe, why: str, at_ns: int) -> None:
        self._look_around(f"{self._names[msg_id]} is dropped at pipe {pipe.name}: {why}")

    def on_note(self, text: str, at_ns: int) -> None:
        self._look_around(text)

    def on_console(self, line: str, at_ns: int) -> None:
        """Look for an exception: a task that writes a traceback to the console has just caught it."""
        self._look_around(f"console: {line}")
        error = sys.exc_info()[1]
        is_silent = self._journey is not None and self._journey.is_silent
        if TRACEBACK in line and error is not None and error is not self._error and not is_silent:
            self._error = error
            self._look_at(error)

    def _look_at(self, error: BaseException) -> None:
        """Open the debugger at an exception that its application did not expect."""
        task = self._kernel.current
        if app_of(task) == self._app and not self._is_over and self._gdb is None:
            self._say(f"{self._place(task)}: {type(error).__name__}: {error}")
            look_at_end(self._debugger_of(task), error)

    def _look_around(self, what: str) -> None:
        """Handle an event in the running task."""
        kernel = self._kernel
        if self._is_over or kernel.current is kernel.host:
            return
        self._moment = self._after()
        if self._keepers is not None and self._journey is not None:
            self._keepers.keep(self._journey, self._moment.happened, self._mission.stall_watch.paused)
        if self._journey is not None and self._journey.is_silent:
            self._pass_by(self._journey, what)
            return
        if self._looks and app_of(kernel.current) == self._app:
            self._looks = False
            self._look_into(kernel.current)
        if self._steps_from is not None and kernel.now >= self._steps_from:
            self._steps_from = None
            self._stop(what)
        elif self._stepping:
            self._stop(what)

    def _after(self) -> RunMoment:
        return RunMoment(self._moment.happened + 1)

    # -- the way back ------------------------------------------------------------------------------------------------

    def _looked_for(self, spec: MissionSpec) -> tuple[list[Breakpoint], dict[str, VariableCondition]]:
        """Return the finders of the searched moments: for messages and events, and for conditions on variables."""
        found: list[Breakpoint] = []
        self._found_by: set[str] = set()  # the texts about messages and events
        conditions: dict[str, VariableCondition] = {}
        for text in () if self._journey is None else self._journey.texts:
            means = finders(text, spec, partial(self._find, text))
            if isinstance(means, VariableCondition):
                conditions[text] = means
            else:
                found += means
                self._found_by.add(text)
        return found, conditions

    def _find(self, text: str, what: str) -> None:
        """Record a message or an event that was searched for."""
        if self._journey is None or self._is_over:
            return
        at = self._moment
        self._moment = moment = RunMoment(at.happened, at.hits, at.finds + 1, text)
        self._journey.finds(moment, text)
        if self._journey.is_silent:
            self._arrive(self._journey, moment, what)

    def _pass_by(self, journey: Journey, what: str) -> None:
        """Handle an event that the user has seen before, or that is only examined in a search."""
        moment, search = self._moment, journey.search
        if search is not None and search.text:
            condition = self._condition(search.text)
            if condition is not None and condition.holds(own_frame()):
                journey.finds(moment, search.text)
        self._arrive(journey, moment, what)

    def _condition(self, text: str) -> VariableCondition | None:
        """Return the condition on variables of a text; None if it is about messages and events."""
        if text not in self._conditions and text not in self._found_by:
            means = finders(text, self._spec, lambda what: None)
            if isinstance(means, VariableCondition):
                self._conditions[text] = means
        return self._conditions.get(text)

    def _arrive(self, journey: Journey, moment: RunMoment, what: str) -> None:
        was_search = journey.search is not None
        if journey.arrives(moment):
            self._looks = self._stepping = False
            self._steps_from = None
            if was_search or journey.was_in_vain:
                self._say(NOTHING_BEFORE)
            journey.was_in_vain = False
            self._stop(what)
        elif journey.flies_again:
            self._break_off()

    def _break_off(self) -> None:
        """End this flight. Another one goes to the user's target, from the beginning or from a keeper."""
        keepers, journey = self._keepers, self._journey
        if keepers is not None and journey is not None:
            search = journey.search
            is_known = search is None or not search.text or search.text in self._found_by
            if (is_known or (search and self._condition(search.text))) and keepers.serves(journey):
                self._mission.forget_files()
                keepers.hand_over(journey)
            keepers.dismiss()
        self._is_over = True
        self._on_quit()

    def _hit(self, what: str) -> None:
        """Handle a match of a breakpoint."""
        if self._is_over:
            return
        at, journey = self._moment, self._journey
        self._moment = moment = RunMoment(at.happened, at.hits + 1)
        if journey is not None and journey.is_silent:
            journey.finds(moment)
            self._arrive(journey, moment, what)
        else:
            self._stop(what)

    def _back(self) -> bool:
        """Go back to the event before."""
        return self._go(lambda journey: journey.go_to(self._moment.before()), self._moment.before().happened > 0)

    def _reverse(self) -> bool:
        """Go back to the last breakpoint."""
        return self._go(lambda journey: journey.look_for("", self._moment), bool(self._breakpoints))

    def _back_to(self, text: str) -> bool:
        """Go back to the last time at which a breakpoint matched or a condition held."""
        try:
            finders(text, self._spec, lambda what: None)
        except UsageError as error:
            self._say(str(error))
            return False
        return self._go(lambda journey: journey.look_for(text, self._moment))

    def _go(self, choose: Callable[[Journey], None], is_possible: bool = True) -> bool:
        if self._journey is None or not is_possible:
            self._say(NO_WAY if self._journey is None else NOTHING_BEFORE)
            return False
        choose(self._journey)
        self._break_off()
        return True

    def _stop(self, what: str) -> None:
        """Stop the run here: show the place, and ask the user."""
        if self._is_over:
            return
        self.count += 1
        task = self._kernel.current
        self._say(f"{self._place(task)}: {what}")
        own = own_frame()
        if own is not None and not self._stepping:
            self._where()
        self._stepping = False
        if self._app is None:
            with self._mission.stall_watch.paused():
                self._ask()
        elif app_of(task) == self._app:
            self._look_into(task)
        else:
            self._looks = True  # as soon as it is its turn

    # -- the user ----------------------------------------------------------------------------------------------------

    def _ask(self) -> None:
        """Execute commands of the user until the run may continue."""
        answers: dict[str, Callable[[], bool]] = {
            "c": lambda: True,
            "s": self._step,
            "w": self._where,
            "tasks": self._tasks,
            "pipes": self._pipes,
            "pdb": self._pdb,
            "q": self._quit,
            "b": self._back,
            "rc": self._reverse,
        }
        while True:
            word = self._read()
            if word is None:
                self._stepping = self._then_steps  # the input has ended: show the stops, and let the run go on
                return
            short = {"continue": "c", "step": "s", "": "s", "where": "w", "quit": "q", "back": "b"}.get(word, word)
            verb, _, text = word.partition(" ")
            if verb == "bt" and text.strip():
                if self._back_to(text.strip()):
                    return
            elif short not in answers:
                self._say(HELP + (BACK if self._journey is not None else ""))
            elif answers[short]():
                return

    def _read(self) -> str | None:
        if self._commands.isatty():
            self._stream.write("(cfepy) ")
            self._stream.flush()
        line = self._commands.readline()
        return line.strip() if line else None

    def _step(self) -> bool:
        self._stepping = True
        return True

    def _quit(self) -> bool:
        self._is_over = True
        self._on_quit()
        return True

    def _pdb(self) -> bool:
        self._look_into(self._kernel.current)
        return True

    def _where(self) -> bool:
        stack = stack_of(sys._getframe())
        if not stack:
            self._say("    in code of cfepy itself")
        for line in stack:
            file = line.file.removeprefix(self._root)
            self._say(f"    {file}:{line.number} in {line.function}: {line.source}")
        return False

    def _tasks(self) -> bool:
        self._say(self._kernel.waiting())
        return False

    def _pipes(self) -> bool:
        for pipe in self._mission.cfe.sb.pipes:
            self._say(f"    {pipe.app_name:<20} {pipe.name:<24} {len(pipe.items):>4} of {pipe.depth}")
        return False

    # -- Python's debugger -------------------------------------------------------------------------------------------

    def _look_into(self, task: Task) -> None:
        if self._gdb is not None:
            self._say(f"{self._place(task)}: gdb")
            with self._mission.stall_watch.paused():
                self._gdb.begin(self._mission, is_running=own_frame() is not None)
            return
        self._say(f"{self._place(task)}: Python's debugger")
        look_into(self._debugger_of(task), own_frame())

    def _debugger_of(self, task: Task) -> AppDebugger:
        if task not in self._debuggers:
            self._debuggers[task] = AppDebugger(
                self._quit, self._mission.stall_watch.paused, self._commands, self._stream, self._root
            )
            if self._journey is not None:
                self._debuggers[task].way_back = LineWay(self._journey, task.ident, self._break_off, self._say)
        return self._debuggers[task]

    def _place(self, task: Task) -> str:
        app = app_of(task)
        return f"{self._kernel.now / NS_PER_S:.9f} {task.name if task.name == app else f'{app}/{task.name}'}"

    def _say(self, text: str) -> None:
        print(text, file=self._stream, flush=True)


def _nothing() -> None:
    """Do nothing: the run is already over."""
