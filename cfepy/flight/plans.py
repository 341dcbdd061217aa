"""What a program says of a run, as a `RunPlan`: a mission, and what decides the run, by name."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, TypedDict

from cfepy.attachment import Attachment
from cfepy.mission import cpp_nodes_source
from cfepy.pilot import NODE, RUN, RunPlan
from cfepy.reading.suggestions import did_you_mean
from cfepy.schedules import Schedule

if TYPE_CHECKING:
    from cfepy.faults import FaultPlan

MissionWords = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]
"""A mission: the name of one that cfepy brings along, a folder, a startup script, a launch file, or a node's .py file;
in a sequence with what follows it on the command line, such as `("talker.py", "_rate:=5")`."""

Faults: TypeAlias = "str | os.PathLike[str] | Mapping[str, Any] | FaultPlan"
"""What goes wrong: a plan's file, "seed:N", a plan, or a dictionary of its form."""

SEED = "seed:"
_NODE_FILE = ".py"


class MissionOptions(TypedDict, total=False):
    """What decides how a mission flies. What is not given is as usual.

    Attributes:
        seed: of everything random.
        board: name of a board, or its file.
        tasks: "thread", "greenlet", or "auto", which is greenlets where they are installed, else threads.
        schedule: which task goes first, such as "random:7".
        faults: what goes wrong: a plan's file, "seed:N", a `cfepy.faults.FaultPlan` or a dictionary of that form.
        play: a bag or an MCAP file that is played into the mission.
        play_options: how, as `rosbag play` is told, such as "--rate 2 --topics /a /a:=/b".
        args: of a launch file.
        stall: seconds of wall time after which a task that does not give up the CPU ends the run; 0 waits for ever.
        races: accesses of Python code that nothing orders are looked for, and told with what went wrong.
        guard: compiled applications fault where they write past a buffer, or use one that was freed.
        cpp_nodes: how nodes in C++ of launch files are built: "host", "pool", "strict", or a mission whose
            file has the section `cpp_nodes:`, or that file.
        settings: ROS parameters by their full names, in place of what the mission says of them.
        spacecraft_id: number of the spacecraft, in place of the mission's own.
        processor_id: number of the processor, in place of the mission's own.
        beside: missions that fly beside it, on one network with it; "MISSION@0.5" begins half a second later.
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
    """What decides a run: `MissionOptions`, and how long it goes on.

    Attributes:
        seconds: virtual time to run, from the boot; of a node, from its start.
        script: file of commands and expectations.
        stop_on_failure: the run ends with the first step of the script that fails.
    """

    seconds: float | None
    script: str | os.PathLike[str] | None
    stop_on_failure: bool


def plan_of(mission: MissionWords, options: Mapping[str, Any], known: Iterable[str]) -> RunPlan:
    """The plan of a run.

    Args:
        mission: what is flown.
        options: of the run, by name.
        known: the names that there are.

    Raises:
        TypeError: an option that there is not.
        UsageError: the schedule is none, or what is said of nodes in C++ is nowhere.
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
    return RunPlan(words, NODE if words[0].endswith(_NODE_FILE) else RUN, **said)


def _words(mission: MissionWords) -> tuple[str, ...]:
    words = (mission,) if isinstance(mission, str | os.PathLike) else tuple(mission)
    return tuple(os.fspath(word) for word in words)


def schedule_of(given: str | Schedule) -> Schedule:
    """A schedule, from its text or as it is.

    Raises:
        UsageError: the text is none.
    """
    return given if isinstance(given, Schedule) else Schedule.parse(given)


def fault_text(faults: Faults | None) -> str | None:
    """What a plan says of the faults; None for those that the program alone has, see `fault_attachments`."""
    return os.fspath(faults) if isinstance(faults, str | os.PathLike) else None


def fault_attachments(faults: Faults | None) -> list[Attachment]:
    """What lets faults happen that the program alone has.

    Raises:
        UsageError: something in the plan is wrong.
    """
    if faults is None or isinstance(faults, str | os.PathLike):
        return []
    from cfepy.faults import FaultInjector, FaultPlan

    return [FaultInjector(FaultPlan.from_dict(faults) if isinstance(faults, Mapping) else faults)]
