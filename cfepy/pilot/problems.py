"""What went wrong in a run: the one definition of it, for every command, report, test and search.

`problems_of` gives a line for each problem, as reports and commands show it, with the failures behind it, as searches
compare them. A run without a problem went well; what its user should know besides, such as a fault that never happened,
is no problem.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from cfepy.es import APP_ERROR, CFE_APP, CFE_LIB, BadLine, StartupEntry, parse
from cfepy.evs import CRITICAL
from cfepy.mission import CORE_APPS, EndlessWait, EndlessWaits, FailedCode, Mission, RaisedError
from cfepy.monitors import DeadlineRecord, InvariantRecords
from cfepy.pilot.failure import LEAVES_OTHERS_WAITING, Failure, FailureKind
from cfepy.rtos import InjectedCrash
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.script import Outcome

BESIDE = "beside"
"""The table of the record that has a row for each mission that flew beside it."""


class RunProblem(NamedTuple):
    """Something that went wrong in a run.

    Attributes:
        text: a line, or several, for a person.
        at_ns: virtual time; None when it has no time of its own.
        failures: what searches tell of it, an entry for each cause.
        is_step: it is a step of the script that did not go well.
    """

    text: str
    at_ns: int | None
    failures: tuple[Failure, ...] = ()
    is_step: bool = False


def problems_of(mission: Mission, endless: EndlessWaits, outcome: Outcome | None = None) -> list[RunProblem]:
    """What went wrong in a run until now.

    Args:
        mission: the mission.
        endless: its waits that never end, of now or of when the time of the run was over.
        outcome: of the script that the run had.
    """
    found = [*_startup(mission), *_stall(mission), *_deaths(mission), *_bad_ends(mission), *_events(mission, outcome)]
    found += [*_resets(mission), *_invariants(mission), *_deadlines(mission), *_of_compiled_code(mission)]
    found += [*map(_circle, endless.circles), *_printed(mission)]
    found += _alone(endless.alone, _failures(found))
    return [*found, *_missed_steps(outcome), *_beside(mission)]


def is_reported(problem: RunProblem) -> bool:
    """Whether a problem is only that an application reported one, in an ERROR or CRITICAL event."""
    return bool(problem.failures) and all(each.kind is FailureKind.EVENT for each in problem.failures)


def problems_so_far(mission: Mission) -> list[RunProblem]:
    """Those of the instant at which they show, while the mission runs."""
    found = [*_deaths(mission), *_events(mission, None), *_printed(mission), *_invariants(mission)]
    return [*found, *_of_compiled_code(mission)]


def failures_of(problems: Iterable[RunProblem]) -> list[Failure]:
    """The failures behind problems, by time; what has no time is true at the end and comes last."""
    found = _failures(problems)
    timed = [each for each in found if each.at_ns is not None]
    return [*sorted(timed, key=lambda each: each.at_ns or 0), *(each for each in found if each.at_ns is None)]


def _failures(problems: Iterable[RunProblem]) -> list[Failure]:
    return [failure for problem in problems for failure in problem.failures]


# -- the startup script ------------------------------------------------------------------------------------------------


def startup_problems(mission: Mission) -> list[str]:
    """What of the startup script could not be started; nothing as long as it was not read to its end."""
    if mission.booted is None:
        return []
    script, es = mission.spec.script, mission.cfe.es
    bad = (line for line in parse(mission.spec.startup_script) if isinstance(line, BadLine))
    libraries = [entry for entry in mission.spec.entries if entry.kind == CFE_LIB]
    loaded = {library.name for library in es.libs}
    if mission.processor.booted is None:  # it was reset, and has not come to them again
        loaded.update(each.name for each in libraries)
    return [
        *(f"{script}:{line.line}: {line.explanation}" for line in bad),
        *(f"library {each.name} could not be loaded" for each in libraries if each.name not in loaded),
        *(f"{each.name} could not be started" for each in not_started(mission)),
    ]


def not_started(mission: Mission) -> list[StartupEntry]:
    """The applications of the startup script that have never run, each name once."""
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


def _deaths(mission: Mission) -> Iterator[RunProblem]:
    """Exceptions out of tasks; a crash that a fault plan asks for is none."""
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
    """Exceptions whose tracebacks nodes have printed: of a callback, or of a thread, after which the node lives on."""
    by_title: dict[str, list[Failure]] = {}
    for each in mission.record.part(FailedCode).printed.found:
        failure = Failure(FailureKind.RAISED, each.who, each.text, each.at_ns, each.detail, each.task, each.cause)
        by_title.setdefault(failure.title, []).append(failure)
    for title, failures in by_title.items():
        yield RunProblem(title, failures[0].at_ns, tuple(failures))


def _bad_ends(mission: Mission) -> Iterator[RunProblem]:
    """Applications and nodes that ended themselves with an error; no failure of its own behind an exception."""
    failed = mission.record.part(FailedCode)
    dead = failed.crashed | {each.who for each in (*failed.died, *failed.printed.found) if not each.circle}
    for name in _ended_badly(mission):
        if name in failed.crashed:
            continue
        end = None if mission.ros is None else mission.ros.ended.get(name)
        text = end_of(mission, name)
        is_told = name in dead or (end is not None and end.name in dead)
        failures = () if is_told else (Failure(FailureKind.ENDED, name, text),)
        history = mission.record.history.get(name)
        yield RunProblem(f"{name} ended with {text}", None if history is None else history.failed_ns, failures)


def end_of(mission: Mission, name: str) -> str:
    """What an application has ended with: of a node, its program's exit status."""
    end = None if mission.ros is None else mission.ros.ended.get(name)
    if end is None or not end.status:
        return "CFE_ES_RunStatus_APP_ERROR"
    return f"exit status {end.status} (node /{end.name})"


