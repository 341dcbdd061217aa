"""The problems of a run: their only definition, for every command, report, test and search.

`problems_of` returns a line for each problem, as reports and commands show it, with its failures, as searches compare
them. A run without problems went well. Other notes for the user, such as a fault that never happened, are not problems.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from cfepy.es import APP_ERROR, CFE_APP, CFE_LIB, BadLine, StartupEntry, parse
from cfepy.evs import CRITICAL
from cfepy.mission import CORE_APPS, EndlessWait, EndlessWaits, FailedCode, Mission, RaisedError, WaitsAtEnds
from cfepy.monitors import DeadlineRecord, InvariantRecords
from cfepy.pilot.failure import LEAVES_OTHERS_WAITING, Failure, FailureKind, without_values
from cfepy.rtos import InjectedCrash
from cfepy.units import NS_PER_S, instant_text
from cfepy.writing.escapes import visible_line

if TYPE_CHECKING:
    from cfepy.script import Outcome

LONG_WAIT_NS = 2 * NS_PER_S
"""A table's load that waits for a held address is a problem from here on; applications use tables for shorter times."""
_COLOURS = re.compile(r"\x1b\[[\d;]*m")
_COLLECTION = re.compile(r"\[.*\]|\{.*\}|\((?!node ).*\)")  # of values, whose number may differ
_LONGEST_WORDS = 200  # characters of a program's last words
BESIDE = "beside"
"""The table of the record with a row for each mission that flew together with it."""


class RunProblem(NamedTuple):
    """A problem of a run.

    Attributes:
        text: one or several lines for display.
        at_ns: virtual time in ns; None if it has no time.
        failures: its failures for searches, one for each cause.
        is_step: whether it is a failed step of the script.
    """

    text: str
    at_ns: int | None
    failures: tuple[Failure, ...] = ()
    is_step: bool = False


def problems_of(mission: Mission, endless: EndlessWaits, outcome: Outcome | None = None) -> list[RunProblem]:
    """Return the problems of a run so far.

    Args:
        mission: the mission.
        endless: its waits that never end, now or at the end of the run's time.
        outcome: result of the run's script.
    """
    found = [*_startup(mission), *_stall(mission), *_abortion(mission), *_deaths(mission), *_bad_ends(mission)]
    found += _events(mission, outcome)
    found += [*_resets(mission), *_invariants(mission), *_deadlines(mission), *_of_compiled_code(mission)]
    found += [*_leaks(mission), *_waiting_loads(mission)]
    found += [*map(_circle, endless.circles), *_printed(mission)]
    found += _alone(endless.alone, _failures(found))
    return [*found, *_missed_steps(outcome), *_beside(mission)]


def is_reported(problem: RunProblem) -> bool:
    """Return whether a problem is only an ERROR or CRITICAL event of an application."""
    return bool(problem.failures) and all(each.kind is FailureKind.EVENT for each in problem.failures)


def problems_so_far(mission: Mission) -> list[RunProblem]:
    """Return the problems with their own time that can be found while the mission runs."""
    found = [*_deaths(mission), *_events(mission, None), *_printed(mission), *_invariants(mission)]
    return [*found, *_of_compiled_code(mission), *_leaks(mission)]


def failures_of(problems: Iterable[RunProblem]) -> list[Failure]:
    """Return the failures of problems, sorted by time; those about the end come last."""
    found = _failures(problems)
    timed = [each for each in found if each.at_ns is not None]
    return [*sorted(timed, key=lambda each: each.at_ns or 0), *(each for each in found if each.at_ns is None)]


def _failures(problems: Iterable[RunProblem]) -> list[Failure]:
    return [failure for problem in problems for failure in problem.failures]


# -- the startup script ------------------------------------------------------------------------------------------------


def startup_problems(mission: Mission) -> list[str]:
    """Return the lines of the startup script that could not be started; empty until the script was read to its end."""
    if mission.booted is None:
        return []
    script, es = mission.spec.script, mission.cfe.es
    bad = (line for line in parse(mission.spec.startup_script) if isinstance(line, BadLine))
    libraries = [entry for entry in mission.spec.entries if entry.kind == CFE_LIB]
    loaded = {library.name for library in es.libs}
    if mission.processor.booted is None:  # the processor was reset, and has not reached them again
        loaded.update(each.name for each in libraries)
    return [
        *(f"{script}:{line.line}: {line.explanation}" for line in bad),
        *(f"library {each.name} could not be loaded" for each in libraries if each.name not in loaded),
        *(f"{each.name} could not be started" for each in not_started(mission)),
    ]


