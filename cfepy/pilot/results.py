"""The results of a run: messages, applications, events, memory, as plain numbers for a table or a JSON file.

`mark` is called at the end of the run's time, before the nodes are asked to shut down. `Results.of` is called after the
mission was closed, when every task has ended and its CPU time is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from cfepy.es import STATE_NAMES, AppRecord
from cfepy.evs import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.ground import kind_of, names_in
from cfepy.mission import CORE_APPS, EndlessWaits, Mission, Reset, Traffic, endless_waits
from cfepy.monitors.record import DeadlineRecord, InvariantRecord, InvariantRecords, InversionRecord
from cfepy.pilot.problems import BESIDE, RunProblem, not_started, own_errors, problems_of, startup_problems
from cfepy.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.rtos import TaskKind
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.monitors import DeadlineResult
    from cfepy.monitors.record import InversionResult

EVENT_TYPES = {DEBUG: "DEBUG", INFORMATION: "INFORMATION", ERROR: "ERROR", CRITICAL: "CRITICAL"}
RESET_TYPES = {RST_TYPE_PROCESSOR: "PROCESSOR", RST_TYPE_POWERON: "POWERON"}
NOT_STARTED = "NOT STARTED"
ENDED = "ENDED"
HALTED = ("WAITING", "STOPPED")
"""The states of applications that ES is about to end."""
PERCENT_OF_FEW_DIGITS, LEAST_PERCENT = 0.1, 0.0001
TOLERANCE = 1.1  # for a measured rate, because messages just before the mission was operational count too


@dataclass(frozen=True, slots=True)
class TopicResult:
    """The results of one MsgId.

    `sent` counts transmissions, `delivered` packets taken from pipes (several for each transmission if several
    subscribe), and `waiting` those not taken before the end. `dropped` is the sum of three reasons: a subscription's
    message limit, a full pipe, a long ROS message that lost a segment. `no_subscriber` counts messages without a
    subscriber. `held_back` counts those that a ROS publisher could only send later because of the board's publishing
    rate. Neither are losses. `rate_hz` is the rate of sending since the mission was operational. `too_fast` means that
    it exceeds the board's `max_publish_hz`.
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

    @property
    def why(self) -> str:
        """Why messages were not delivered, or later than their publisher wanted."""
        reasons = (
            ("message limit", self.dropped_limit),
            ("pipe full", self.dropped_pipe_full),
            ("segment lost", self.dropped_segment),
            ("not taken yet", self.waiting),
            ("held back", self.held_back),
        )
        said = [f"{count:,} {reason}" for reason, count in reasons if count]
        if self.no_subscriber:
            said.append("no subscriber")
        return ", ".join(said)


@dataclass(frozen=True, slots=True)
class AppResult:
    """The results of one application. `state` is its state at the end of the run's time; `cpu_share` is 0 to 1, of
    virtual time.
    """

    name: str
    state: str
    cpu_share: float
    restarts: int
    deaths: int
    error: str | None
    core: bool

    @property
    def cpu_text(self) -> str:
        """The share of the CPU in percent, with more digits if it is small, so that an idle application does not show
        0.
        """
        percent = 100 * self.cpu_share
        if percent >= PERCENT_OF_FEW_DIGITS or not percent:
            return f"{percent:.2f}%"
        return f"{percent:.4f}%" if percent >= LEAST_PERCENT else f"<{LEAST_PERCENT:.4f}%"


@dataclass(frozen=True, slots=True)
class PipeResult:
    """The results of one pipe: its depth, the maximum number of waiting messages, the number of refused messages."""

    name: str
    app: str
    depth: int
    peak: int
    dropped: int


@dataclass(frozen=True, slots=True)
class ResetResult:
    """A reset of the processor: its virtual time in s, "PROCESSOR" or "POWERON", the reason, and whether it was a
    failure.
    """

    at_s: float
    type: str
    reason: str
    fault: bool


@dataclass(frozen=True, slots=True)
class MemoryResult:
    """The use of the board's RAM in bytes; `limit` is None on a board without one."""

    used: int
    peak: int
    limit: int | None
    by_owner: dict[str, int]


@dataclass(frozen=True, slots=True)
class InvariantResult:
    """The results of an invariant: `judged` and `violated` count messages; the first violation and its time in s."""

    name: str
    place: str
    judged: int
    violated: int
    first_at_s: float | None
    first: str


@dataclass(frozen=True, slots=True)
class HeldResult:
    """Resources that an application took at one line and held at the end of the run; the oldest's virtual time in s."""

    app: str
    what: str
    number: int
    since_s: float