def _ended_badly(mission: Mission) -> list[str]:
    """Applications that ended themselves because of an error."""
    es = mission.cfe.es
    ended = [history.name for history in es.history.values() if history.error_exits]
    ending = [app.name for app in es.apps if app.control_request == APP_ERROR]
    built = {} if mission.ros is None else {app: mission.ros.ended.get(app) for app in mission.spec.built}
    ending += [app for app, end in built.items() if end is not None and end.status]  # also where the run ended with it
    return list(dict.fromkeys(ended + ending))


def own_errors(mission: Mission) -> dict[str, int]:
    """ERROR and CRITICAL events of the mission's own applications."""
    return {name: count for name, count in sorted(mission.record.errors_by_app.items()) if name not in CORE_APPS}


def _events(mission: Mission, outcome: Outcome | None) -> Iterator[RunProblem]:
    """ERROR and CRITICAL events of the mission's own applications, but for those that its script expects."""
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
            text = f"the processor was reset at {reset.at_ns / NS_PER_S:g} s: {reset.reason}"
            yield RunProblem(text, reset.at_ns, (Failure(FailureKind.RESET, "", reset.reason, reset.at_ns),))


# -- what the mission file asks for ------------------------------------------------------------------------------------


def _invariants(mission: Mission) -> Iterator[RunProblem]:
    for each in mission.record.part(InvariantRecords).values():
        first = each.first
        if first is not None:
            text = f"invariant {each.name!r} ({each.place}) at {first.at_ns / NS_PER_S:g} s: {first.text}"
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
    """Accesses that nothing orders, with the calls on either side, and memory that was written past."""
    for race in mission.record.data_races:
        lines = "\n    ".join((race.text, *race.detail.splitlines()[1:]))
        failure = Failure(FailureKind.RACE, race.app, race.text, race.at_ns, race.detail, race.task, race.cause)
        yield RunProblem(f"data race at {race.at_ns / NS_PER_S:g} s: {lines}", race.at_ns, (failure,))
    for each in mission.record.overwrites:
        failure = Failure(FailureKind.OVERWRITE, each.app, each.text, each.at_ns)
        yield RunProblem(f"overwritten memory: {each}", each.at_ns, (failure,))


# -- the end of the run ------------------------------------------------------------------------------------------------


def _circle(circle: Sequence[EndlessWait]) -> RunProblem:
    """Tasks that wait for each other, or one that waits for another that has ended."""
    apps = " and ".join(dict.fromkeys(wait.app for wait in circle))
    text = "; ".join(f"{wait.task} waits for {wait.what}, held by {wait.holder}" for wait in circle)
    detail = "\n".join(wait.text for wait in circle)
    failure = Failure(FailureKind.DEADLOCK, apps, text, None, detail, circle[-1].task)
    return RunProblem(f"deadlock: {text}", None, (failure,))


def _alone(waits: Sequence[EndlessWait], found: Sequence[Failure]) -> Iterator[RunProblem]:
    """Tasks that nobody is left to wake; no failure of its own, if another one took away who would have done it."""
    follows = any(failure.kind in LEAVES_OTHERS_WAITING for failure in found)
    for wait in waits:
        failures = () if follows else (Failure(FailureKind.STUCK, wait.app, wait.text, task=wait.task),)
        yield RunProblem(wait.text, None, failures)


def _missed_steps(outcome: Outcome | None) -> Iterator[RunProblem]:
    """Steps of the script that did not go well; those that were never reached follow from the one before."""
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
    """What went wrong in the missions that flew beside it."""
    for row in mission.record.rows(BESIDE):
        for text in row["problems"]:
            yield RunProblem(f"{row['mission']}: {text}", None, (Failure(FailureKind.PROBLEM, row["mission"], text),))