def not_started(mission: Mission) -> list[StartupEntry]:
    """Return the applications of the startup script that have never run, each name once."""
    entries = {each.name: each for each in mission.spec.entries if each.kind == CFE_APP}
    return [each for name, each in entries.items() if name not in mission.cfe.es.history]


def _startup(mission: Mission) -> Iterator[RunProblem]:
    for text in startup_problems(mission):
        yield RunProblem(text, None, (Failure(FailureKind.PROBLEM, "", text),))


# -- applications and nodes --------------------------------------------------------------------------------------------


def _stall(mission: Mission) -> Iterator[RunProblem]:
    stall = mission.stall
    if stall is not None:
        where = f" ({stall.place})" if stall.place else ""
        text, detail = f"{stall.task} does not give up the CPU{where}", "\n".join(stall.lines)
        failure = Failure(FailureKind.STALLED, stall.app, text, stall.at_ns, detail, stall.task)
        yield RunProblem(str(stall), stall.at_ns, (failure,))


def _abortion(mission: Mission) -> Iterator[RunProblem]:
    """Yield the end of the flight software by abort(), which no task of NASA's process survives."""
    abortion = mission.kernel.abortion
    if abortion is not None:
        task, at = abortion.task, instant_text(abortion.at_ns)
        app = "" if task.owner is None else task.owner.name
        has_raised = any(each.at_ns == abortion.at_ns for each in mission.record.part(FailedCode).died)
        failure = Failure(FailureKind.DIED, app, abortion.text, abortion.at_ns, task=task.name)
        text = f"the flight software aborts at {at}, as NASA's process on Linux does: {abortion.text}"
        yield RunProblem(text, abortion.at_ns, () if has_raised else (failure,))


def _deaths(mission: Mission) -> Iterator[RunProblem]:
    """Yield exceptions from tasks, except crashes injected by a fault plan."""
    history, lines = mission.record.history, mission.record.deaths_by_app()
    by_app: dict[str, list[RaisedError]] = {}
    for each in mission.record.part(FailedCode).died:
        by_app.setdefault(each.who, []).append(each)
    for app, errors in by_app.items():
        text = lines.get(app)
        if text is None or isinstance(history[app].last_error, InjectedCrash):
            text = f"{app} died: {errors[-1].text}"
        yield RunProblem(text, errors[-1].at_ns, tuple(map(_death, errors)))


def _death(error: RaisedError) -> Failure:
    if not error.circle:
        return Failure(FailureKind.DIED, error.who, error.text, error.at_ns, error.detail, error.task, error.cause)
    apps = " and ".join(error.circle_apps)
    return Failure(FailureKind.DEADLOCK, apps, error.circle, error.at_ns, error.detail, error.task)


def _printed(mission: Mission) -> Iterator[RunProblem]:
    """Yield exceptions whose tracebacks nodes have printed, from a callback or a thread, after which the node
    continues.
    """
    by_title: dict[str, list[Failure]] = {}
    for each in mission.record.part(FailedCode).printed.found:
        failure = Failure(FailureKind.RAISED, each.who, each.text, each.at_ns, each.detail, each.task, each.cause)
        by_title.setdefault(failure.title, []).append(failure)
    for title, failures in by_title.items():
        yield RunProblem(title, failures[0].at_ns, tuple(failures))


def _bad_ends(mission: Mission) -> Iterator[RunProblem]:
    """Yield applications and nodes that ended with an error, without a failure of their own if an exception
    caused it.
    """
    failed = mission.record.part(FailedCode)
    dead = failed.crashed | {each.who for each in (*failed.died, *failed.printed.found) if not each.circle}
    for name in _ended_badly(mission):
        if name in failed.crashed:
            continue
        end = None if mission.ros is None else mission.ros.ended.get(name)
        text = end_of(mission, name)
        is_told = name in dead or (end is not None and end.name in dead)
        cause = without_values(_COLLECTION.sub("#", text))
        failures = () if is_told else (Failure(FailureKind.ENDED, name, text, cause=cause),)
        history = mission.record.history.get(name)
        at_ns = None if history is None else history.failed_ns
        yield RunProblem(f"{name} ended with {text}", at_ns, failures)
        waits = mission.record.part(WaitsAtEnds).by_app.get(name)
        if waits is not None:
            yield from (_at(at_ns, each) for each in (*map(_circle, waits.circles), *_alone(waits.alone, ())))


