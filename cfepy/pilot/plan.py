"""`RunPlan`: everything that decides a run, except its external input.

A plan is a plain value. Every command that flies a mission creates one. A journal has one, and so have an exploration's
trial on another computer and a failing test. A plan can give the command that repeats the run. `cfepy.pilot.pilot`
flies it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cfepy.attachment import Attachment
from cfepy.config.platform import IDENTITIES, MOST_ID
from cfepy.interpreter.host_system import command_line
from cfepy.mission import CppNodesConfig, MissionSpec, cpp_nodes_of, read_mission
from cfepy.nodes import CppNode
from cfepy.pilot.run_loop import DEFAULT_S, LONGEST_S, NODE_S
from cfepy.plugins import Hook
from cfepy.rtos import AUTO, STALL_S
from cfepy.schedules import Schedule
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.mission import NodeBuilder

RUN, LAUNCH, NODE = "run", "launch", "node"


BUILD_NODE: Hook[NodeBuilder] = Hook("build_node")


def built_node(
    node: CppNode, params: Mapping[str, Any], others: Sequence[str], config: CppNodesConfig
) -> tuple[Path, str]:
    """Build a node in C++ for a mission; see `cfepy.mission.NodeBuilder`. The builder is loaded for the first node.

    Raises:
        UsageError: if it cannot be built, or no builder of nodes is installed.
    """
    return BUILD_NODE.need(f"the node {node.full_name} in C++")(node, params, others, config)


def builder(cpp_nodes: str | None = None) -> NodeBuilder:
    """Return the builder of a mission's nodes in C++.

    Args:
        cpp_nodes: settings from the command line, which override the mission; see `cfepy.mission.cpp_nodes_of`.

    Raises:
        UsageError: if the file does not exist or is wrong.
    """
    if cpp_nodes is None:
        return built_node
    said = cpp_nodes_of(cpp_nodes)
    return lambda node, params, others, config: built_node(node, params, others, said)


@dataclass(frozen=True, slots=True)
class RunPlan:
    """A mission to run, and all options that decide the run.

    Attributes:
        words: a mission for `run`, a launch file with its arguments for `launch`, a script with its own for `node`: the
            words after these commands of `cfepy`.
        command: one of these three.
        launch_args: arguments of a launch file given as a mission, NAME and VALUE.
        seconds: virtual time to run, from the boot; None means the length of the script, or the default of each
            command.
        seed: seed of everything random in the mission.
        board: name or file of the board; None takes the mission's own.
        tasks: "thread", "greenlet", or "auto": greenlets if they are installed, otherwise threads.
        schedule: the rule for the next task.
        script: path of a mission script; None without one.
        stop_on_failure: whether the run ends at the first failed step of the script.
        faults: the faults: path of a fault plan, or seed:N; None for none.
        play: path of a bag or an MCAP file to play into the mission; None for none.
        play_options: options as for `rosbag play`: "--rate 2 --start 5 --topics /a /a:=/b"; None plays it as recorded.
        stall: CPU time in s that the run may use while virtual time stands still, because a task does not give up the
            CPU, before it is ended; 0 for no limit. It does not affect the trace of a run that reaches its end.
        races: whether to detect unordered accesses of Python code; it does not affect the trace.
        guard: whether compiled applications get guarded, nonzero memory.
        cpp_nodes: how nodes in C++ are built: a profile, or a YAML file with a section `cpp_nodes:` that overrides the
            mission's; None takes the mission's.
        settings: ROS parameters that override the mission's: full name, and value in YAML.
        spacecraft_id: number of the spacecraft; None takes the mission's own.
        processor_id: number of the processor; None takes the mission's own.
        beside: missions that fly together with this one on one network; "MISSION@0.5" starts later.
    """

    words: tuple[str, ...]
    command: str = RUN
    launch_args: tuple[tuple[str, str], ...] = ()
    seconds: float | None = None
    seed: int = 0
    board: str | None = None
    tasks: str = AUTO
    schedule: Schedule = field(default_factory=Schedule)
    script: str | None = None
    stop_on_failure: bool = False
    faults: str | None = None
    play: str | None = None
    play_options: str | None = None
    stall: float = STALL_S
    guard: bool = False
    races: bool = False
    cpp_nodes: str | None = None
    settings: tuple[tuple[str, str], ...] = ()
    spacecraft_id: int | None = None
    processor_id: int | None = None
    beside: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.schedule, Schedule):
            raise TypeError(f"schedule must be a Schedule, not text; write Schedule.parse({self.schedule!r})")

    def spec(self) -> MissionSpec:
        """Return the mission.

        Raises:
            UsageError: if the mission does not exist or is wrong.
        """
        spec = self._spec()
        if self.guard:
            spec = replace(spec, compiled=replace(spec.compiled, guard=True))
        if self.settings:
            from cfepy.mission import with_settings

            spec = with_settings(spec, self.settings)
        beside = tuple(other.spec() for _, other, _ in self.companions())
        return self.with_played_bag(replace(spec, ids=self._ids(), beside=beside))

    def _ids(self) -> dict[str, int]:
        """Return the identities that the run gives the mission.

        Raises:
            UsageError: if one of them does not fit in 32 bits.
        """
        said = {name: getattr(self, name) for name in IDENTITIES}
        for name, number in said.items():
            if number is not None and not (isinstance(number, int) and 0 <= number <= MOST_ID):
                text = f"must be a number from 0 to {MOST_ID}, not {number!r}"
                raise UsageError(text, field=f"--{name.replace('_', '-')}")
        return {name: number for name, number in said.items() if number is not None}

    def _spec(self) -> MissionSpec:
        build = builder(self.cpp_nodes)
        if self.command == LAUNCH:
            from cfepy.mission import launch_file, read_launch

            return read_launch(*launch_file(self.words), build=build)
        if self.command == NODE:
            from cfepy.mission import spec_of_node

            return spec_of_node(self.words, build)
        return read_mission(self.words[0], dict(self.launch_args), build)

    def with_played_bag(self, spec: MissionSpec) -> MissionSpec:
        """Return a mission that plays the bag of the plan, if there is one.

        Raises:
            UsageError: if the bag does not exist, is damaged, or cannot be played with the options.
        """
        if self.play is None:
            if self.play_options is not None:
                raise UsageError("requires --play FILE", field="--play-options")
            return spec
        from cfepy.ground import with_player

        return with_player(spec, self.play, self.play_options or "")

    def companions(self) -> list[tuple[str, RunPlan, int]]:
        """Return the missions that fly together with this one: the user's text, the plan, the virtual ns at which it
        starts.

        They take only the seed, the tasks and the stall limit from this plan.

        Raises:
            UsageError: if a mission would fly together with itself.
        """
        found = []
        for text in self.beside:
            from cfepy.pilot.peers import boot_of

            mission, begins_ns = boot_of(text)
            if mission in self.words:
                what = "use another startup script, and a mission file with another processor_id"
                raise UsageError(f"{text} is already the processor of this mission; {what}", field="--with")
            plan = RunPlan((mission,), seconds=LONGEST_S, seed=self.seed, tasks=self.tasks, stall=self.stall)
            found.append((text, plan, begins_ns))
        return found

    def attachments(self) -> list[Attachment]:
        """Return the attachments of the plan itself: none, except for a plan whose files were moved."""
        return []

    @property
    def virtual_s(self) -> float | None:
        """The virtual seconds from the boot; None means the length of the script, or 10 s without one."""
        if self.command == RUN:
            return self.seconds
        if self.seconds is None and self.script is not None:
            return None
        usual_s = DEFAULT_S if self.command == LAUNCH else NODE_S
        return usual_s if self.seconds is None else self.seconds

    def command_line(self, **changes: Any) -> str:
        """Return the command that repeats this run.

        Args:
            changes: values of other attributes, such as schedule.
        """
        plan = replace(self, **changes)
        options: list[str] = []
        for name, value in plan.launch_args:
            options += ["--arg", f"{name}:={value}"]
        for name, value in plan.settings:
            options += ["--set", f"{name}={value}"]
        for other in plan.beside:
            options += ["--with", other]
        if plan.seconds is not None:
            options += ["--for", f"{plan.seconds:.12g}"]
        for each in ("seed", "board", "tasks", "schedule", "script", "play", "faults", "cpp_nodes", *IDENTITIES):
            if getattr(plan, each) != getattr(_USUAL, each):
                options += [f"--{each.replace('_', '-')}", str(getattr(plan, each))]
        if plan.play_options is not None:
            options.append(f"--play-options={plan.play_options}")  # it may begin with a hyphen
        if plan.stall != _USUAL.stall:
            options += ["--stall", f"{plan.stall:g}"]
        for each in ("stop_on_failure", "guard", "races"):
            if getattr(plan, each):
                options.append(f"--{each.replace('_', '-')}")
        return command_line(["cfepy", plan.command, *options, *plan.words])

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as plain values, for a file or another process."""
        return {each.name: getattr(self, each.name) for each in fields(self)} | {"schedule": self.schedule.text()}

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any]) -> RunPlan:
        """Return a plan from the values of `to_dict`; lists become tuples again.

        Raises:
            TypeError: for an unknown or missing attribute.
            UsageError: if its schedule is invalid.
        """
        known = {each.name for each in fields(cls)}
        unknown = sorted(set(plain) - known)
        if unknown:
            raise TypeError(f"unknown field of a run plan: {', '.join(unknown)}")
        return cls(
            **{
                **plain,
                "words": tuple(plain["words"]),
                "launch_args": _pairs(plain.get("launch_args", ())),
                "settings": _pairs(plain.get("settings", ())),
                "beside": tuple(plain.get("beside", ())),
                "schedule": Schedule.parse(plain.get("schedule", Schedule().text())),
            }
        )


def _pairs(plain: Any) -> tuple[tuple[str, str], ...]:
    return tuple((str(name), str(value)) for name, value in plain)


_USUAL = RunPlan(())
