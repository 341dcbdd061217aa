"""Execution of mission scripts: commands at given times and expected answers, with a verdict for each step.

    outcome = fly(RunPlan(("capture",), script="checks.txt")).outcome
    assert outcome.ok, outcome.text()

A script acts at fixed virtual times between parts of the run, so the same script always has the same outcome. An
expectation stays open until it can be decided. The run continues after resets of the processor. See
docs/how_to/ground_tools.md for the language.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from cfepy.ground import EVENT_IDS, DecodedEvent, dictionary_of
from cfepy.mission import Mission, MissionSpec, PacketWatch, Seen
from cfepy.rtos import ENDLESS
from cfepy.script.conditions import (
    CallCondition,
    Collected,
    Condition,
    ResetCondition,
    Scene,
    Since,
    TelemetryCondition,
    seen_text,
)
from cfepy.script.text import Script, Step, read_script
from cfepy.units import NS_PER_MS, NS_PER_S

OVER = "the run ended earlier"
LOOK_NS = 10 * NS_PER_MS  # interval between two checks of an expectation


@dataclass(frozen=True, slots=True)
class StepVerdict:
    """Result of a step: `at_s` is the virtual time in s at which it was decided, `detail` the error."""

    line: int
    step: str
    ok: bool
    at_s: float
    detail: str = ""

    @property
    def follows(self) -> bool:
        """Whether it failed only because the run ended before it was reached."""
        return not self.ok and self.detail == OVER

    @classmethod
    def of(cls, step: Step, ok: bool, at_ns: int, detail: str = "") -> StepVerdict:
        """Return the verdict on a step."""
        return cls(step.line, step.text, ok, at_ns / NS_PER_S, detail)


@dataclass(frozen=True, slots=True)
class Outcome:
    """Verdicts of a script, in the order of its lines.

    Attributes:
        file: the script.
        verdicts: one for each step.
        expected_events: application and id of the events that its steps have waited for.
    """

    file: str
    verdicts: tuple[StepVerdict, ...]
    expected_events: frozenset[tuple[str, int]] = frozenset()

    @property
    def ok(self) -> bool:
        """Whether every step passed."""
        return all(verdict.ok for verdict in self.verdicts)

    def lines(self) -> Iterator[str]:
        """Yield a line for each step, and the summary."""
        yield from map(self._line, self.verdicts)
        failed = sum(not verdict.ok for verdict in self.verdicts)
        count = len(self.verdicts)
        yield f"{count} {'step' if count == 1 else 'steps'}, {f'{failed} failed' if failed else 'all ok'}"

    def failed_lines(self) -> Iterator[str]:
        """Yield a line for each failed step."""
        yield from (self._line(each) for each in self.verdicts if not each.ok)

    def _line(self, each: StepVerdict) -> str:
        detail = f": {each.detail}" if each.detail else ""
        word = "ok" if each.ok else "FAILED"
        return f"{word:<6} {each.at_s:12.6f}  {self.file}:{each.line}: {each.step}{detail}"

    def text(self) -> str:
        """Return all lines, for a message."""
        return "\n".join(self.lines())

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers and text."""
        return {"file": self.file, "ok": self.ok, "steps": [asdict(verdict) for verdict in self.verdicts]}