@dataclass(frozen=True, slots=True)
class Mark:
    """The state of a run at the end of its time."""

    now_ns: int
    wall_ns: int
    sent: dict[int, int]
    states: dict[str, str]
    pipes: list[PipeResult]
    memory: MemoryResult
    sb: dict[str, int]
    endless: EndlessWaits
    idle_nodes: list[str]
    starved: list[str]
    returned: list[str]
    held: list[HeldResult]


def mark(mission: Mission, wall_ns: int) -> Mark:
    """Record the values that a shutdown of the nodes would change.

    Args:
        mission: after its run.
        wall_ns: wall-clock time of the run, in ns.
    """
    sb, memory = mission.cfe.sb, mission.memory
    traffic = mission.record.traffic(sb, ())
    return Mark(
        mission.kernel.now,
        wall_ns,
        {msg_id: count.sent for msg_id, count in traffic.items()},
        {app.name: _state(app) for app in mission.cfe.es.apps},
        [PipeResult(pipe.name, pipe.app_name, pipe.depth, pipe.peak, pipe.dropped) for pipe in sb.pipes],
        MemoryResult(memory.used, memory.peak, memory.limit, memory.by_owner()),
        mission.processor.sb_task.housekeeping(),
        endless_waits(mission),
        _idle_nodes(mission),
        _starved(mission),
        [_returned(app.name) for app in mission.cfe.es.apps if _state(app) == ENDED],
        _held(mission),
    )


def _returned(app: str) -> str:
    why = "its main function has returned without CFE_ES_ExitApp"
    return f"{app}: {why}; ES keeps the application and its objects"


def _held(mission: Mission) -> list[HeldResult]:
    holdings = mission.processor.holdings
    rows = [] if holdings is None else holdings.rows()
    return [HeldResult(row.app, row.text, row.number, row.since_ns / NS_PER_S) for row in rows]


def _state(app: AppRecord) -> str:
    """Return the state of an application. ES does not notice if a main task ends without CFE_ES_ExitApp."""
    main = app.tasks.get(app.main_task_id)
    state = STATE_NAMES[app.state]
    has_ended = main is None or (main.task is not None and main.task.done)
    return ENDED if has_ended and not app.is_core and state not in HALTED else state


@dataclass(frozen=True, slots=True)
class Results:
    """The numbers of a run; `to_dict` returns the JSON form. Times are in s, `speed` is virtual time divided by wall
    time.

    `booted_s` is about the first boot. `resets` are in order; pipes, memory and `sb` are about the processor since the
    last one, and so is `held`, which only the guard fills. `own_errors` counts ERROR and CRITICAL events of the
    mission's own applications. `problems` has a line for each problem; a run without problems went well. `faults` has a
    row for each planned fault, `deadlines` one for each deadline of the mission file. `inversions` has one for each
    lock for which a task waited while a third task delayed the holder. `ros_peers` has one for each connected external
    ROS node, `viewer_peers` one for the traffic between each viewer and each topic, and `beside` one for each mission
    that flew together with it. `script_problems` are the entries of the startup script that could not be started.
    `endless_waits` has a line for each task that no task can wake any more. `missed_steps` are the failed steps of the
    script. `never_judged` are the rules of the mission file without input. `loose_ends` are topics that connect to
    nothing, idle nodes, and applications that kept others from running. `traps` are loops that wait without a sleep,
    and similar. `missed_moves` are the moves of the schedule that were not possible. `why_tasks` is why tasks are
    threads by default although greenlets are installed.
    """

    mission: str
    virtual_s: float
    wall_s: float
    speed: float
    seed: int
    board: str
    tasks: str
    why_tasks: str
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
    held: list[HeldResult]
    deadlines: list[DeadlineResult]
    inversions: list[InversionResult]
    faults: list[dict[str, Any]]
    ros_peers: list[dict[str, Any]]
    viewer_peers: list[dict[str, Any]]
    beside: list[dict[str, Any]]
    script_problems: list[str]
    endless_waits: list[str]
    missed_moves: list[str]
    missed_steps: list[str]
    never_judged: list[str]
    loose_ends: list[str]
    traps: list[str]
    invariants: list[InvariantResult]
    problems: list[str]

    @classmethod
    def of(
        cls,
        mission: Mission,
        at: Mark,
        trace: str,
        problems: Sequence[RunProblem] | None = None,
        never_judged: Sequence[str] | None = None,
    ) -> Results:
        """Return the results of a closed mission.

        Args:
            mission: the mission.
            at: the result of `mark`.
            trace: the digest of the run, from before the tasks were ended.
            problems: its problems; None determines them.
            never_judged: its rules without input; None determines them.
        """
        virtual_s, wall_s = at.now_ns / NS_PER_S, at.wall_ns / NS_PER_S
        record = mission.record
        problems = problems_of(mission, at.endless) if problems is None else problems
        apps = _apps(mission, at)
        return cls(
            mission=mission.spec.name,
            virtual_s=virtual_s,
            wall_s=wall_s,
            speed=virtual_s / wall_s if wall_s else 0.0,
            seed=mission.seed,
            board=mission.board.name,
            tasks=mission.tasks,
            why_tasks=mission.why_tasks,
            trace=trace,
            booted_s=None if mission.booted is None else mission.booted / NS_PER_S,
            resets=[_reset(each) for each in mission.record.resets],
            max_publish_hz=mission.board.max_publish_hz,
            topics=_topics(mission, at),
            apps=apps,
            events={name: record.event_counts.get(kind, 0) for kind, name in EVENT_TYPES.items()},
            own_errors=own_errors(mission),
            sb=at.sb,
            pipes=at.pipes,
            memory=at.memory,
            held=at.held,
            deadlines=[check.result() for check in record.part(DeadlineRecord).checks],
            inversions=record.part(InversionRecord).results(),
            faults=record.rows("faults"),
            ros_peers=record.rows("ros_peers"),
            viewer_peers=record.rows("viewer_peers"),
            beside=record.rows(BESIDE),
            script_problems=startup_problems(mission),
            endless_waits=[wait.text for wait in at.endless.alone],
            missed_moves=_missed_moves(mission),
            never_judged=rules_without_input(mission) if never_judged is None else list(never_judged),
            loose_ends=[*_loose_ends(mission), *at.idle_nodes, *at.returned, *at.starved],
            traps=[str(each) for each in mission.record.traps],
            missed_steps=[each.text for each in problems if each.is_step],
            invariants=[_invariant(each) for each in record.part(InvariantRecords).values()],
            problems=[each.text for each in problems],
        )

    @property
    def task_kind(self) -> TaskKind:
        """The kind of its tasks, and why installed greenlets were not used."""
        return TaskKind(self.tasks, self.why_tasks)

    @property
    def never_happened(self) -> list[str]:
        """The requests that never happened: faults, moves of the schedule, and rules without input."""
        return [*_never_happened(self.faults, self.missed_moves), *self.never_judged]

    def to_dict(self) -> dict[str, Any]:
        """Return plain dicts, lists, numbers and text."""
        return asdict(self)


