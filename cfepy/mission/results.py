"""What a run came to: messages, applications, events, memory, as plain numbers for a table or a JSON file.

`mark` is called when the time of the run is over, before the nodes are asked to shut down; `Results.of` after the
mission was closed, when every task has ended and its CPU time is known.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from cfepy.es.records import APP_ERROR, STATE_NAMES
from cfepy.es.startup_script import CFE_APP, CFE_LIB, BadLine, Entry, entries, parse
from cfepy.evs.events import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.mission.mission import Mission
from cfepy.mission.msg_names import names_in
from cfepy.mission.processor import CORE_APPS
from cfepy.mission.record import InvariantRecord, Reset, Traffic
from cfepy.mission.tracebacks import described
from cfepy.psp.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.rtos.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.mission.deadline_checks import DeadlineResult

EVENT_TYPES = {DEBUG: "DEBUG", INFORMATION: "INFORMATION", ERROR: "ERROR", CRITICAL: "CRITICAL"}
RESET_TYPES = {RST_TYPE_PROCESSOR: "PROCESSOR", RST_TYPE_POWERON: "POWERON"}
NOT_STARTED = "NOT STARTED"
ENDED = "ENDED"
TOLERANCE = 1.1  # of a measured rate: what was sent shortly before the mission was operational counts too


@dataclass(frozen=True, slots=True)
class TopicResult:
    """One MsgId.

    `sent` counts transmissions, `delivered` packets taken out of pipes (several a transmission, where several
    subscribe), `waiting` those that nobody took before the end. `dropped` is the sum of its three reasons: a
    subscription's message limit, a full pipe, a long ROS message that lost a segment. `no_subscriber` counts messages
    that nobody wanted and `held_back` those that a ROS publisher could send only later, because the board publishes no
    faster; neither are losses. `rate_hz` is what was sent in the time since the mission was operational; `too_fast`
    says that it is more than the board's `max_publish_hz`.
    """

    name: str
    msg_id: int
    type: str
    sent: int
    delivered: int
    waiting: int
    dropped: int
    dropped_limit: int
    dropped_pipe_full: int
    dropped_segment: int
    no_subscriber: int
    held_back: int
    rate_hz: float
    too_fast: bool


@dataclass(frozen=True, slots=True)
class AppResult:
    """One application. `state` is that at the end of the run's time; `cpu_share` is 0 to 1, of virtual time."""

    name: str
    state: str
    cpu_share: float
    restarts: int
    deaths: int
    error: str | None
    core: bool


@dataclass(frozen=True, slots=True)
class PipeResult:
    """One pipe: how many messages it takes, how many ever waited, how many did not get in."""

    name: str
    app: str
    depth: int
    peak: int
    dropped: int


@dataclass(frozen=True, slots=True)
class ResetResult:
    """A reset of the processor: when in virtual s, "PROCESSOR" or "POWERON", why, and whether it was a failure."""

    at_s: float
    type: str
    reason: str
    fault: bool


@dataclass(frozen=True, slots=True)
class MemoryResult:
    """The board's RAM in bytes; `limit` is None on a board without one."""

    used: int
    peak: int
    limit: int | None
    by_owner: dict[str, int]


@dataclass(frozen=True, slots=True)
class InvariantResult:
    """What became of an invariant: `judged` and `violated` count messages; what was wrong first, and when in s."""

    name: str
    place: str
    judged: int
    violated: int
    first_at_s: float | None
    first: str


@dataclass(frozen=True, slots=True)
class Mark:
    """The state of a run when its time was over."""

    now_ns: int
    wall_ns: int
    sent: dict[int, int]
    states: dict[str, str]
    pipes: list[PipeResult]
    memory: MemoryResult
    sb: dict[str, int]
    deadlocks: list[str]


def mark(mission: Mission, wall_ns: int) -> Mark:
    """Take down what a shutdown of the nodes would change.

    Args:
        mission: after its run.
        wall_ns: wall-clock time that the run took, in ns.
    """
    sb, memory = mission.cfe.sb, mission.memory
    traffic = mission.record.traffic(sb, ())
    return Mark(
        mission.kernel.now,
        wall_ns,
        {msg_id: count.sent for msg_id, count in traffic.items()},
        {app.name: STATE_NAMES[app.state] for app in mission.cfe.es.apps},
        [PipeResult(pipe.name, pipe.app_name, pipe.depth, pipe.peak, pipe.dropped) for pipe in sb.pipes],
        MemoryResult(memory.used, memory.peak, memory.limit, memory.by_owner()),
        mission.processor.sb_task.housekeeping(),
        ["; ".join(map(str, circle)) for circle in mission.kernel.deadlocked()],
    )