class Expectation:
    """A condition that must be met, or must not be met.

    Args:
        step: its step.
        condition: the step's condition.
        since: position from which packets and lines count.
        deadline_ns: virtual time at which it is decided; None for the end of the script.

    Attributes:
        event: application and id of the event that has met it; None if there is none.
    """

    def __init__(self, step: Step, condition: Condition, since: Since, deadline_ns: int | None) -> None:
        self.deadline_ns = deadline_ns
        self.event: tuple[str, int] | None = None
        self._step = step
        self._condition = condition
        self._since = self._looked = since

    def wake_ns(self, now_ns: int) -> int | None:
        """Return when it must be checked next; None for any time, because packets are kept."""
        needs_to_look = not self._step.must_not or not self._condition.msg_ids
        if not needs_to_look:
            return self.deadline_ns
        look_ns = now_ns + LOOK_NS
        return look_ns if self.deadline_ns is None else min(look_ns, self.deadline_ns)

    def decide(self, scene: Scene, is_over: bool = False) -> StepVerdict | None:
        """Return the verdict; None if it is still open.

        Args:
            scene: mission and packets to check.
            is_over: whether the script has ended, so it must be decided.
        """
        now_ns = scene.now_ns
        met = self._met(scene, now_ns)
        is_due = self.deadline_ns is not None and now_ns >= self.deadline_ns
        if self._step.must_not:
            return self._decide_against(scene, now_ns, met, is_due, is_over)
        if met is not None:
            at_ns, packet = met
            if packet is not None and packet.msg_id in EVENT_IDS:
                event = DecodedEvent.of(packet)
                self.event = (event.app, event.event_id)
            return StepVerdict.of(self._step, True, at_ns)
        if is_due or is_over or self._condition.is_hopeless(scene):
            return StepVerdict.of(self._step, False, now_ns, self._condition.instead(scene, self._since))
        return None

    def _decide_against(
        self, scene: Scene, now_ns: int, met: tuple[int, Seen | None] | None, is_due: bool, is_over: bool
    ) -> StepVerdict | None:
        """Decide a condition that must not be met."""
        if met is not None:
            at_ns, packet = met
            return StepVerdict.of(self._step, False, at_ns, seen_text(self._condition, scene, packet, self._since))
        if is_due or (is_over and self.deadline_ns is None):
            return StepVerdict.of(self._step, True, now_ns)
        return StepVerdict.of(self._step, False, now_ns, OVER) if is_over else None

    def _met(self, scene: Scene, now_ns: int) -> tuple[int, Seen | None] | None:
        """Return when it was met, and by which packet; checks only new packets and lines."""
        condition, looked = self._condition, self._looked
        self._looked = scene.here()
        if not condition.msg_ids:
            return (now_ns, None) if condition.holds(scene, looked) else None
        for packet in scene.packets.since(looked.packets):
            if self.deadline_ns is not None and packet.at_ns > self.deadline_ns:
                return None
            if packet.msg_id in condition.msg_ids and condition.met_by(scene, packet):
                return packet.at_ns, packet
        return None


