"""Fault plans of a mission: from what `--faults` names, and random ones that suit it.

injector = injector_of("seed:7", read_mission("capture"))
with Mission(spec, attachments=[injector]) as mission: ...
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache

from cfepy.console import Console
from cfepy.faults import FaultInjector, FaultPlan, Targets, random_plan, read_plan
from cfepy.faults.random_plan import INTENSITIES, MEDIUM
from cfepy.mission.fault_names import MissionNames
from cfepy.mission.launch import scripts_of
from cfepy.mission.mission import Mission
from cfepy.mission.msg_names import ROS
from cfepy.mission.processor import CORE_APPS
from cfepy.mission.spec import MissionSpec
from cfepy.mission.watch import PacketWatch, Seen
from cfepy.rtos.units import NS_PER_S
from cfepy.status import UsageError

SEED_WORD = "seed:"
LOOK_S = 3.0
KEPT = 8  # missions whose targets are kept
_SEED = re.compile(r"seed:(\d+)(?::(\w+))?")


def plan_of(text: str, spec: MissionSpec) -> FaultPlan:
    """The plan that a command line names.

    Args:
        text: path of a plan; `seed:N` or `seed:N:INTENSITY` for a random one; or the text of a plan itself, which has
            more than one line.
        spec: the mission.

    Raises:
        UsageError: there is no such plan, or something in it is wrong.
        CfeError: the mission cannot boot.
    """
    if text.startswith(SEED_WORD):
        seed, intensity = seed_of(text)
        return random_plan(seed, targets_of(spec), intensity)
    if "\n" in text:
        import yaml

        return FaultPlan.from_dict(yaml.safe_load(text))
    return read_plan(text)


def seed_of(text: str) -> tuple[int, str]:
    """Seed and intensity of `seed:7` or `seed:7:high`.

    Raises:
        UsageError: it is neither.
    """
    found = _SEED.fullmatch(text)
    if found is None or found[2] not in (None, *INTENSITIES):
        names = ", ".join(INTENSITIES)
        raise UsageError(f"is {text!r}; write a file, seed:7, or seed:7:high (one of {names})", field="--faults")
    return int(found[1]), found[2] or MEDIUM


def injector_of(text: str, spec: MissionSpec) -> FaultInjector:
    """What lets the faults happen that a command line names; see `plan_of`."""
    return FaultInjector(plan_of(text, spec))


@dataclass(frozen=True, slots=True)
class Found:
    """What there is in a mission that faults can strike, by name.

    Attributes:
        messages: all names of messages that were sent or subscribed to.
        pipes, tables: names of all of them.
        targets: what a random plan chooses from.
    """

    messages: tuple[str, ...]
    pipes: tuple[str, ...]
    tables: tuple[str, ...]
    targets: Targets


def targets_of(spec: MissionSpec) -> Targets:
    """What random faults strike in a mission; see `look_at`. It is looked at again when its files have changed."""
    return _targets_of(_Version(spec, tuple(_stamps(spec))))


@dataclass(frozen=True, slots=True)
class _Version:
    """A mission as its files are now: path, time stamp and size of each."""

    spec: MissionSpec = field(hash=False)
    stamps: tuple[tuple[str, int, int], ...]


@lru_cache(maxsize=KEPT)
def _targets_of(version: _Version) -> Targets:
    return look_at(version.spec).targets


def _stamps(spec: MissionSpec) -> Iterator[tuple[str, int, int]]:
    """Of the files in its folder, and of those that it is made of and that are somewhere else."""
    named = (spec.script, spec.mission_file, *scripts_of(spec).values())
    inside = spec.folder.iterdir() if spec.folder.is_dir() else ()
    for path in sorted({*inside, *filter(None, named)}):
        if path.is_file():
            stat = path.stat()
            yield str(path), stat.st_mtime_ns, stat.st_size


def look_at(spec: MissionSpec, look_s: float = LOOK_S) -> Found:
    """Find what faults can strike in a mission.

    Args:
        spec: the mission; it runs for some virtual seconds.
        look_s: how many.

    Raises:
        CfeError: it cannot boot.
    """
    counts: dict[str, int] = {}
    called: dict[str, None] = {}
    names = MissionNames()

    def note(seen: Seen) -> None:
        all_names = names.of(seen.packet)
        called.update(dict.fromkeys(all_names))
        route = mission.cfe.sb.routes.get(seen.msg_id)
        if route is not None and route.active:
            counts[all_names[0]] = counts.get(all_names[0], 0) + 1

    with Mission(spec, console=Console(quiet=True), attachments=[PacketWatch(note)]) as mission:
        names.begin(mission)
        mission.run(look_s)
        known = [*called, *names.known()]
        return Found(
            messages=tuple(dict.fromkeys(known)),
            pipes=tuple(sorted(pipe.name for pipe in mission.cfe.sb.pipes)),
            tables=tuple(sorted(table.name for table in mission.cfe.tbl.registry.tables)),
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
