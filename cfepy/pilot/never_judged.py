"""Rules of a mission file without any input in a run: such a rule was neither met nor violated.

An invariant that was never judged, a deadline that was never measured, or a result that never came often has a misspelt
name. This is not a problem of the run, but the user should know it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

from cfepy.ground import names_in
from cfepy.mission import Mission
from cfepy.monitors import DeadlineRecord, InvariantRecords
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import OsalError

if TYPE_CHECKING:
    from cfepy.monitors import SelectedResult

OF_APPS = ("response", "period")  # deadlines of applications; others are about messages


class SentNames:
    """The names with messages in a run.

    Args:
        mission: the mission after its flight.

    Attributes:
        names: names that had messages.
        known: these names, and the topics that have a publisher.
    """

    def __init__(self, mission: Mission) -> None:
        rows = [*mission.record.topics.values(), *mission.processor.topics()]
        by_id = names_in(mission) | {row.msg_id: row.name for row in rows}
        sent = [msg_id for msg_id, count in mission.record.traffic(mission.cfe.sb, ()).items() if count.sent]
        built = {program.name for program in mission.spec.built.values()}  # their unsent messages are not counted
        heard = [row.name for row in rows if row.unsent or row.latched or built.intersection(row.publishers)]
        self.names = list(dict.fromkeys([*heard, *(by_id[msg_id] for msg_id in sent if msg_id in by_id)]))
        self.known = list(dict.fromkeys([*self.names, *(row.name for row in rows if row.publishers)]))
        self._ids = {f"0x{msg_id:04x}" for msg_id in sent}

    def has(self, name: str) -> bool:
        """Return whether there were messages for a name, a pattern or a MsgId."""
        return name.casefold() in self._ids or any(fnmatchcase(each, name) for each in self.names)

    def why_not(self, names: Iterable[str]) -> str:
        """Return the end of a sentence about names without messages; empty if each had some."""
        missing = [name for name in names if not self.has(name)]
        if not missing:
            return ""
        hint = "" if missing[0] in self.known else did_you_mean(missing[0], self.known, before="; ")
        return f": no message of {', '.join(missing)} was sent{hint}"


def never_judged(mission: Mission) -> list[str]:
    """Return a line for each rule of the mission file without input; empty before the mission is OPERATIONAL."""
    if mission.booted is None:
        return []
    from cfepy.monitors import demands_of

    demands, sent = demands_of(mission.spec), SentNames(mission)
    names = {each.name: each.names for each in demands.invariants}
    return [
        *_invariants(mission, names, sent),
        *_deadlines(mission, sent),
        *_results(mission, demands.results, sent),
    ]


def _invariants(mission: Mission, names: dict[str, tuple[str, ...]], sent: SentNames) -> Iterator[str]:
    for each in mission.record.part(InvariantRecords).values():
        if not each.judged and not each.violated:
            yield f"invariant {each.name!r} ({each.place}) was never judged{sent.why_not(names.get(each.name, ()))}"


def no_such_app(mission: Mission, name: str) -> str:
    """Return the end of a sentence about an application that never ran; empty if it did."""
    apps = mission.record.history
    return "" if name in apps else f": unknown application {name}{did_you_mean(name, apps, before='; ')}"


def _deadlines(mission: Mission, sent: SentNames) -> Iterator[str]:
    for each in mission.record.part(DeadlineRecord).checks:
        why = no_such_app(mission, each.owner) if each.kind in OF_APPS else sent.why_not([each.owner])
        if why or not each.checked:
            yield f"the deadline {each.kind} of {each.owner} was never measured{why}"


def _results(mission: Mission, results: Sequence[SelectedResult], sent: SentNames) -> Iterator[str]:
    from cfepy.monitors import FILE, OUTPUT

    for each in results:
        if each.compare == FILE:
            why = "" if _is_file(mission, each.name) else ": the file does not exist"
        elif each.compare == OUTPUT:
            why = no_such_app(mission, each.name)
        else:
            why = sent.why_not([each.name])
        if why:
            yield f"the result {each.name} ({each.compare}) never occurred{why}"


def _is_file(mission: Mission, path: str) -> bool:
    try:
        return mission.files.find(path) is not None
    except OsalError:
        return False
