"""Possible targets of faults in a mission, found by a short flight, and random plans that choose from them.

The same seed and targets always give the same plan: every choice uses the plan's own stream of random numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import lru_cache
from random import Random
from typing import Any

from cfepy.faults.fault_names import MissionNames
from cfepy.faults.fault_plan import Fault, FaultPlan
from cfepy.faults.timing import When
from cfepy.ground import ROS
from cfepy.mission import CORE_APPS, Mission, MissionSpec, PacketWatch, Seen
from cfepy.units import NS_PER_MS, NS_PER_S
from cfepy.writing.console import Console

LOW, MEDIUM, HIGH = "low", "medium", "high"
INTENSITIES = {LOW: 2, MEDIUM: 5, HIGH: 12}
"""Number of faults in a plan."""
FREQUENT = 20  # number of messages in the survey from which on faults use a probability
LOOK_S = 3.0
KEPT = 8  # number of missions whose targets are cached


@dataclass(frozen=True, slots=True)
class Targets:
    """Possible targets of faults in a mission.

    Attributes:
        apps: the mission's own applications.
        messages: names of messages that have a receiver, with how many of each were sent.
        pipes: pipes of the mission's own applications.
        tables: full names of tables.
        files: paths of table files.
        begin_ns: start of the virtual time in which faults may happen, in ns.
        end_ns: end of that time, in ns.
    """

    apps: tuple[str, ...] = ()
    messages: tuple[tuple[str, int], ...] = ()
    pipes: tuple[str, ...] = ()
    tables: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    begin_ns: int = NS_PER_S
    end_ns: int = 10 * NS_PER_S


def random_plan(seed: int, targets: Targets, intensity: str = MEDIUM) -> FaultPlan:
    """Return a plan for a mission, the same for the same arguments.

    Args:
        seed: seed of the choices.
        targets: possible targets.
        intensity: a key of `INTENSITIES`.
    """
    maker = _Maker(Random(f"fault plan {seed}"), targets)
    faults: list[Fault] = []
    for number in range(INTENSITIES[intensity]):
        fault = maker.fault()
        faults.append(replace(fault, name=f"{fault.kind}-{number + 1}"))
    return FaultPlan(tuple(faults))


class _Maker:
    """Creates faults one by one. Messages come first, because most faults in flight concern them."""

    def __init__(self, random: Random, targets: Targets) -> None:
        self._random = random
        self._targets = targets
        choices: list[tuple[int, object, Callable[[], Fault]]] = [
            (10, targets.messages, self._message),
            (5, targets.apps, self._app),
            (2, targets.pipes, self._pipe),
            (2, True, self._clock),
            (2, True, self._signal),
            (1, targets.tables, self._table),
            (1, targets.files, self._file),
            (2, targets.apps, self._call),
            (1, True, self._memory),
            (1, True, self._reset),
        ]
        self._makers = [make for weight, there_are, make in choices if there_are for _ in range(weight)]

    def fault(self) -> Fault:
        """Return the next fault, without a name."""
        return self._random.choice(self._makers)()

    def _instant(self) -> int:
        begin, end = self._targets.begin_ns // NS_PER_MS, self._targets.end_ns // NS_PER_MS
        return self._random.randint(begin, max(begin, end - 1)) * NS_PER_MS

    def _once(self) -> When:
        return When(at_ns=(self._instant(),))

    def _window(self) -> When:
        first, second = sorted((self._instant(), self._instant()))
        return When(after_ns=first, until_ns=second + NS_PER_S)

    def _message(self) -> Fault:
        name, count = self._random.choice(self._targets.messages)
        kind = self._random.choice(("drop", "drop", "duplicate", "delay", "reorder", "corrupt"))
        options: dict[str, Any] = {}
        if kind == "delay":
            by_ns = self._random.choice((1, 10, 50, 200, 1000)) * NS_PER_MS
            options["by"] = (by_ns, by_ns)
        elif kind == "corrupt":
            options["bits"] = self._random.randint(1, 8)
        elif kind == "reorder":
            options["past"] = self._random.randint(1, 3)
        return Fault(kind, (name,), when=self._occasions(count), options=options)

    def _occasions(self, count: int) -> When:
        """Return options for several messages if they are frequent, or for a single one."""
        if count < FREQUENT:
            return When(after_ns=self._targets.begin_ns, number=(self._random.randint(1, max(1, count)),))
        return replace(self._window(), probability=self._random.choice((0.01, 0.05, 0.2, 1.0)))

    def _app(self) -> Fault:
        app = self._random.choice(self._targets.apps)
        kind = self._random.choice(("crash", "hang", "hang", "slow", "slow", "stop", "restart"))
        if kind == "slow":
            return Fault(
                kind, (app,), when=self._window(), options={"extra": self._random.choice((1, 5, 20)) * NS_PER_MS}
            )
        lasting = {"for": self._random.choice((100, 500, 2000)) * NS_PER_MS} if kind == "hang" else {}
        return Fault(kind, (app,), when=self._once(), options=lasting)

    def _pipe(self) -> Fault:
        lasting = {"for": self._random.choice((50, 500, 2000)) * NS_PER_MS}
        return Fault("fill", (self._random.choice(self._targets.pipes),), when=self._once(), options=lasting)

    def _clock(self) -> Fault:
        if self._random.random() < 0.3:
            ppm = self._random.choice((-500, -50, 50, 500))
            return Fault("drift_clock", (f"{ppm}",), when=self._window())
        seconds = self._random.choice((-30, -2, -0.1, 0.1, 2, 3600))
        return Fault("jump_clock", (f"{seconds:.12g}",), when=self._once())

    def _signal(self) -> Fault:
        return Fault("lose_1hz", (self._random.choice(("1hz", "tone")),), when=self._window())

    def _table(self) -> Fault:
        return self._bits("corrupt_table", self._random.choice(self._targets.tables), self._once())

    def _file(self) -> Fault:
        return self._bits("corrupt_file", self._random.choice(self._targets.files), self._once())

    def _bits(self, kind: str, target: str, when: When) -> Fault:
        return Fault(kind, (target,), when=when, options={"bits": self._random.randint(1, 8)})

    def _call(self) -> Fault:
        call = self._random.choice(("os.queue_put", "os.write", "sb.transmit_msg", "es.get_pool_buf", "os.open_create"))
        options = {"app": self._random.choice(self._targets.apps)}
        if call == "os.queue_put" and self._targets.pipes:  # applications rarely have queues, but all send messages
            options = {"object": self._random.choice(self._targets.pipes)}
        return Fault("fail", (call,), when=replace(self._window(), count=self._random.randint(1, 3)), options=options)

    def _memory(self) -> Fault:
        area = self._random.choice(("cds", "eeprom"))
        return Fault("corrupt_memory", (area,), when=self._once())

    def _reset(self) -> Fault:
        how = self._random.choice(("processor", "processor", "poweron", "exception", "watchdog"))
        return Fault("reset", (how,), when=self._once())


@dataclass(frozen=True, slots=True)
class Found:
    """Names in a mission that faults can name as their target.

    Attributes:
        messages: all names of messages that were sent or subscribed to.
        pipes: names of all pipes.
        tables: full names of all tables.
        tasks: names of tasks that sent a message, or existed at the end.
        targets: choices for a random plan.
    """

    messages: tuple[str, ...]
    pipes: tuple[str, ...]
    tables: tuple[str, ...]
    tasks: tuple[str, ...]
    targets: Targets


def targets_of(spec: MissionSpec) -> Targets:
    """Return possible targets of random faults in a mission; see `look_at`. They are found again if its files have
    changed.
    """
    return _targets_of(_Version(spec, tuple(_stamps(spec))))


@dataclass(frozen=True, slots=True)
class _Version:
    """A mission's current files: path, time stamp and size of each."""

    spec: MissionSpec = field(hash=False)
    stamps: tuple[tuple[str, int, int], ...]