def never_happened(mission: Mission, never_judged: Sequence[str] | None = None) -> list[str]:
    """Return `Results.never_happened` of a mission that may still fly.

    Args:
        mission: the mission.
        never_judged: its rules without input; None determines them.
    """
    unjudged = rules_without_input(mission) if never_judged is None else never_judged
    return [*_never_happened(mission.record.rows("faults"), _missed_moves(mission)), *unjudged]


def rules_without_input(mission: Mission) -> list[str]:
    """Return the rules without input; only a mission with rules loads the code for it.

    This reads files of the mission, so they must still exist.
    """
    if not mission.spec.demands:
        return []
    from cfepy.pilot.never_judged import never_judged

    return never_judged(mission)


def _loose_ends(mission: Mission) -> list[str]:
    """Return the topics that connect to nothing; only a mission with nodes loads the code for it."""
    if not mission.processor.topics() and not mission.record.topics:
        return []
    from cfepy.pilot.unconnected_topics import loose_ends

    return loose_ends(mission)


def _idle_nodes(mission: Mission) -> list[str]:
    """Return the nodes that do nothing; only a mission with nodes loads the code for it."""
    if mission.ros is None:
        return []
    from cfepy.pilot.idleness import idle_nodes

    return idle_nodes(mission)


def _starved(mission: Mission) -> list[str]:
    """Return the tasks that others kept from running; only a run that used virtual CPU time loads the code for it."""
    if not mission.kernel.kept_back():
        return []
    from cfepy.pilot.idleness import starved_tasks

    return starved_tasks(mission)


def _never_happened(rows: list[dict[str, Any]], missed_moves: list[str]) -> list[str]:
    # faults that are up to the schedule are left out
    unseen = (row for row in rows if not row["times"] and not row["explored"])
    faults = [f"fault {row['name']} ({row['what']}) never happened: {row['never']}" for row in unseen]
    return [*faults, *missed_moves]


def _missed_moves(mission: Mission) -> list[str]:
    policy = mission.kernel.policy
    return [] if policy is None else list(policy.notes)


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
                error=None if error is None else _described(error),
                core=history.name in CORE_APPS,
            )
        )
    return [*found, *(AppResult(each.name, NOT_STARTED, 0.0, 0, 0, None, False) for each in not_started(mission))]


def _described(error: BaseException) -> str:
    """Return the error that ended an application; only a run with such an error loads the code for tracebacks."""
    from cfepy.mission import described

    return described(error)
