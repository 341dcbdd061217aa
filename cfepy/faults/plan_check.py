"""The check of a fault plan for a mission: `prepare` returns its injector, and names in the plan that the mission
lacks.

    prepared = prepare("seed:7", read_mission("capture"))
    with Mission(spec, attachments=[prepared.injector]) as mission: ...

A plan is a file, a seed, or its own text. Applications and files of a plan can be checked without a flight; messages,
pipes and tables are known only after the mission has run for a while.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from cfepy.es import CFE_APP
from cfepy.faults import kinds as k
from cfepy.faults.fault_names import apps_of_nodes, number_as_name
from cfepy.faults.fault_plan import DATAGRAMS, Fault, FaultPlan, read_plan
from cfepy.faults.injector import FaultInjector
from cfepy.faults.kinds import KINDS
from cfepy.faults.targets import INTENSITIES, MEDIUM, Found, look_at, random_plan, targets_of
from cfepy.ground import ROS
from cfepy.mission import CORE_APPS, HOST, MissionSpec
from cfepy.osal import FileSystem
from cfepy.reading.plain_yaml import plain_yaml
from cfepy.reading.suggestions import did_you_mean, expected
from cfepy.status import OsalError, UsageError

SEED_WORD = "seed:"
_SEED = re.compile(r"seed:(\d+)(?::(\w+))?")


@dataclass(frozen=True, slots=True)
class Prepared:
    """A plan that is ready for one flight of a mission.

    Attributes:
        injector: injects its faults; attach it last.
        problems: names in the plan that the mission lacks, each with its place. Such a fault never happens.
    """

    injector: FaultInjector
    problems: tuple[UsageError, ...]


def prepare(text: str, spec: MissionSpec, *, flies: bool = False) -> Prepared:
    """Return the plan named on a command line, ready and checked; used by every command that flies with faults.

    Args:
        text: see `plan_of`.
        spec: the mission.
        flies: whether the mission is flown for some virtual seconds, to find messages, pipes and tables that it lacks;
            otherwise only applications and files are checked.

    Raises:
        UsageError: if there is no such plan, or it has a mistake.
        CfeError: if the mission cannot boot.
    """
    plan = plan_of(text, spec)
    return Prepared(FaultInjector(plan), tuple(check_plan(plan, spec, look_at(spec) if flies else None)))


def plan_of(text: str, spec: MissionSpec) -> FaultPlan:
    """Return the plan named on a command line.

    Args:
        text: path of a plan; `seed:N` or `seed:N:INTENSITY` for a random one; or the text of a plan itself, which has
            more than one line.
        spec: the mission.

    Raises:
        UsageError: if there is no such plan, or it has a mistake.
        CfeError: if the mission cannot boot.
    """
    if text.startswith(SEED_WORD):
        seed, intensity = seed_of(text)
        return random_plan(seed, targets_of(spec), intensity)
    if "\n" in text:
        return FaultPlan.from_dict(plain_yaml(text))
    return read_plan(text)


def seed_of(text: str) -> tuple[int, str]:
    """Return seed and intensity of `seed:7` or `seed:7:high`.

    Raises:
        UsageError: if the text has another form.
    """
    found = _SEED.fullmatch(text)
    if found is None or found[2] not in (None, *INTENSITIES):
        intensity = (
            "" if found is None else f"; {expected(found[2], INTENSITIES, subject='intensities are', last='and')}"
        )
        text = f"invalid value {text!r}; expected a file, seed:7, or seed:7:high{intensity}"
        raise UsageError(text, field="--faults")
    return int(found[1]), found[2] or MEDIUM


def app_names(spec: MissionSpec) -> list[str]:
    """Return the applications of a mission in its startup script, and the names of their nodes."""
    own = [entry.name for entry in spec.entries if entry.kind == CFE_APP]
    return [*own, *CORE_APPS, *([ROS] if spec.has_nodes else []), *apps_of_nodes(spec)]


def check_plan(plan: FaultPlan, spec: MissionSpec, found: Found | None = None) -> list[UsageError]:
    """Return the names in a plan that the mission lacks, each with its place.

    Args:
        plan: the plan.
        spec: the mission.
        found: findings of a run; None checks only names that are known without a run.
    """
    return [
        UsageError(text, file=plan.file or None, line=fault.line or None, field=fault.name)
        for fault in plan.faults
        for text in _problems(fault, spec, found)
    ]


def _problems(fault: Fault, spec: MissionSpec, found: Found | None) -> Iterator[str]:
    apps = app_names(spec)
    strikes = KINDS[fault.kind].strikes
    if strikes == k.APP:
        yield from _unknown("application", fault.target, apps)
    yield from _unknown("application", [fault.options[o] for o in ("from", "app") if o in fault.options], [*apps, HOST])
    if strikes == k.FILE and fault.when.at_ns in ((), (0,)):
        yield from _unknown_file(fault.target[0], spec)
    if found is None:
        return
    if "to" in fault.options:
        yield from _unknown("application or pipe", [fault.options["to"]], [*apps, *found.pipes])
    yield from _unknown("task", [fault.options["task"]] if "task" in fault.options else (), found.tasks)
    if strikes == k.PIPE:
        yield from _unknown("pipe", fault.target, found.pipes)
    if strikes == k.TABLE:
        yield from _unknown("table", fault.target, found.tables)
    messages = fault.target if strikes == k.MESSAGE else ()
    wanted = [*messages, *([fault.options["message"]] if "message" in fault.options else [])]
    yield from _unknown("message", [each for each in wanted if not each.startswith(DATAGRAMS)], found.messages)


def _unknown(what: str, names: Iterable[str], known: Sequence[str]) -> Iterator[str]:
    for name in names:
        if not any(fnmatchcase(each, number_as_name(name)) for each in known):
            yield f"unknown {what} {name}; {expected(name, known, subject='known are', last='and')}"


def _unknown_file(path: str, spec: MissionSpec) -> Iterator[str]:
    files = FileSystem(spec.folder)
    try:
        if files.find(path) is not None:
            return
        names = [f"/cf/{name}" for name in files.list_dir("/cf")]
    except OsalError as error:
        yield error.text
        return
    hint = did_you_mean(path, names, "name a file of the mission, such as /cf/hk_cpy_tbl.tbl")
    yield f"the file {path} does not exist before the boot; {hint}"
