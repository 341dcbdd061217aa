"""A run in the Trace Event Format, which Perfetto (ui.perfetto.dev) and chrome://tracing open.

A process stands for an application and a thread for a task of it. "mission" is a process of its own, with one thread
for each kind of event of the whole mission. Events at one instant are drawn apart (`trace_events`); `args.virtual_ns`
is the true time.
"""

from __future__ import annotations

from typing import IO, Any

from cfepy.es import AppRecord
from cfepy.extra.reports.noteworthy import DEADLINE, FAULT, INVARIANT, event_in, mark_of
from cfepy.extra.reports.trace_events import STEP_NS, TraceEvents, us
from cfepy.ground import LiveNames
from cfepy.monitors import Observer, Sent, app_of
from cfepy.rtos import Task
from cfepy.sb import Pipe

MISSION = "mission"
MISSION_TRACKS = ("console", "events", "resets", DEADLINE, FAULT, INVARIANT, "notes")
MOST_UNDER_WAY = 20_000  # transmissions whose arrows can still be drawn
FIRST_OWN_TID = 1 << 30  # of threads that stand for no task


class PerfettoTrace(Observer):
    """Writes the trace while the mission runs.

    Args:
        file: a text file, which the caller closes.
    """

    def __init__(self, file: IO[str]) -> None:
        super().__init__()
        self._events = TraceEvents(file)
        self._write, self._draw = self._events.write, self._events.draw
        self._names: LiveNames
        self._pids: dict[str, int] = {}
        self._tids: set[tuple[int, int]] = set()
        self._open: tuple[int, int] | None = None
        self._starts: dict[int, tuple[int, int, int]] = {}  # by number: drawn time, pid, tid
        self._flows = 0
        self._depths: dict[tuple[int, str], int] = {}
        self._markers: dict[tuple[int, int], int] = {}  # entered and not left, by task and marker: pid

    @property
    def error(self) -> OSError | None:
        """The error of writing, for the caller that closes the file."""
        return self._events.error

    def begin(self, mission: Any) -> None:
        super().begin(mission)
        self._names = LiveNames(mission)
        self._events.begin()
        pid = self._pid(MISSION)
        for number, name in enumerate(MISSION_TRACKS):
            self._events.name_thread(pid, FIRST_OWN_TID + number, name)

    def power_up(self, processor: Any) -> None:
        """Draw a reset as an instant, and follow ES's performance log, which shows the marked parts of the code that
        run.
        """
        self._end_run(self._kernel.now)
        super().power_up(processor)
        resets = self.mission.record.resets
        if resets:
            self._instant("resets", "reset", self._kernel.now, scope="g", reason=resets[-1].reason)
        log = processor.cfe.es.perf_log
        log.add = self._marking(log.add)

    def close(self) -> None:
        """End all open slices, and end the file with a description of the run."""
        self._end_run(self._kernel.now)
        for (ident, marker), pid in list(self._markers.items()):
            self._leave_marker(pid, ident, marker, self._kernel.now)
        mission = self.mission
        self._events.end({"mission": mission.spec.name, "board": mission.board.name, "seed": mission.seed})

    # -- tracks ------------------------------------------------------------------------------------------------------

    def _pid(self, app: str) -> int:
        pid = self._pids.get(app)
        if pid is None:
            pid = self._pids[app] = len(self._pids) + 1
            self._events.name_process(pid, app)
        return pid

    def _track(self, task: Task) -> tuple[int, int]:
        pid = self._pid(app_of(task))
        tid = task.ident or FIRST_OWN_TID - 1
        if (pid, tid) not in self._tids:
            self._tids.add((pid, tid))
            self._events.name_thread(pid, tid, task.name)
        return pid, tid

    # -- events --------------------------------------------------------------------------------------------------------

    def on_run(self, task: Task, at_ns: int) -> None:
        """Begin a slice."""
        pid, tid = self._open = self._track(task)
        self._write(
            ph="B", pid=pid, tid=tid, ts=us(self._draw(at_ns)), name="running", cat="task", args={"virtual_ns": at_ns}
        )

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        """End the slice."""
        self._end_run(at_ns)

    def _end_run(self, at_ns: int) -> None:
        if self._open is not None:
            pid, tid = self._open
            self._open = None
            self._write(ph="E", pid=pid, tid=tid, ts=us(self._draw(at_ns)))

    def on_send(self, sent: Sent, packet: bytes | bytearray) -> None:
        """Draw a short slice inside the sender's slice. Events also get an instant marker."""
        pid, tid = self._track(sent.task)
        name = self._names[sent.msg_id]
        drawn = self._short(pid, tid, f"send {name}", sent.at_ns, sent)
        self._starts[sent.number] = drawn, pid, tid
        if len(self._starts) > MOST_UNDER_WAY:
            del self._starts[next(iter(self._starts))]
        event = event_in(sent.msg_id, packet, sent.at_ns)
        if event is not None:
            self._instant("events", event.type_name, sent.at_ns, app=event.app, id=event.event_id, text=event.text)

    def on_receive(self, sent: Sent | None, pipe: Pipe, task: Task, at_ns: int) -> None:
        """Draw a short slice inside the receiver's slice, and an arrow that leads to it."""
        pid, tid = self._track(task)
        name = "" if sent is None else self._names[sent.msg_id]
        drawn = self._short(pid, tid, f"receive {name or pipe.name}", at_ns, sent, pipe=pipe.name)
        if sent is None or sent.number not in self._starts:
            return
        start, from_pid, from_tid = self._starts[sent.number]
        self._flows = flow = self._flows + 1
        self._write(ph="s", id=flow, pid=from_pid, tid=from_tid, ts=us(start), name="message", cat="message")
        self._write(ph="f", bp="e", id=flow, pid=pid, tid=tid, ts=us(drawn), name="message", cat="message")

    def _short(self, pid: int, tid: int, name: str, at_ns: int, sent: Sent | None, **more: Any) -> int:
        drawn = self._draw(at_ns)
        args = {"virtual_ns": at_ns, **more}
        if sent is not None:
            args |= {"MsgId": f"0x{sent.msg_id:04X}", "sequence": sent.sequence, "bytes": sent.size}
        self._write(ph="X", pid=pid, tid=tid, ts=us(drawn), dur=us(STEP_NS), name=name, cat="message", args=args)
        return drawn

    def on_drop(self, msg_id: int, pipe: Pipe, why: str, at_ns: int) -> None:
        """Draw an instant in the sender's track."""
        pid, tid = self._track(self._kernel.current)
        args = {"virtual_ns": at_ns, "pipe": pipe.name, "why": why}
        drawn = us(self._draw(at_ns))
        name = f"dropped {self._names[msg_id]}"
        self._write(ph="i", s="t", pid=pid, tid=tid, ts=drawn, name=name, cat="drop", args=args)

    def on_depth(self, pipe: Pipe, at_ns: int) -> None:
        """Draw a counter for each pipe when it changes."""
        key, waiting = (self._pid(pipe.app_name), f"pipe {pipe.name}"), len(pipe.items)
        if self._depths.get(key) == waiting:
            return
        self._depths[key] = waiting
        self._write(ph="C", pid=key[0], tid=0, ts=us(self._draw(at_ns)), name=key[1], args={"waiting": waiting})

    def on_console(self, line: str, at_ns: int) -> None:
        """Draw an instant; a noteworthy line is drawn across all tracks."""
        mark = mark_of(line)
        if mark is None:
            self._instant("console", line, at_ns)
        else:
            self._instant(*mark, at_ns, scope="g")

    def on_note(self, text: str, at_ns: int) -> None:
        """Draw a note of a fault, an invariant or a deadline as an instant across all tracks."""
        self._instant(*(mark_of(text) or ("notes", text)), at_ns, scope="g")

    def _instant(self, track: str, name: str, at_ns: int, scope: str = "t", **more: Any) -> None:
        tid = FIRST_OWN_TID + MISSION_TRACKS.index(track)
        drawn = us(self._draw(at_ns))
        args = {"virtual_ns": at_ns, **more}
        self._write(ph="i", s=scope, pid=self._pid(MISSION), tid=tid, ts=drawn, name=name, cat=track, args=args)

    # -- the performance log -----------------------------------------------------------------------------------------

    def _marking(self, add: Any) -> Any:
        def mark(marker: int, entry_exit: int) -> None:
            add(marker, entry_exit)
            task, now = self._kernel.current, self._kernel.now
            if isinstance(task.owner, AppRecord):
                pid, _ = self._track(task)
                self._leave_marker(pid, task.ident, marker, now)
                if not entry_exit & 1:
                    self._enter_marker(pid, task.ident, marker, now)

        return mark

    def _enter_marker(self, pid: int, ident: int, marker: int, at_ns: int) -> None:
        self._markers[ident, marker] = pid
        self._async("b", pid, ident, marker, at_ns)

    def _leave_marker(self, pid: int, ident: int, marker: int, at_ns: int) -> None:
        if self._markers.pop((ident, marker), None) is not None:
            self._async("e", pid, ident, marker, at_ns)

    def _async(self, phase: str, pid: int, ident: int, marker: int, at_ns: int) -> None:
        number, drawn = f"{ident}.{marker}", us(self._draw(at_ns))
        self._write(ph=phase, id=number, pid=pid, tid=ident, ts=drawn, name=f"marker {marker}", cat="performance log")