@dataclass(frozen=True, slots=True)
class Results:
    """The numbers of a run; `to_dict` gives the JSON form. Times in s, `speed` is virtual time by wall time.

    `booted_s` is of the first boot, `resets` are in order; pipes, memory and `sb` are of the processor since the last
    one. `own_errors` counts ERROR and CRITICAL events of the mission's own applications. `problems` says, a line each,
    why the run did not end well, `faults` has a row for each fault that was to happen, `deadlines` one for each of the
    mission file, `script_problems` what of the startup script could not be started.
    """

    mission: str
    virtual_s: float
    wall_s: float
    speed: float
    seed: int
    board: str
    tasks: str
    trace: str
    booted_s: float | None
    resets: list[ResetResult]
    max_publish_hz: int
    topics: list[TopicResult]
    apps: list[AppResult]
    events: dict[str, int]
    own_errors: dict[str, int]
    sb: dict[str, int]
    pipes: list[PipeResult]
    memory: MemoryResult
    deadlines: list[DeadlineResult]
    faults: list[dict[str, Any]]
    script_problems: list[str]
    invariants: list[InvariantResult]
    problems: list[str]

    @classmethod
    def of(cls, mission: Mission, at: Mark, trace: str) -> Results:
        """The results of a mission that is closed.

        Args:
            mission: the mission.
            at: what `mark` took down.
            trace: the digest of the run, from before the tasks were ended.
        """
        virtual_s, wall_s = at.now_ns / NS_PER_S, at.wall_ns / NS_PER_S
        record = mission.record
        own_errors = {name: count for name, count in sorted(record.errors_by_app.items()) if name not in CORE_APPS}
        apps = _apps(mission, at)
        return cls(
            mission=mission.spec.name,
            virtual_s=virtual_s,
            wall_s=wall_s,
            speed=virtual_s / wall_s if wall_s else 0.0,
            seed=mission.seed,
            board=mission.board.name,
            tasks=mission.tasks,
            trace=trace,
            booted_s=None if mission.booted is None else mission.booted / NS_PER_S,
            resets=[_reset(each) for each in mission.record.resets],
            max_publish_hz=mission.board.max_publish_hz,
            topics=_topics(mission, at),
            apps=apps,
            events={name: record.event_counts.get(kind, 0) for kind, name in EVENT_TYPES.items()},
            own_errors=own_errors,
            sb=at.sb,
            pipes=at.pipes,
            memory=at.memory,
            deadlines=[check.result() for check in record.deadlines],
            faults=[] if record.faults is None else record.faults.rows(),
            script_problems=_script_problems(mission, apps),
            invariants=[_invariant(each) for each in record.invariants.values()],
            problems=[*_problems(mission, own_errors), *(f"deadlock: {circle}" for circle in at.deadlocks)],
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain dicts, lists, numbers and text."""
        return asdict(self)


def _invariant(record: InvariantRecord) -> InvariantResult:
    first = record.first
    at_s = None if first is None else first.at_ns / NS_PER_S
    text = "" if first is None else first.text
    return InvariantResult(record.name, record.place, record.judged, record.violated, at_s, text)


def _reset(reset: Reset) -> ResetResult:
    return ResetResult(reset.at_ns / NS_PER_S, RESET_TYPES[reset.reset_type], reset.reason, reset.fault)


def _topics(mission: Mission, at: Mark) -> list[TopicResult]:
    names = names_in(mission)
    rows = mission.record.topics | {row.msg_id: row for row in mission.processor.topics()}
    found = []
    for msg_id, count in mission.record.traffic(mission.cfe.sb, mission.processor.topics()).items():
        row = rows.get(msg_id)
        name = row.name if row is not None else names.get(msg_id, f"0x{msg_id:04X}")
        kind = row.type if row is not None else kind_of(msg_id)
        found.append(_topic(name, msg_id, kind, count, _rate(mission, at, msg_id), mission.board.max_publish_hz))
    return found


def _rate(mission: Mission, at: Mark, msg_id: int) -> float:
    since_boot_ns = at.now_ns - (mission.booted or 0)
    return at.sent.get(msg_id, 0) * NS_PER_S / since_boot_ns if since_boot_ns else 0.0


def _topic(name: str, msg_id: int, kind: str, count: Traffic, rate_hz: float, limit_hz: int) -> TopicResult:
    return TopicResult(
        name=name,
        msg_id=msg_id,
        type=kind,
        sent=count.sent,
        delivered=count.delivered,
        waiting=count.waiting,
        dropped=count.dropped_limit + count.dropped_pipe_full + count.dropped_segment,
        dropped_limit=count.dropped_limit,
        dropped_pipe_full=count.dropped_pipe_full,
        dropped_segment=count.dropped_segment,
        no_subscriber=count.no_subscriber,
        held_back=count.held_back,
        rate_hz=round(rate_hz, 3),
        too_fast=bool(limit_hz) and rate_hz > limit_hz * TOLERANCE,
    )


def kind_of(msg_id: int) -> str:
    """What a MsgId says of its packets: "command" or "telemetry"."""
    return "command" if msg_id & 0x1000 else "telemetry"


def _apps(mission: Mission, at: Mark) -> list[AppResult]:
    found = []
    end_ns = mission.kernel.now
    for history in mission.cfe.es.history.values():
        error = history.last_error
        found.append(
            AppResult(
                name=history.name,
                state=at.states.get(history.name, ENDED),
                cpu_share=history.cpu_ns / end_ns if end_ns else 0.0,
                restarts=history.restarts,
                deaths=history.deaths,
                error=None if error is None else described(error),
                core=history.name in CORE_APPS,
            )
        )
    known = {app.name for app in found}
    for entry in _entries(mission):
        if entry.kind == CFE_APP and entry.name not in known:
            known.add(entry.name)
            found.append(AppResult(entry.name, NOT_STARTED, 0.0, 0, 0, None, False))
    return found


def _script_problems(mission: Mission, apps: list[AppResult]) -> list[str]:
    if mission.booted is None:
        return []  # the startup script was not read to its end
    script = mission.spec.script
    bad = (line for line in parse(mission.spec.startup_script) if isinstance(line, BadLine))
    loaded = {library.name for library in mission.cfe.es.libs}
    return [
        *(f"{script}:{line.line}: {line.explanation}" for line in bad),
        *(f"library {each.name} could not be loaded" for each in _libraries(mission) if each.name not in loaded),
        *(f"{app.name} could not be started" for app in apps if app.state == NOT_STARTED),
    ]


def _problems(mission: Mission, own_errors: dict[str, int]) -> list[str]:
    found = deaths(mission)
    found += [f"{name} ended with {end_of(mission, name)}" for name in ended_badly(mission)]
    for name, count in own_errors.items():
        found.append(f"{name} sent {count} ERROR or CRITICAL event{'s' if count > 1 else ''}")
    for reset in mission.record.resets:
        if reset.fault:
            found.append(f"the processor was reset at {reset.at_ns / NS_PER_S:g} s: {reset.reason}")
    for each in mission.record.invariants.values():
        if each.first is not None:
            found.append(
                f"invariant {each.name!r} ({each.place}) at {each.first.at_ns / NS_PER_S:g} s: {each.first.text}"
            )
    missed = (check.result().problem for check in mission.record.deadlines)
    return found + [problem for problem in missed if problem is not None]


def end_of(mission: Mission, name: str) -> str:
    """What an application has ended with: of a node, its program's exit status."""
    end = None if mission.ros is None else mission.ros.ended.get(name)
    if end is None or not end.status:
        return "CFE_ES_RunStatus_APP_ERROR"
    return f"exit status {end.status} (node /{end.name})"


def deaths(mission: Mission) -> list[str]:
    """A line for each application that died: how often, and of what at last."""
    found = []
    for app in mission.cfe.es.history.values():
        if app.last_error is not None:
            times = "" if app.deaths == 1 else f" {app.deaths} times"
            found.append(f"{app.name} died{times}: {described(app.last_error)}")
    return found


def ended_badly(mission: Mission) -> list[str]:
    """Applications that ended themselves because of an error."""
    es = mission.cfe.es
    ended = [history.name for history in es.history.values() if history.error_exits]
    ending = [app.name for app in es.apps if app.control_request == APP_ERROR]
    return list(dict.fromkeys(ended + ending))


def _libraries(mission: Mission) -> list[Entry]:
    return [entry for entry in _entries(mission) if entry.kind == CFE_LIB]


def _entries(mission: Mission) -> list[Entry]:
    return entries(mission.spec.startup_script)