class ScriptRun(PacketWatch):
    """A script during its execution, driven by the loop that runs its mission.

    Args:
        script: the script.
        stop_on_failure: whether it ends with the first step that fails.
        tell: receives each verdict at once.
        stands: whether unwanted conditions are watched without limit, also after the last step.

    Attributes:
        finished: whether there is nothing more to do.
        stopped: whether a failure ended it before its last step.
    """

    def __init__(
        self,
        script: Script,
        stop_on_failure: bool = False,
        tell: Callable[[Step, StepVerdict], object] = lambda step, verdict: None,
        stands: bool = False,
    ) -> None:
        self.script = script
        self.finished = self.stopped = False
        self._stop_on_failure = stop_on_failure
        self._tell = tell
        self._stands = stands
        self._packets = Collected()
        self._verdicts: dict[int, StepVerdict] = {}
        self._expected_events: set[tuple[str, int]] = set()
        self._guards: dict[int, Expectation] = {}
        self._waiting: Expectation | None = None
        self._next = 0
        self._start_ns: int | None = None
        conditions = [step.condition for step in script.steps if step.condition is not None]
        wanted = {each for condition in conditions for each in condition.msg_ids}
        topics = any(isinstance(each, TelemetryCondition) and each.is_topic for each in conditions)
        super().__init__(self._packets.append, wanted.__contains__, unsent=topics)

    @classmethod
    def read(cls, path: str | Path, spec: MissionSpec, stop_on_failure: bool = False) -> ScriptRun:
        """Return the run of a script file.

        Args:
            path: the file.
            spec: the mission with the packets and applications that it names.
            stop_on_failure: whether it ends with the first step that fails.

        Raises:
            UsageError: if it has a mistake, with file and line.
        """
        return cls(read_script(path, spec, dictionary_of(spec)), stop_on_failure)

    def begin(self, mission: Mission) -> None:
        self.join(Scene(mission, self.script.dictionary, self._packets))

    def join(self, scene: Scene) -> None:
        """Act in a scene, which may be shared: each action sets the scene's mark."""
        self._scene = scene

    @property
    def is_waiting(self) -> bool:
        """Whether steps are left, or an expectation must still be met."""
        return not self.finished and self._next < len(self.script.steps)

    @property
    def is_settled(self) -> bool:
        """Whether every step has its verdict."""
        return self.stopped or len(self._verdicts) == len(self.script.steps)

    def advance(self) -> int:
        """Execute the steps that are due.

        Returns:
            The virtual time in ns at which it wants to be asked again; far in the future when it is finished.
        """
        self._ask_guards()
        while not self.finished:
            wake_ns = self._go_on()
            if wake_ns is not None:
                times = [guard.wake_ns(self._now) for guard in self._guards.values()]
                return min([wake_ns, *(time for time in times if time is not None)])
        return ENDLESS

    def end(self) -> Outcome:
        """Decide all open expectations at the end of the run."""
        if self._waiting is not None:
            self._settle(self._next, self._decided(self._waiting, is_over=True))
        for number, guard in self._guards.items():
            self._settle(number, guard.decide(self._scene, is_over=True))
        for number, step in enumerate(self.script.steps):
            self._verdicts.setdefault(number, StepVerdict.of(step, False, self._now, OVER))
        verdicts = tuple(self._verdicts[number] for number in sorted(self._verdicts))
        return Outcome(self.script.file, verdicts, frozenset(self._expected_events))

    @property
    def _now(self) -> int:
        return self._scene.now_ns

    def _go_on(self) -> int | None:
        """Execute the next step; returns the time to continue if it must wait."""
        if self._waiting is not None:
            verdict = self._decided(self._waiting)
            if verdict is None:
                return self._waiting.wake_ns(self._now)
            self._waiting = None
            self._settle(self._next, verdict)
            self._next += 1
        elif self._next == len(self.script.steps):
            return self._wait_for_guards()
        else:
            return self._begin(self.script.steps[self._next])
        return None

    def _decided(self, waiting: Expectation, is_over: bool = False) -> StepVerdict | None:
        """Return the verdict on the current expectation; None if it is still open."""
        verdict = waiting.decide(self._scene, is_over)
        if waiting.event is not None:
            self._expected_events.add(waiting.event)
        return verdict

    def _begin(self, step: Step) -> int | None:
        """Start the next step; returns the time to continue if it is too early."""
        if self._start_ns is None:
            self._start_ns = step.at_ns if step.at_ns is not None else self._now + (step.after_ns or 0)
        if self._start_ns > self._now:
            return self._start_ns
        self._start_ns = None
        if step.condition is None or step.at_ns is not None or step.after_ns is not None:
            self._scene.set_mark()
        if step.condition is None:
            verdict = self._act(step)
            if step.is_reset and verdict.ok:
                self._wait_for(step, ResetCondition(len(self._scene.mission.record.resets)), self._scene.since)
                return None
            if step.is_call and verdict.ok:
                self._wait_for(step, CallCondition(), self._scene.since)
                return None
            self._settle(self._next, verdict)
        elif not step.must_not:
            self._wait_for(step, step.condition, self._scene.since)
            return None
        else:
            self._guards[self._next] = self._expectation(step, step.condition, self._scene.here())
            self._ask_guards()
        self._next += 1
        return None

    def _wait_for(self, step: Step, condition: Condition, since: Since) -> None:
        self._waiting = self._expectation(step, condition, since)

    def _expectation(self, step: Step, condition: Condition, since: Since) -> Expectation:
        return Expectation(step, condition, since, step.deadline_ns(self._scene.mark_ns, self._now))

    def _act(self, step: Step) -> StepVerdict:
        """Send the step's packet or carry out its action, if it has one."""
        detail = "" if step.packet is None else self._scene.send(step.packet, step.must_arrive)
        if step.action is not None:
            detail = self._scene.perform(step.action)
        return StepVerdict.of(step, not detail, self._now, detail)

    def _ask_guards(self) -> None:
        """Check for conditions that must not be met."""
        for number, guard in list(self._guards.items()):
            verdict = guard.decide(self._scene)
            if verdict is not None:
                del self._guards[number]
                self._settle(number, verdict)

    def _wait_for_guards(self) -> int | None:
        """End the script: unwanted conditions with their own time limit continue until then, the others end now."""
        times = [guard.deadline_ns for guard in self._guards.values() if guard.deadline_ns is not None]
        if times:
            return min(times)
        if self._guards and self._stands:
            return ENDLESS
        self.finished = True
        return None

    def _settle(self, number: int, verdict: StepVerdict | None) -> None:
        assert verdict is not None
        self._verdicts[number] = verdict
        self._tell(self.script.steps[number], verdict)
        if self._stop_on_failure and not verdict.ok:
            self.finished = self.stopped = True
