"""The options of a program for a run, converted to a `RunPlan`: a mission, and all options that decide the run, by
name.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, TypedDict

from cfepy.attachment import Attachment
from cfepy.mission import cpp_nodes_source, is_node
from cfepy.pilot import NODE, RUN, RunPlan
from cfepy.reading.suggestions import did_you_mean
from cfepy.schedules import Schedule

if TYPE_CHECKING:
    from cfepy.faults import FaultPlan

MissionWords = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]
"""A mission: the name of one included in cfepy, a folder, a startup script, a launch file, or a node's .py file. A
sequence also has the words after it on the command line, such as `("talker.py", "_rate:=5")`.
"""

Faults: TypeAlias = "str | os.PathLike[str] | Mapping[str, Any] | FaultPlan"
"""The faults of a run: a plan's file, "seed:N", a plan, or a dictionary of its form."""

SEED = "seed:"
_NODE_FILE = ".py"


class MissionOptions(TypedDict, total=False):
    """Options that decide how a mission flies. Missing options have their defaults.

    Attributes:
        seed: seed of everything random.
        board: name of a board, or its file.
        tasks: "thread", "greenlet", or "auto": greenlets if they are installed, otherwise threads.
        schedule: the rule for the next task, such as "random:7".
        faults: the faults to inject: a plan's file, "seed:N", a `cfepy.faults.FaultPlan` or a dictionary of that form.
        play: a bag or an MCAP file to play into the mission.
        play_options: options as for `rosbag play`, such as "--rate 2 --topics /a /a:=/b".
        args: arguments of a launch file.
        stall: CPU time in s after which the run is ended if a task does not give up the CPU; 0 for no limit.
        races: whether to detect unordered accesses of Python code and report them as problems.
        guard: whether compiled applications fault if they write past a buffer or use a freed one.
        cpp_nodes: how nodes in C++ of launch files are built: "host", "pool", "strict", or a mission whose file has the
            section `cpp_nodes:`, or the file itself.
        settings: ROS parameters by their full names, which override the mission's.
        spacecraft_id: number of the spacecraft, which overrides the mission's.
        processor_id: number of the processor, which overrides the mission's.
        beside: missions that fly together with it on one network; "MISSION@0.5" starts half a second later.
    """

    seed: int
    board: str | os.PathLike[str] | None
    tasks: str
    schedule: str | Schedule
    faults: Faults | None
    play: str | os.PathLike[str] | None
    play_options: str | None
    args: Mapping[str, object] | None
    stall: float
    guard: bool
    races: bool
    cpp_nodes: str | os.PathLike[str] | None
    settings: Mapping[str, object] | None
    spacecraft_id: int | None
    processor_id: int | None
    beside: Sequence[str]


class RunOptions(MissionOptions, total=False):
    """Options that decide a run: `MissionOptions`, and its length.

    Attributes:
        seconds: virtual time to run in s, from the boot, or from its start for a single node.
        script: file with commands and expectations.
        stop_on_failure: whether the run ends at the first failed step of the script.
    """

    seconds: float | None
    script: str | os.PathLike[str] | None
    stop_on_failure: bool


def plan_of(mission: MissionWords, options: Mapping[str, Any], known: Iterable[str]) -> RunPlan:
    """Return the plan of a run.

    Args:
        mission: the mission.
        options: options of the run, by name.
        known: the valid names.

    Raises:
        TypeError: for an unknown option.
        UsageError: if the schedule or the source of the settings for nodes in C++ is invalid.
    """
    names = sorted(known)
    for name in options:
        if name not in names:
            raise TypeError(f"unknown option {name!r}{did_you_mean(name, names, before='; ')}")
    words = _words(mission)
    said = {name: value for name, value in options.items() if value is not None}
    for name in ("board", "script", "play"):
        if name in said:
            said[name] = os.fspath(said[name])
    if "schedule" in said:
        said["schedule"] = schedule_of(said["schedule"])
    if "cpp_nodes" in said:
        said["cpp_nodes"] = cpp_nodes_source(os.fspath(said["cpp_nodes"]))
    if "faults" in said:
        said["faults"] = fault_text(said["faults"])
    said["settings"] = tuple((name, json.dumps(value)) for name, value in said.pop("settings", {}).items())
    said["beside"] = tuple(said.pop("beside", ()))
    said["launch_args"] = tuple((name, str(value)) for name, value in said.pop("args", {}).items())
    return RunPlan(words, command_for(words[0]), **said)


def command_for(mission: str) -> str:
    """Return the command, as for `RunPlan`, that flies a mission or a node's program."""
    return NODE if mission.endswith(_NODE_FILE) or is_node(mission) else RUN


def _words(mission: MissionWords) -> tuple[str, ...]:
    words = (mission,) if isinstance(mission, str | os.PathLike) else tuple(mission)
    return tuple(os.fspath(word) for word in words)


def schedule_of(given: str | Schedule) -> Schedule:
    """Return a schedule, from its text or unchanged.

    Raises:
        UsageError: if the text is not a schedule.
    """
    return given if isinstance(given, Schedule) else Schedule.parse(given)


def fault_text(faults: Faults | None) -> str | None:
    """Return the faults for a plan as text; None for faults that only the program has, see `fault_attachments`."""
    return os.fspath(faults) if isinstance(faults, str | os.PathLike) else None


def fault_attachments(faults: Faults | None) -> list[Attachment]:
    """Return the attachments for faults that only the program has.

    Raises:
        UsageError: if the fault plan is wrong.
    """
    if faults is None or isinstance(faults, str | os.PathLike):
        return []
    from cfepy.faults import FaultInjector, FaultPlan

    return [FaultInjector(FaultPlan.from_dict(faults) if isinstance(faults, Mapping) else faults)]
