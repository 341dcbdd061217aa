"""More planted bugs: programs that benchmark other schedule searches, rewritten here, and further races.

They are measured with the default policy alone, as a first `cfepy explore` uses it, and have their own page.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from pathlib import Path

from cfepy.extra.exploration import verdict
from cfepy.extra.exploration.deadlock import waits_of
from cfepy.extra.exploration.trial import Trial
from cfepy.pilot.plan import RunPlan
from cfepy.schedules import Schedule
from cfepy.units import NS_PER_S
from dev.quality.bugs import CFE, ROS, SECONDS, Bug

POINTS = "at:points=attributes"
RAISED, DEADLOCK, STUCK = (verdict.RAISED,), (verdict.DEADLOCK,), (verdict.STUCK, verdict.DEADLOCK)
INVARIANT, EVENT = (verdict.INVARIANT,), (verdict.EVENT,)
MAPLE = {
    "bank_account": 20,
    "reorder_three": -10,
    "reorder_ten": -11,
    "two_stages": 8,
    "two_stages_many": -11,
    "wrong_lock": 6,
    "carter": 6,
    "deadlock_two": -7,
    "philosophers_three": 1,
    "philosophers_six": 1,
    "circular_buffer": -17,
    "shared_stack": -10,
    "lazy_sum": 1,
    "token_ring": 5,
    "driver_stop": -11,
    "signal_once": 1,
    "file_blocks": 1,
    "text_buffer": 9,
    "closed_queue": 4,
    "missing_barrier": 1,
    "safe_stack": -23,
    "work_stealing": -12,
}
"""Runs in which Maple, which looks for idioms of interleaving, found the originals; below zero: not in so many."""


@dataclass(frozen=True, slots=True)
class Program(Bug):
    """A mission with a mistake known from other benchmarks.

    Attributes:
        origin: the tool or benchmark that uses such a program, and its name there; empty for a program of ours.
        options: options of all schedules, as written after a schedule's kind: `at` with options.
        hangs: it fails under every schedule, including fifo.
        bound: how many preemptions the original needs, according to SCTBench's authors; empty if unknown.
    """

    origin: str = ""
    options: str = "at"
    hangs: bool = False
    bound: str = ""

    @property
    def published(self) -> str:
        """Return the known facts about the original, or an empty text."""
        runs = MAPLE.get(self.name, 0)
        maple = f"Maple {runs}" if runs > 0 else f"Maple > {-runs}" if runs else ""
        return ", ".join(each for each in (maple, self.bound) if each)

    def asked(self) -> str:
        """Return the arguments of `cfepy explore`, in addition to the mission and `--for`."""
        options = Schedule.parse(self.options)
        words = [f"--points {options.points}"] if options.points else []
        words += ["--any-priority"] if options.any_priority else []
        words += ["--faults faults.yaml"] if (self.folder / "faults.yaml").is_file() else []
        return " ".join(words)


PROGRAMS = (
    Program("bank_account", ROS, "each access holds the lock, but not both together", origin="SCTBench: account_bad"),
    Program(
        "reorder_three", ROS, "a pair is read half written", RAISED, origin="SCTBench: reorder_3_bad", options=POINTS
    ),
    Program(
        "reorder_ten", ROS, "the same, with nine writers", RAISED, origin="SCTBench: reorder_10_bad", options=POINTS
    ),
    Program("two_stages", ROS, "a reader comes between two stages", RAISED, origin="SCTBench: twostage_bad"),
    Program(
        "two_stages_many",
        ROS,
        "the same, with 19 workers",
        RAISED,
        origin="SCTBench: twostage_100_bad, of 20 threads",
    ),
    Program("wrong_lock", ROS, "one counter, two locks", origin="SCTBench: wronglock_bad"),
    Program("carter", ROS, "two locks in two orders, chosen by a counter", DEADLOCK, origin="SCTBench: carter01_bad"),
    Program("deadlock_two", ROS, "each transfer locks its source first", DEADLOCK, origin="SCTBench: deadlock01_bad"),
    Program("philosophers_three", ROS, "all take the left fork", DEADLOCK, origin="SCTBench: din_phil3_sat"),
    Program("philosophers_six", ROS, "all six take the left fork", DEADLOCK, origin="SCTBench: din_phil6_sat"),
    Program(
        "circular_buffer",
        ROS,
        "an item is counted before it is written",
        (verdict.ENDED,),
        origin="SCTBench: circular_buffer_bad",
        options=POINTS,
    ),
    Program(
        "shared_stack", ROS, "a stack is read without its lock", RAISED, origin="SCTBench: stack_bad", options=POINTS
    ),
    Program("lazy_sum", ROS, "no task waits for the inspector", RAISED, origin="SCTBench: lazy01_bad"),
    Program("token_ring", ROS, "stations do not wait for the token", origin="SCTBench: token_ring_bad"),
    Program(
        "driver_stop",
        ROS,
        "a request enters a driver that stops",
        RAISED,
        origin="SCTBench: bluetooth_driver_bad",
    ),
    Program("signal_once", ROS, "a signal before the wait for it", STUCK, origin="SCTBench: sync01_bad"),
    Program("file_blocks", ROS, "a block is found free without its lock", RAISED, origin="SCTBench: fsbench_bad"),
    Program("text_buffer", ROS, "a text is shorter than it was", RAISED, origin="SCTBench: stringbuffer-jdk1.4"),
    Program("closed_queue", ROS, "a queue is deleted before its user ends", RAISED, origin="SCTBench: pbzip2-0.9.4"),
    Program("missing_barrier", ROS, "one barrier too few", origin="SCTBench: streamcluster"),
    Program(
        "safe_stack",
        ROS,
        "a stack without locks, of depth 5",
        RAISED + STUCK,  # a cell with two owners, or a chain that ends nowhere; tasks that pop it retry forever
        origin="SCTBench: safestack",
        options=POINTS,
        bound="5 preemptions",
    ),
    Program("work_stealing", ROS, "the tail is moved too late", origin="CHESS: work-stealing queue", options=POINTS),
    Program("promise", ROS, "a promise is kept between check and wait", STUCK),
    Program("state_machine", ROS, "one transition does not check the state again", RAISED),
    Program("account_manager", ROS, "an account is searched, then created", origin="Coyote: AccountManager"),
    Program(
        "blocking_queue", ROS, "one condition for two reasons to wait", STUCK, origin="Coyote: BoundedBuffer; TLA+"
    ),
    Program("leader_election", ROS, "a lost claim makes two leaders", INVARIANT, origin="Coyote: Raft, two leaders"),
    Program("published_early", ROS, "a value is read before the join", origin="shuttle: the first example"),
    Program("lock_free_stack", ROS, "ABA in a stack", RAISED, options=POINTS),
    Program("double_checked", ROS, "an object is seen before it is complete", RAISED),
    Program("peterson", ROS, "the turn is set before the flag", RAISED, origin="TLA+: Peterson", options=POINTS),
    Program(
        "dekker", ROS, "the other flag is read before the own one is set", RAISED, origin="TLA+: Dekker", options=POINTS
    ),
    Program(
        "bakery",
        ROS,
        "a task does not announce that it chooses a number",
        RAISED,
        origin="TLA+: bakery",
        options=POINTS,
    ),
    Program(
        "readers_writer",
        ROS,
        "readers count without a lock",
        RAISED + STUCK,  # a lost count leaves the pen taken
        origin="TLA+: readers and writers",
        options=POINTS,
    ),
    Program("vote", ROS, "a vote is sent before it is stored, then a crash", INVARIANT, origin="TLA+: Raft"),
    Program(
        "two_phase_commit",
        ROS,
        "a decision is sent before it is stored, then a crash",
        INVARIANT,
        origin="TLA+: two-phase commit",
    ),
    Program("shutdown_hook", ROS, "a hook closes what a callback writes to", RAISED),
    Program("service_circle", ROS, "two nodes call each other and hold their locks", RAISED + DEADLOCK, hangs=True),
    Program("torn_command", ROS, "a timer sends half of a command", RAISED, options=POINTS),
    Program("priority_inversion", CFE, "a semaphore that does not inherit", (verdict.DEADLINE,)),
    Program("startup_order", CFE, "settings are sent before the startup sync", EVENT),
    Program("command_counters", CFE, "two tasks count in one line", EVENT, options=POINTS),
    Program("urgent_child", CFE, "a task relies on its priority to run first", EVENT, options="at:any"),
)


@functools.cache
def program_trial(program: Program, folder: Path | None = None, tasks: str = "greenlet") -> Trial:
    """Return the trial that exploring a program makes, in which no task may wait forever.

    Args:
        program: the program.
        folder: folder of a mended form; None for the program's own.
        tasks: kind of tasks.
    """
    own = folder or program.folder
    faults = own / "faults.yaml"
    options = Schedule.parse(program.options)
    plan = RunPlan((str(own),), seconds=SECONDS, tasks=tasks, faults=str(faults) if faults.is_file() else None)
    waits = waits_of(plan, round(SECONDS * NS_PER_S), options.policy())
    return Trial(replace(plan, schedule=options), waits=waits, keep_widths=True)
