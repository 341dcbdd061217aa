"""Python's debugger in the task of an application: it stops in the application's own lines, never in those of cfepy.

While it waits for its user, the whole mission stands still, for only one task runs at a time. It follows one task; what
others do happens within the line that waits for them. May import cfepy.mission.
"""

from __future__ import annotations

import linecache
import pdb
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager
from types import FrameType, TracebackType
from typing import Any, TextIO

from cfepy.mission.determinism_look import is_library, is_shown


class AppDebugger(pdb.Pdb):
    """One for each task that is looked into.

    Args:
        on_quit: ends the run; the application itself is not disturbed.
        waiting: a context around each time that it waits for its user.
        commands, stream: where the user writes and reads.
        root: folder that source files lie below, and that their paths are shown without.
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

    def canonic(self, filename: str) -> str:
        """As of `bdb.Bdb`: by this path a file is shown, and has its breakpoints."""
        return super().canonic(filename).removeprefix(self._root)

    def lookupmodule(self, filename: str) -> str | None:
        """As of `pdb.Pdb`; a file whose lines are known need not be on this computer."""
        return filename if filename in linecache.cache else super().lookupmodule(filename)

    def cmdloop(self, intro: Any = None) -> None:
        """See `cmd.Cmd.cmdloop`."""
        with self._waiting():
            super().cmdloop(intro)

    def stop_here(self, frame: FrameType) -> bool:
        """As of `bdb.Bdb`, in code of the mission only."""
        return is_own(frame) and bool(super().stop_here(frame))

    def get_stack(self, f: FrameType | None, t: TracebackType | None) -> tuple[list[tuple[FrameType, int]], int]:
        """As of `bdb.Bdb`, without the frames of cfepy."""
        stack, at = super().get_stack(f, t)
        shown = [entry for entry in stack if is_shown(entry[0].f_code.co_filename)]
        current = stack[at] if stack else None
        return (shown, shown.index(current)) if current in shown else (stack, at)

    def do_quit(self, arg: str) -> bool:
        """End the run here."""
        self._on_quit()
        return bool(self.do_continue(arg))

    do_q = do_exit = do_quit

    def do_EOF(self, arg: str) -> bool:
        """Nobody asks any more: go on."""
        return bool(self.do_continue(arg))


def is_own(frame: FrameType) -> bool:
    """Whether a frame is code that somebody wrote for this mission."""
    file = frame.f_code.co_filename
    return is_shown(file) and not is_library(file)


def own_frame() -> FrameType | None:
    """The innermost frame of the mission's own code in the task that runs; None when there is none."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and not is_own(frame):
        frame = frame.f_back
    return frame


def look_into(debugger: AppDebugger, frame: FrameType | None) -> None:
    """Open the debugger at the next line of the application that the current task executes.

    Args:
        debugger: for this task.
        frame: where the application is; None when it has not begun.
    """
    debugger.set_trace(sys._getframe() if frame is None else frame)


def look_at_end(debugger: AppDebugger, error: BaseException) -> None:
    """Open the debugger where an exception came from that nobody caught."""
    trace: TracebackType | None = error.__traceback__
    while trace is not None and not is_own(trace.tb_frame):
        trace = trace.tb_next  # the kernel's frames, above the application's
    debugger.reset()
    interaction: Any = debugger.interaction
    interaction(None, error if sys.version_info >= (3, 13) else trace or error.__traceback__)
