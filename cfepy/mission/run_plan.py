"""`RunPlan`: everything that decides a run, apart from what comes from outside it.

A plan is a plain value: a journal, a trial of an exploration on another computer and a failing test all hold one, and
each can say the command that does the same run again. Scripts and faults are imported when a plan has them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from cfepy.attachment import Attachment
from cfepy.console import Console
from cfepy.mission.course import BOOT_S, DEFAULT_S, NODE_S, Course
from cfepy.mission.launch import launch_file, read_launch
from cfepy.mission.mission import Mission
from cfepy.mission.results import Results
from cfepy.mission.single_node import node_script, spec_of_script
from cfepy.mission.spec import MissionSpec, read_mission
from cfepy.rtos.policy import Policy
from cfepy.rtos.schedule import Schedule
from cfepy.trace import Trace

if TYPE_CHECKING:
    from cfepy.mission.script import ScriptRun
    from cfepy.mission.script_verdicts import Outcome

FIFO = "fifo"
RUN, LAUNCH, NODE = "run", "launch", "node"


@dataclass(frozen=True, slots=True)
class RunPlan:
    """What to run, and on what.

    Attributes:
        words: a mission for `run`, a launch file with its arguments for `launch`, a script with its own for `node`:
            what follows these commands of `cfepy`.
        command: one of these three.
        launch_args: of a launch file that is given as a mission, NAME and VALUE.
        seconds: virtual time to run, from the boot, or from the start of the nodes of a launch file and of a single
            node; None is as long as the script takes, or what each command takes by itself.
        seed: of everything random in the mission.
        board: name or file; None takes the mission's own.
        tasks: "thread" or "greenlet".
        schedule: who goes first among equals, as `Schedule.parse` takes it.
        script: path of a mission script; None without one.
        stop_on_failure: the run ends with the first step of the script that fails.
        faults: what goes wrong: path of a fault plan, or seed:N; None for nothing.
        play: path of a bag whose topics are played into the mission; None for nothing.
    """

    words: tuple[str, ...]
    command: str = RUN
    launch_args: tuple[tuple[str, str], ...] = ()
    seconds: float | None = None
    seed: int = 0
    board: str | None = None
    tasks: str = "thread"
    schedule: str = FIFO
    script: str | None = None
    stop_on_failure: bool = False
    faults: str | None = None
    play: str | None = None

    def spec(self) -> MissionSpec:
        """The mission.

        Raises:
            UsageError: there is no such mission, or something in it is wrong.
        """
        if self.command == LAUNCH:
            return read_launch(*launch_file(self.words))
        if self.command == NODE:
            return spec_of_script(*node_script(self.words))
        spec = read_mission(self.words[0], dict(self.launch_args))
        if self.play is None:
            return spec
        from cfepy.mission.ground_node import with_player

        return with_player(spec, self.play)

    @property
    def virtual_s(self) -> float | None:
        """Virtual seconds from the boot; None is as long as the script takes, or 10 s without one."""
        if self.command == RUN:
            return self.seconds
        usual_s = DEFAULT_S if self.command == LAUNCH else NODE_S
        return BOOT_S + (usual_s if self.seconds is None else self.seconds)

    def script_run(self, spec: MissionSpec) -> ScriptRun | None:
        """The script, ready to be attached.

        Raises:
            UsageError: it has a mistake.
        """
        if self.script is None:
            return None
        from cfepy.mission.script import ScriptRun

        return ScriptRun.read(self.script, spec, self.stop_on_failure)

    def fault_injectors(self, spec: MissionSpec) -> list[Attachment]:
        """What lets its faults happen, ready to be attached as the last ones.

        Raises:
            UsageError: there is no such plan, or something in it is wrong.
            CfeError: a mission that needs random faults cannot boot.
        """
        if self.faults is None:
            return []
        from cfepy.mission.fault_plans import injector_of

        return [injector_of(self.faults, spec)]

    def fly(
        self,
        attachments: Sequence[Attachment] = (),
        *,
        spec: MissionSpec | None = None,
        console: Console | None = None,
        policy: Policy | None = None,
        trace: Trace | None = None,
        make_course: Callable[[Mission, float | None, ScriptRun | None], Course] = Course,
    ) -> Flown:
        """Fly it to its end, in virtual time.

        Args:
            attachments: what looks on, beside the script.
            spec: the mission, when somebody has read it already.
            console: takes the lines; None drops them.
            policy: who goes first, in place of `schedule`, such as one that records.
            trace: takes the records.
            make_course: makes the course that it flies.

        Raises:
            UsageError: something in it is wrong.
            CfeError: the mission cannot boot.
        """
        spec = self.spec() if spec is None else spec
        script = self.script_run(spec)
        mission = Mission(
            spec,
            seed=self.seed,
            board=self.board,
            tasks=self.tasks,
            console=Console(quiet=True) if console is None else console,
            policy=Schedule.parse(self.schedule).policy() if policy is None else policy,
            trace=trace,
            attachments=[*(() if script is None else (script,)), *attachments, *self.fault_injectors(spec)],
        )
        with mission:
            course = make_course(mission, self.virtual_s, script)
            course.run()
            course.end()
            mission.shut_down_nodes()
            digest = mission.finish()
        return Flown(mission, Results.of(mission, course.at, digest), course.outcome)

    def command_line(self, **changes: Any) -> str:
        """The command that does this run again.

        Args:
            changes: values of other attributes, such as schedule.
        """
        plan = replace(self, **changes)
        options: list[str] = []
        for name, value in plan.launch_args:
            options += ["--arg", f"{name}:={value}"]
        if plan.seconds is not None:
            options += ["--for", f"{plan.seconds:.12g}"]
        for each in ("seed", "board", "tasks", "schedule", "script", "play", "faults"):
            if getattr(plan, each) != _DEFAULTS[each]:
                options += [f"--{each}", str(getattr(plan, each))]
        if plan.stop_on_failure:
            options.append("--stop-on-failure")
        from shlex import join

        return join(["cfepy", plan.command, *options, *plan.words])

    def to_dict(self) -> dict[str, Any]:
        """Itself as plain values."""
        return asdict(self)

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any]) -> RunPlan:
        """The other way round; lists become tuples again.

        Raises:
            TypeError: an attribute that a plan does not have, or none where it needs one.
        """
        pairs = tuple((str(name), str(value)) for name, value in plain.get("launch_args", ()))
        return cls(**{**plain, "words": tuple(plain["words"]), "launch_args": pairs})


_DEFAULTS = {each.name: each.default for each in fields(RunPlan)}


@dataclass(frozen=True, slots=True)
class Flown:
    """A run that is over.

    Attributes:
        mission: closed; what it left behind can be looked at.
        results: its numbers.
        outcome: of its script, None without one.
    """

    mission: Mission
    results: Results
    outcome: Outcome | None

    @property
    def trace(self) -> str:
        """The digest of the run."""
        return self.results.trace
