"""What of a fault plan is not in a mission: applications, messages, pipes, tables, files.

Messages, pipes and tables are known when the mission has run for a while; the rest can be told without that.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from difflib import get_close_matches
from fnmatch import fnmatchcase

from cfepy.es.startup_script import CFE_APP, entries
from cfepy.faults import Fault, FaultPlan
from cfepy.faults import kinds as k
from cfepy.faults.kinds import KINDS
from cfepy.faults.names import number_as_name
from cfepy.faults.plan_text import DATAGRAMS
from cfepy.mission.fault_names import apps_of_nodes
from cfepy.mission.fault_plans import Found
from cfepy.mission.msg_names import ROS
from cfepy.mission.processor import CORE_APPS
from cfepy.mission.spec import MissionSpec
from cfepy.mission.watch import HOST
from cfepy.osal import FileSystem
from cfepy.status import OsalError, UsageError


def app_names(spec: MissionSpec) -> list[str]:
    """The applications of a mission, as its startup script has them, and names of nodes that stand for them."""
    own = [entry.name for entry in entries(spec.startup_script) if entry.kind == CFE_APP]
    return [*own, *CORE_APPS, *([ROS] if spec.has_nodes else []), *apps_of_nodes(spec)]


def check_plan(plan: FaultPlan, spec: MissionSpec, found: Found | None = None) -> list[UsageError]:
    """What a plan names that is not in the mission, each with its place.

    Args:
        plan: the plan.
        spec: the mission.
        found: what a run has shown; None checks only what can be told without one.
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
            near = get_close_matches(name, known, 1)
            hint = f"is {near[0]} meant?" if near else f"there are {', '.join(known[:12]) or 'none'}"
            yield f"no {what} is called {name}; {hint}"


def _unknown_file(path: str, spec: MissionSpec) -> Iterator[str]:
    files = FileSystem(spec.folder)
    try:
        if files.find(path) is not None:
            return
        names = [f"/cf/{name}" for name in files.list_dir("/cf")]
    except OsalError as error:
        yield error.text
        return
    near = get_close_matches(path, names, 1)
    yield f"there is no file {path} before the boot" + (f"; is {near[0]} meant?" if near else "")