def end_of(mission: Mission, name: str) -> str:
    """Return the status with which an application ended: for a node, its program's exit status and last words."""
    end = None if mission.ros is None else mission.ros.ended.get(name)
    if end is None or not end.status:
        return "CFE_ES_RunStatus_APP_ERROR"
    words = visible_line(_COLOURS.sub("", end.last_words)).strip()
    return f"exit status {end.status} (node /{end.name}){words and f': {words[:_LONGEST_WORDS]}'}"


def _ended_badly(mission: Mission) -> list[str]:
    """Return the applications that ended because of an error."""
    es = mission.cfe.es
    ended = [history.name for history in es.history.values() if history.error_exits]
    ending = [app.name for app in es.apps if app.control_request == APP_ERROR]
    built = {} if mission.ros is None else {app: mission.ros.ended.get(app) for app in mission.spec.built}
    # also if the run ended together with it
    ending += [app for app, end in built.items() if end is not None and end.status]
    return list(dict.fromkeys(ended + ending))


def own_errors(mission: Mission) -> dict[str, int]:
    """Return the numbers of ERROR and CRITICAL events of the mission's own applications."""
    return {name: count for name, count in sorted(mission.record.errors_by_app.items()) if name not in CORE_APPS}


def _events(mission: Mission, outcome: Outcome | None) -> Iterator[RunProblem]:
    """Yield ERROR and CRITICAL events of the mission's own applications, except those that its script expects."""
    expected = frozenset() if outcome is None else outcome.expected_events
    for name, count in own_errors(mission).items():
        failures = []
        for (app, event_id), sent in mission.record.first_errors.items():
            if app == name and (app, event_id) not in expected:
                kind = "CRITICAL" if sent.event_type == CRITICAL else "ERROR"
                text, cause = f"{kind} event {event_id}: {sent.text}", f"event {event_id}"
                failures.append(Failure(FailureKind.EVENT, app, text, sent.at_ns, task=sent.task, cause=cause))
        if failures:
            text = f"{name} sent {count} ERROR or CRITICAL event{'s' if count > 1 else ''}"
            yield RunProblem(text, failures[0].at_ns, tuple(failures))


def _resets(mission: Mission) -> Iterator[RunProblem]:
    for reset in mission.record.resets:
        if reset.fault and InjectedCrash.__name__ not in reset.reason:
            text = f"the processor was reset at {instant_text(reset.at_ns)}: {reset.reason}"
            yield RunProblem(text, reset.at_ns, (Failure(FailureKind.RESET, "", reset.reason, reset.at_ns),))


# -- rules of the mission file -----------------------------------------------------------------------------------------


def _invariants(mission: Mission) -> Iterator[RunProblem]:
    for each in mission.record.part(InvariantRecords).values():
        first = each.first
        if first is not None:
            text = f"invariant {each.name!r} ({each.place}) at {instant_text(first.at_ns)}: {first.text}"
            detail = f"{f'sent by {first.sender}: ' if first.sender else ''}{first.detail}"
            failure = Failure(FailureKind.INVARIANT, each.name, first.text, first.at_ns, detail)
            yield RunProblem(text, first.at_ns, (failure,))


def _deadlines(mission: Mission) -> Iterator[RunProblem]:
    for check in mission.record.part(DeadlineRecord).checks:
        result = check.result()
        if result.problem is not None and result.first_at_s is not None:
            at_ns, text = round(result.first_at_s * NS_PER_S), f"{result.kind} {result.limit_text} was missed"
            failure = Failure(FailureKind.DEADLINE, result.owner, text, at_ns, result.problem, span_ns=check.limit_ns)
            yield RunProblem(result.problem, at_ns, (failure,))


# -- compiled code -----------------------------------------------------------------------------------------------------


