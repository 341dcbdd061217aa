"""The monitor of a mission's invariants: each is checked against its messages when they are sent.

A violation is written to the console and the trace, and listed in the report. A processor reset starts again: earlier
messages are forgotten. A mission without invariants never loads this module.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any

from cfepy.attachment import Attachment
from cfepy.ground import flat
from cfepy.mission import Mission, MissionSpec, Processor, app_traceback, described, matches
from cfepy.monitors.invariants import CAUSE, Answer, Invariant, Selection, code_of
from cfepy.monitors.observed_messages import Heard, MessageWatch, unknown_packets
from cfepy.monitors.predicate import LATEST, short
from cfepy.monitors.record import InvariantRecord, InvariantRecords, Violation
from cfepy.msg import RED, YELLOW, Measurement
from cfepy.sb import SoftwareBus
from cfepy.status import UsageError
from cfepy.units import NS_PER_S, instant_text

Report = Callable[[str, int, str, str], None]
"""Receives a violation: text, virtual time in ns, the sender of the message, more lines."""


class Latest(dict[str, Any]):
    """The latest message of each topic; None if there was none yet."""

    def __missing__(self, topic: str) -> None:
        return None

    def get(self, topic: str, default: Any = None) -> Any:
        message = super().get(topic)
        return default if message is None else message


class Judge:
    """Checks one invariant; keeps its state since the last reset.

    Args:
        invariant: the invariant.
        latest: latest messages of all topics.
        report: receives violations.
    """

    def __init__(self, invariant: Invariant, latest: Latest, report: Report) -> None:
        self.invariant = invariant
        self.report = report
        self._latest = latest
        self._last: dict[str, Any] = {}
        self._counts: dict[str, int] = {}

    def selects(self, topic: str) -> bool:
        """Return whether it checks the messages of a topic or the packets of a name."""
        return _selects(self.invariant.selection, topic)

    def take(self, heard: Heard) -> bool:
        """Check a message; returns whether the invariant applies to it."""
        names = self._names(heard)
        self._last[heard.topic] = heard.msg
        when = self.invariant.when
        if heard.at_ns < self.invariant.after_ns or (when is not None and not when.holds(names)):
            return False
        self._judge(heard, names)
        return True

    def end(self, now_ns: int) -> None:
        """The run has ended."""

    def _names(self, heard: Heard) -> dict[str, Any]:
        """Return the names that its expressions can use."""
        count = self._counts[heard.topic] = self._counts.get(heard.topic, 0) + 1
        return {
            "msg": heard.msg,
            "last": self._last.get(heard.topic),
            LATEST: self._latest,
            "topic": heard.topic,
            "sender": heard.sender,
            "t": heard.t,
            "count": count,
        }

    def _judge(self, heard: Heard, names: dict[str, Any]) -> None:
        holds = self.invariant.holds
        assert holds is not None
        if not holds.holds(names):
            values = holds.values(names)
            text = f"{holds.source} does not hold{f'; {values}' if values else ''}"
            self.report(text, heard.at_ns, heard.sender, f"{heard.topic}: {short(heard.msg)}")


class FunctionJudge(Judge):
    """Checks with a function of the mission: False, a text or an AssertionError means a violation."""

    def __init__(self, invariant: Invariant, latest: Latest, report: Report) -> None:
        super().__init__(invariant, latest, report)
        self._code = code_of(invariant)

    def end(self, now_ns: int) -> None:
        """An object with a method of this name is called once more at the end."""
        last_word = getattr(self._code, "end", None)
        if last_word is not None:
            self._ask(last_word, now_ns, "")

    def _judge(self, heard: Heard, names: dict[str, Any]) -> None:
        self._ask(lambda: self._code(heard), heard.at_ns, heard.sender, f"{heard.topic}: {short(heard.msg)}")

    def _ask(self, code: Callable[[], Any], at_ns: int, sender: str, detail: str = "") -> None:
        try:
            said = code()
        except AssertionError as error:
            said = str(error) or "an assertion failed"
            detail = f"{detail}\n{app_traceback(error)}".lstrip()
        if said is False or isinstance(said, str):
            self.report(said or f"{self.invariant.function} returned False", at_ns, sender, detail)


class AnswerJudge(Judge):
    """Waits for the answer to each message, and reports those that did not come in time."""

    def __init__(self, invariant: Invariant, latest: Latest, report: Report) -> None:
        super().__init__(invariant, latest, report)
        assert invariant.answer is not None
        self._answer: Answer = invariant.answer
        self._open: deque[Heard] = deque()

    def selects(self, topic: str) -> bool:
        """Return whether it checks such messages, including answers; see `Judge.selects`."""
        return super().selects(topic) or _selects(self._answer.selection, topic)

    def take(self, heard: Heard) -> bool:
        """A message that is both is treated as an answer first."""
        self._expire(heard.at_ns)
        names = self._names(heard)
        if self._open and _selects(self._answer.selection, heard.topic):
            holds = self._answer.holds
            self._open = deque(
                each for each in self._open if holds is not None and not holds.holds({**names, CAUSE: each.msg})
            )
        when = self.invariant.when
        is_cause = super().selects(heard.topic) and heard.at_ns >= self.invariant.after_ns
        is_cause = is_cause and (when is None or when.holds(names))
        if is_cause:
            self._open.append(heard)
        self._last[heard.topic] = heard.msg
        return is_cause

    def end(self, now_ns: int) -> None:
        """Do not report answers that are not due yet."""
        self._expire(now_ns)

    def _expire(self, now_ns: int) -> None:
        within_ns = self._answer.within_ns
        while self._open and now_ns > self._open[0].at_ns + within_ns:
            cause = self._open.popleft()
            what = self._answer.selection if self._answer.holds is None else self._answer.holds.source
            text = f"no answer within {within_ns / NS_PER_S:g} s ({what}) to {cause.topic}"
            self.report(text, cause.at_ns + within_ns, cause.sender, f"{cause.topic}: {short(cause.msg)}")


class AgainJudge(Judge):
    """Reports if no matching message came for too long, since the invariant began to apply or since the last one."""

    def __init__(self, invariant: Invariant, latest: Latest, report: Report, now_ns: int) -> None:
        super().__init__(invariant, latest, report)
        assert invariant.again_ns is not None
        self._again_ns: int = invariant.again_ns
        self._since_ns = max(now_ns, invariant.after_ns)

    def take(self, heard: Heard) -> bool:
        is_one = super().take(heard)
        if is_one:
            self._expire(heard.at_ns)
            self._since_ns = heard.at_ns
        return is_one

    def _judge(self, heard: Heard, names: dict[str, Any]) -> None:
        """The message only has to come."""

    def end(self, now_ns: int) -> None:
        self._expire(now_ns)

    def _expire(self, now_ns: int) -> None:
        due_ns = self._since_ns + self._again_ns
        if now_ns > due_ns:
            what = self.invariant.selection if self.invariant.when is None else self.invariant.when.source
            self.report(f"no further message within {self._again_ns / NS_PER_S:g} s ({what})", due_ns, "", "")


class EventuallyJudge(Judge):
    """Reports at the end of the run if a condition never held."""

    _has_held = False

    def _judge(self, heard: Heard, names: dict[str, Any]) -> None:
        holds = self.invariant.eventually
        assert holds is not None
        self._has_held = self._has_held or bool(holds.holds(names))

    def end(self, now_ns: int) -> None:
        assert self.invariant.eventually is not None
        if not self._has_held and now_ns >= self.invariant.after_ns:
            text = f"{self.invariant.eventually.source} did not hold of any message until the end of the run"
            self.report(text, now_ns, "", "")


class LimitsJudge(Judge):
    """Reports measurements outside their limits.

    Args:
        invariant: the invariant.
        latest: latest messages of all topics.
        report: receives violations.
        measured: measurements of a packet, by the path of the field.
    """

    def __init__(
        self,
        invariant: Invariant,
        latest: Latest,
        report: Report,
        measured: Callable[[str], Mapping[str, Measurement]],
    ) -> None:
        super().__init__(invariant, latest, report)
        self._measured = {packet: measured(packet) for packet in invariant.selection.packets}

    def _judge(self, heard: Heard, names: dict[str, Any]) -> None:
        numbers = flat(heard.msg)
        for path, measurement in self._measured[heard.topic].items():
            value = measurement.value(numbers[path])
            violated = measurement.violated(value)
            if violated == RED or (violated and self.invariant.limits == YELLOW):
                text = f"{heard.topic}.{path} is {measurement.explained(value)}"
                self.report(text, heard.at_ns, heard.sender, f"{heard.topic}: {short(heard.msg)}")


class InvariantWatch(Attachment):
    """Checks all invariants of a mission.

    Args:
        spec: the mission.
        invariants: its invariants.

    Raises:
        UsageError: if one names a packet that the mission does not have, or its code cannot be executed.
    """

    def __init__(self, spec: MissionSpec, invariants: Sequence[Invariant]) -> None:
        self._invariants = tuple(invariants)
        self._latest = Latest()
        self._judges: list[Judge] = []
        self._wanting: dict[str, list[Judge]] = {}
        self._broken: set[str] = set()
        selections = [each for invariant in self._invariants for each in _selections(invariant)]
        topics = tuple(dict.fromkeys(name for each in selections for name in each.topics or _all(each)))
        packets = tuple(dict.fromkeys(name for each in selections for name in each.packets))
        try:
            self._messages = MessageWatch(spec, self._take, topics, packets)
        except UsageError as error:
            named = [(each.name, packet) for each in self._invariants for packet in each.packets]
            raise unknown_packets(spec, "invariants", named) or error from None
        self._check_limits(spec)
        self._mission: Mission | None = None
        self._now_ns = 0  # when the processor was created
        self._records = InvariantRecords()
        self._make_judges()

    def _check_limits(self, spec: MissionSpec) -> None:
        """Check that the packets of `limits` have some.

        Raises:
            UsageError: one has none.
        """
        for each in self._invariants:
            for packet in each.selection.packets if each.limits else ():
                kinds = (RED,) if each.limits == RED else (RED, YELLOW)
                found = (
                    measured.limits(kind) for measured in self._messages.measured(packet).values() for kind in kinds
                )
                if all(limits == (None, None) for limits in found):
                    text = f"{packet} has no field with a {each.limits} limit; declare it as a Measurement"
                    raise UsageError(text, file=spec.mission_file, field=f"invariants.{each.name}")

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        return self._messages.bus(base)

    def begin(self, mission: Mission) -> None:
        self._mission = mission
        self._messages.begin(mission)
        self._records = mission.record.part(InvariantRecords)
        self._records.update((each.name, InvariantRecord(each.name, each.place)) for each in self._invariants)

    def power_up(self, processor: Processor) -> None:
        assert self._mission is not None
        if self._mission.record.resets:
            self._latest.clear()
            self._wanting.clear()
            self._now_ns = self._mission.kernel.now
            self._make_judges()

    def conclude(self) -> None:
        assert self._mission is not None
        for judge in self._judges:
            self._ask(judge, partial(judge.end, self._mission.kernel.now))

    def _make_judges(self) -> None:
        self._judges = [self._judge_of(invariant) for invariant in self._invariants]

    def _judge_of(self, invariant: Invariant) -> Judge:
        kinds: list[tuple[object, type[Judge]]] = [
            (invariant.function or None, FunctionJudge),
            (invariant.answer, AnswerJudge),
            (invariant.eventually, EventuallyJudge),
        ]
        kind = next((each for said, each in kinds if said is not None), Judge)

        def report(text: str, at_ns: int, sender: str, detail: str) -> None:
            self._report(invariant, Violation(text, at_ns, sender, detail))

        if invariant.limits:
            return LimitsJudge(invariant, self._latest, report, self._messages.measured)
        if invariant.again_ns is not None:
            return AgainJudge(invariant, self._latest, report, self._now_ns)
        return kind(invariant, self._latest, report)

    def _take(self, heard: Heard) -> None:
        judges = self._wanting.get(heard.topic)
        if judges is None:
            judges = self._wanting[heard.topic] = [each for each in self._judges if each.selects(heard.topic)]
        for judge in judges:
            self._ask(judge, partial(judge.take, heard))
        self._latest[heard.topic] = _message(heard)

    def _ask(self, judge: Judge, what: Callable[[], Any]) -> None:
        """Call a judge; if its code fails, the error is reported once and the judge is disabled."""
        assert self._mission is not None
        name = judge.invariant.name
        if name in self._broken:
            return
        try:
            self._records[name].judged += bool(what())
        except Exception as error:
            self._broken.add(name)
            text = error.text if isinstance(error, UsageError) else described(error)
            now_ns = self._mission.kernel.now
            detail = app_traceback(error) if judge.invariant.function else ""
            self._report(judge.invariant, Violation(f"could not be judged: {text}", now_ns, "", detail))

    def _report(self, invariant: Invariant, violation: Violation) -> None:
        assert self._mission is not None
        record = self._records[invariant.name]
        record.violated += 1
        at = f"at {instant_text(violation.at_ns)}"
        line = f"invariant {invariant.name!r} ({invariant.place}) {at}: {violation.text}"
        if record.first is None:
            record.first = violation
            self._mission.console.write(line)
        else:
            self._mission.trace.note(line)


def _selections(invariant: Invariant) -> Iterator[Selection]:
    yield invariant.selection
    if invariant.answer is not None:
        yield invariant.answer.selection
    for predicate in invariant.predicates:
        if predicate.topics:
            yield Selection(
                tuple(name for name in predicate.topics if name.startswith("/")),
                tuple(name for name in predicate.topics if not name.startswith("/")),
            )


def _all(selection: Selection) -> tuple[str, ...]:
    """Return the pattern of an empty selection."""
    return () if selection.packets else ("*",)


def _selects(selection: Selection, topic: str) -> bool:
    if not topic.startswith("/"):
        return topic in selection.packets
    return bool(selection.topics or not selection.packets) and matches(topic, selection.topics)


def _message(heard: Heard) -> Any:
    try:
        return heard.msg
    except Exception:
        return None  # judges that check this message have reported it
