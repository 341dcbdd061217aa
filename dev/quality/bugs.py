"""The planted bugs: small missions with one timing mistake each, and the known facts about each mistake.

A folder in tests/quality/missions has a mission as its authors wrote it. Its `fix.yaml` lists, for each file, the texts
to replace in order to mend it.
"""

from __future__ import annotations

import functools
import shutil
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import yaml

from cfepy.extra.exploration import verdict
from cfepy.extra.exploration.trial import Trial
from cfepy.pilot.plan import RunPlan
from cfepy.schedules import Schedule

MISSIONS = Path(__file__).parents[2] / "tests/quality/missions"
SECONDS = 1.3  # virtual; all missions have finished their work by then
ROS, CFE, BOTH = "ROS", "cFE", "both"


@dataclass(frozen=True, slots=True)
class Bug:
    """A mission with a mistake.

    Attributes:
        name: name of its folder.
        world: whose code has the mistake: ROS nodes', cFE applications', or both together.
        text: the mistake.
        kinds: the kinds of failure that it can cause.
        preemptions: how many remain at most after shrinking; more than 3 only if several tasks must meet.
    """

    name: str
    world: str
    text: str
    kinds: tuple[str, ...] = (verdict.ENDED,)
    preemptions: int = 3

    @property
    def folder(self) -> Path:
        """The mission's folder."""
        return MISSIONS / self.name

    def write_fixed(self, target: Path) -> Path:
        """Write the mission without its mistake.

        Args:
            target: a folder in which the mission's folder is made.

        Raises:
            ValueError: a text to replace does not occur exactly once.
        """
        fixed = target / self.name
        shutil.copytree(self.folder, fixed, ignore=shutil.ignore_patterns("__pycache__", "fix.yaml"))
        changes: dict[str, list[dict[str, Any]]] = yaml.safe_load(
            (self.folder / "fix.yaml").read_text(encoding="utf-8")
        )
        for file, replacements in changes.items():
            text = (fixed / file).read_text(encoding="utf-8")
            for each in replacements:
                if text.count(each["old"]) != 1:
                    raise ValueError(f"{self.name}/fix.yaml: {file} must contain {each['old']!r} exactly once")
                text = text.replace(each["old"], each["new"])
            (fixed / file).write_text(text, encoding="utf-8")
        return fixed


BUGS = (
    Bug("lost_update", ROS, "lost update between two callbacks"),
    Bug("shared_message", ROS, "two callbacks fill one message object", (verdict.INVARIANT,)),
    Bug("lock_order", ROS, "two locks, taken in opposite orders", (verdict.DEADLOCK,)),
    Bug("check_then_act", ROS, "a queue is emptied between check and take", (verdict.RAISED,)),
    Bug("changed_while_iterated", ROS, "a callback adds to a dictionary that is iterated over", (verdict.RAISED,)),
    Bug("late_subscriber", ROS, "a message at boot is lost when the subscriber is late"),
    Bug("reply_before_request", ROS, "the reply arrives before the request is stored"),
    Bug("stale_mode", ROS, "a latched mode and a command overtake each other", (verdict.RESULTS,)),
    Bug("lost_wakeup", ROS, "a hand-made wait clears the event that it then waits for"),
    Bug("double_buffer", ROS, "two buffers are swapped twice while one is read"),
    Bug("clock_jump", ROS, "the clock jumps back in a Rate loop", (verdict.RAISED,)),
    Bug("timer_shutdown", ROS, "a timer closes a file that the loop writes to", (verdict.RAISED,)),
    Bug("double_timer", ROS, "a one-shot timer is started twice"),
    Bug("service_reentrancy", ROS, "a service handler keeps its request in the object"),
    Bug("preempt_race", ROS, "an action is preempted before it has lowered its flag"),
    Bug("parameter_update", ROS, "two nodes increment one parameter"),
    Bug("burst_overflow", ROS, "a short queue overflows under a burst"),
    Bug("starvation", ROS, "a long callback ends before a short one begins"),
    Bug("depth_three", ROS, "three events in one order", (verdict.RAISED,)),
    Bug("frame_counter", CFE, "main task and child task share a sequence counter", (verdict.EVENT,)),
    Bug("mutex_order", CFE, "two mutexes, taken in opposite orders", (verdict.DEADLOCK,)),
    Bug("pipe_deleted", CFE, "a child task receives from a pipe that was deleted", (verdict.DIED,)),
    Bug("half_written_cds", CFE, "the processor is reset between two writes to the CDS", (verdict.EVENT,)),
    Bug("table_kept", CFE, "a table's address is used after its release", (verdict.EVENT,)),
    Bug("torn_snapshot", CFE, "an urgent child task writes what the main task is reading", (verdict.EVENT,)),
    Bug("event_count", CFE, "two applications increment one counter", (verdict.EXPECTATION,)),
    Bug("packet_burst", CFE, "a pipe overflows under a burst", (verdict.EVENT,), preemptions=4),
    Bug("restart_receive", CFE, "a command waits in the pipe of an application that is restarted", (verdict.EVENT,)),
    Bug("late_subscription", BOTH, "an application subscribes to an answer after its request", (verdict.EVENT,)),
    Bug("torn_pair", BOTH, "a node pairs two packets of an application"),
    Bug("acknowledged_early", BOTH, "a node clears the acknowledgement that it has just got"),
)


@functools.cache
def reference_trial(folder: Path, tasks: str = "greenlet") -> Trial:
    """Return the trial that exploring a mission makes. Its results are compared with those of fifo."""
    if tasks != "greenlet":
        trial = reference_trial(folder)
        return replace(trial, plan=replace(trial.plan, tasks=tasks))
    script = folder / "checks.txt"
    plan = RunPlan((str(folder),), seconds=SECONDS, tasks=tasks, script=str(script) if script.is_file() else None)
    trial = Trial(plan, keep_widths=True)
    return trial.against(trial.fly(Schedule()).results)


def by_name(name: str) -> Bug:
    """Return the bug with a name."""
    return next(bug for bug in BUGS if bug.name == name)
