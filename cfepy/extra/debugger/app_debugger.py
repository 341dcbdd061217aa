"""`AppDebugger`: Python's debugger in one task of the mission, which stops only in lines of the mission."""

from __future__ import annotations

import linecache
import pdb
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager
from types import FrameType, TracebackType
from typing import Any, TextIO

from cfepy.extra.debugger.journey import LineWay
from cfepy.interpreter.own_code import is_own_code, is_shown


class AppDebugger(pdb.Pdb):
    """Python's debugger for one task.

    Args:
        on_quit: ends the run; the application itself is not disturbed.
        waiting: a context around each time that it waits for its user.
        commands, stream: input from the user, and output to the user.
        root: folder that contains the source files; their paths are shown without it.
    """

    def __init__(
        self,
        on_quit: Callable[[], object],
        waiting: Callable[[], AbstractContextManager[None]],
        commands: TextIO,
        stream: TextIO,
        root: str = "",
    ) -> None:
        self._root = root
        if commands.isatty():
            super().__init__(nosigint=True, readrc=False)  # with the line editing of a terminal
        else:
            super().__init__(stdin=commands, stdout=stream, nosigint=True, readrc=False)
        self._on_quit = on_quit
        self._waiting = waiting
        self._has_quit = False
        self.way_back: LineWay | None = None

    def count_lines(self) -> None:
        """Begin to count the task's own lines, so that they can be found again."""
        here = sys._getframe()
        self.reset()
        self.botframe = here  # not a frame that is ever executed again: nothing stops
        self._runs_on()
        sys.settrace(self.trace_dispatch)

    def trace_dispatch(self, frame: FrameType, event: str, arg: Any) -> Any:
        """Trace a frame as `bdb.Bdb` does, and count each line of the task's own code."""
        if self._has_quit:
            return None
        way = self.way_back
        if way is not None and event == "line" and is_own(frame):
            if way.passes(self._has_break(frame)):
                self.set_step()
            elif way.is_silent:
                return self.trace_dispatch
        traced = super().trace_dispatch(frame, event, arg)
        return self.trace_dispatch if traced is None and way is not None and is_own(frame) else traced

    def _has_break(self, frame: FrameType) -> bool:
        return frame.f_lineno in self.breaks.get(self.canonic(frame.f_code.co_filename), ())

    def set_continue(self) -> None:
        """Continue as `bdb.Bdb` does, but keep tracing lines without breakpoints."""
        if self.way_back is None:
            super().set_continue()
        else:
            self._runs_on()

    def _runs_on(self) -> None:
        """Stop only at breakpoints, but keep tracing lines."""
        base: Any = super()
        base._set_stopinfo(self.botframe, None, -1)

    def do_rstep(self, arg: str) -> bool:
        """rstep: back to the line of this task that was executed before."""
        return self._goes(LineWay.step_back)

    def do_rcontinue(self, arg: str) -> bool:
        """rcontinue: back to the last line of this task that has a breakpoint."""
        return self._goes(LineWay.to_break)

    do_rs, do_rc = do_rstep, do_rcontinue

    def _goes(self, way: Callable[[LineWay], bool]) -> bool:
        if self.way_back is None:
            self.message("going back requires cfepy replay --back")
            return False
        return way(self.way_back) and bool(self.do_continue(""))

    def canonic(self, filename: str) -> str:
        """Return the path under which a file is shown and has its breakpoints, as `bdb.Bdb` does."""
        return super().canonic(filename).removeprefix(self._root)

    def lookupmodule(self, filename: str) -> str | None:
        """Find a file as `pdb.Pdb` does. A file with known lines need not be on this computer."""
        return filename if filename in linecache.cache else super().lookupmodule(filename)

    def cmdloop(self, intro: Any = None) -> None:
        with self._waiting():
            super().cmdloop(intro)

    def stop_here(self, frame: FrameType) -> bool:
        """Return True where `bdb.Bdb` would stop, in code of the mission only."""
        return is_own(frame) and bool(super().stop_here(frame))

    def get_stack(self, f: FrameType | None, t: TracebackType | None) -> tuple[list[tuple[FrameType, int]], int]:
        """Return the stack as `bdb.Bdb` does, without the frames of cfepy."""
        stack, at = super().get_stack(f, t)
        shown = [entry for entry in stack if is_shown(entry[0].f_code.co_filename)]
        current = stack[at] if stack else None
        return (shown, shown.index(current)) if current in shown else (stack, at)

    def do_quit(self, arg: str) -> bool:
        """End the run here."""
        self._has_quit = True
        self._on_quit()
        return bool(self.do_continue(arg))

    do_q = do_exit = do_quit

    def do_EOF(self, arg: str) -> bool:
        """The input has ended: go on."""
        return bool(self.do_continue(arg))


def is_own(frame: FrameType) -> bool:
    """Return True if a frame is code of this mission, not of a library or of cfepy."""
    return is_own_code(frame.f_code.co_filename)


def own_frame() -> FrameType | None:
    """Return the innermost frame of the mission's own code in the running task; None if there is none."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and not is_own(frame):
        frame = frame.f_back
    return frame


def look_into(debugger: AppDebugger, frame: FrameType | None) -> None:
    """Open the debugger at the next line of the application that the current task executes.

    Args:
        debugger: for this task.
        frame: the application's current frame; None when it has not begun.
    """
    debugger.set_trace(sys._getframe() if frame is None else frame)


def leave_thread() -> None:
    """Stop tracing the calling thread for a task's debugger. For tasks on greenlets, it is the host's thread."""
    if isinstance(getattr(sys.gettrace(), "__self__", None), AppDebugger):
        sys.settrace(None)


def look_at_end(debugger: AppDebugger, error: BaseException) -> None:
    """Open the debugger at the origin of an uncaught exception."""
    trace: TracebackType | None = error.__traceback__
    while trace is not None and not is_own(trace.tb_frame):
        trace = trace.tb_next  # the kernel's frames, above the application's
    debugger.reset()
    interaction: Any = debugger.interaction
    interaction(None, error if sys.version_info >= (3, 13) else trace or error.__traceback__)