def _of_compiled_code(mission: Mission) -> Iterator[RunProblem]:
    """Yield unordered accesses with the calls on both sides, and writes past memory blocks."""
    for race in mission.record.data_races:
        lines = "\n    ".join((race.text, *race.detail.splitlines()[1:]))
        failure = Failure(FailureKind.RACE, race.app, race.text, race.at_ns, race.detail, race.task, race.cause)
        yield RunProblem(f"data race at {instant_text(race.at_ns)}: {lines}", race.at_ns, (failure,))
    for each in mission.record.overwrites:
        failure = Failure(FailureKind.OVERWRITE, each.app, each.text, each.at_ns)
        yield RunProblem(f"overwritten memory: {each}", each.at_ns, (failure,))


# -- resources that applications hold ----------------------------------------------------------------------------------


def _leaks(mission: Mission) -> Iterator[RunProblem]:
    """Yield the resources that applications held when they ended, which the guard writes down."""
    for each in mission.record.leaks:
        failure = Failure(FailureKind.LEAK, each.app, each.text, each.at_ns)
        yield RunProblem(failure.title, each.at_ns, (failure,))


def _waiting_loads(mission: Mission) -> Iterator[RunProblem]:
    """Yield table loads that have waited for a held address for too long, and still wait."""
    es, holdings = mission.cfe.es, mission.processor.holdings
    for each in mission.cfe.tbl.registry.waiting_loads():
        if mission.kernel.now - each.since_ns < LONG_WAIT_NS:
            continue
        holder = es.apps.find(each.holder.app_id)
        who = "" if holder is None else holder.name
        place = "" if holdings is None else holdings.place_of_address(each.holder.handle)
        load = f"the load of {each.source} waits" if each.source else "loads are refused"
        taken = f", taken at {place}" if place else ""
        text = f"{load} since {instant_text(each.since_ns)}: {who} holds the address of table {each.table}{taken}"
        failure = Failure(FailureKind.WAITING_LOAD, who, text, each.since_ns, cause=each.table)
        yield RunProblem(failure.title, each.since_ns, (failure,))


# -- the end of the run ------------------------------------------------------------------------------------------------


def _circle(circle: Sequence[EndlessWait]) -> RunProblem:
    """Return the problem of tasks that wait for each other, or of a task that waits for an ended task."""
    apps = " and ".join(dict.fromkeys(wait.app for wait in circle))
    text = "; ".join(f"{wait.task} waits for {wait.what}, held by {wait.holder}" for wait in circle)
    detail = "\n".join(wait.text for wait in circle)
    failure = Failure(FailureKind.DEADLOCK, apps, text, None, detail, circle[-1].task)
    return RunProblem(f"deadlock: {text}", None, (failure,))


def _at(at_ns: int | None, problem: RunProblem) -> RunProblem:
    """Return a problem and its failures with a time."""
    return problem._replace(at_ns=at_ns, failures=tuple(replace(each, at_ns=at_ns) for each in problem.failures))


def _alone(waits: Sequence[EndlessWait], found: Sequence[Failure]) -> Iterator[RunProblem]:
    """Yield tasks that no task can wake; without a failure of their own if another failure removed the waking task."""
    follows = any(failure.kind in LEAVES_OTHERS_WAITING for failure in found)
    for wait in waits:
        failures = () if follows else (Failure(FailureKind.STUCK, wait.app, wait.text, task=wait.task),)
        yield RunProblem(wait.text, None, failures)


def _missed_steps(outcome: Outcome | None) -> Iterator[RunProblem]:
    """Yield failed steps of the script; steps that were never reached follow from an earlier failure."""
    failed = [] if outcome is None else [each for each in outcome.verdicts if not each.ok]
    first = next((each for each in failed if not each.follows), failed[0] if failed else None)
    for each in failed:
        assert outcome is not None
        at_ns = round(each.at_s * NS_PER_S)
        text = f"{each.step}: {each.detail}" if each.detail else each.step
        who = f"{outcome.file.rpartition('/')[2]}:{each.line}"
        failure = Failure(FailureKind.EXPECTATION, who, text, at_ns, cause=each.step)
        is_told = each is first or not each.follows
        yield RunProblem(f"step {outcome.file}:{each.line} failed: {text}", at_ns, (failure,) if is_told else (), True)


def _beside(mission: Mission) -> Iterator[RunProblem]:
    """Yield the problems of the missions that flew together with it."""
    for row in mission.record.rows(BESIDE):
        for text in row["problems"]:
            yield RunProblem(f"{row['mission']}: {text}", None, (Failure(FailureKind.PROBLEM, row["mission"], text),))