@lru_cache(maxsize=KEPT)
def _targets_of(version: _Version) -> Targets:
    return look_at(version.spec).targets


def _stamps(spec: MissionSpec) -> Iterator[tuple[str, int, int]]:
    """Yield path, time stamp in ns and size in bytes of the files in its folder, and of its files elsewhere."""
    named = (spec.script, spec.mission_file, *spec.scripts.values())
    inside = spec.folder.iterdir() if spec.folder.is_dir() else ()
    for path in sorted({*inside, *filter(None, named)}):
        if path.is_file():
            stat = path.stat()
            yield str(path), stat.st_mtime_ns, stat.st_size


def look_at(spec: MissionSpec, look_s: float = LOOK_S) -> Found:
    """Find possible targets of faults in a mission.

    Args:
        spec: the mission; it runs for some virtual seconds.
        look_s: number of seconds.

    Raises:
        CfeError: if it cannot boot.
    """
    counts: dict[str, int] = {}
    called: dict[str, None] = {}
    tasks: dict[str, None] = {}
    names = MissionNames()

    def note(seen: Seen) -> None:
        all_names = names.of(seen.packet)
        called.update(dict.fromkeys(all_names))
        tasks[mission.kernel.current.name] = None
        route = mission.cfe.sb.routes.get(seen.msg_id)
        if route is not None and route.active:
            counts[all_names[0]] = counts.get(all_names[0], 0) + 1

    with Mission(spec, console=Console(quiet=True), attachments=[PacketWatch(note)]) as mission:
        names.begin(mission)
        mission.run_for(look_s)
        known = [*called, *names.known()]
        return Found(
            messages=tuple(dict.fromkeys(known)),
            pipes=tuple(sorted(pipe.name for pipe in mission.cfe.sb.pipes)),
            tables=tuple(sorted(table.name for table in mission.cfe.tbl.registry.tables)),
            tasks=tuple(dict.fromkeys([*tasks, *(task.name for task in mission.kernel.tasks)])),
            targets=_targets(mission, counts),
        )


def _targets(mission: Mission, messages: dict[str, int]) -> Targets:
    own = [app.name for app in mission.cfe.es.apps if app.name not in (*CORE_APPS, ROS)]
    tables = [table.name for table in mission.cfe.tbl.registry.tables]
    begin_ns = (mission.booted or 0) + NS_PER_S // 2
    return Targets(
        apps=tuple(own),
        messages=tuple(sorted(messages.items())),
        pipes=tuple(sorted(pipe.name for pipe in mission.cfe.sb.pipes if pipe.app_name in own)),
        tables=tuple(table for table in sorted(tables) if table.partition(".")[0] in own),
        files=tuple(f"/cf/{name}" for name in mission.files.list_dir("/cf") if name.endswith(".tbl")),
        begin_ns=begin_ns,
        end_ns=begin_ns + 9 * NS_PER_S,
    )
