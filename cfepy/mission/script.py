"""Mission scripts: commands at certain times, and what is expected to come of them, with a verdict for each step.

    outcome = run_script("capture", "checks.txt")
    assert outcome.ok, outcome.text()

What a script does happens at fixed virtual times between pieces of the run, so the same script has the same outcome
every time. The run goes on over resets of the processor. docs/ground_tools.md describes the language.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cfepy.mission.dictionary import dictionary_of
from cfepy.mission.mission import Mission
from cfepy.mission.script_conditions import Condition, ResetCondition, Scene, Window
from cfepy.mission.script_expectation import Expectation
from cfepy.mission.script_text import Script, Step, read_script
from cfepy.mission.script_verdicts import OVER, Outcome, Verdict
from cfepy.mission.spec import MissionSpec, read_mission
from cfepy.mission.watch import PacketWatch, Seen, receivers
from cfepy.msg import get_msg_id
from cfepy.rtos.kernel import ENDLESS
from cfepy.status import CfeError


class ScriptRun(PacketWatch):
    """A script while it runs; whoever runs the mission that it is attached to asks it what is next.

    Args:
        script: what to do.
        stop_on_failure: the script ends with the first step that fails.

    Attributes:
        finished: there is nothing more to do.
        stopped: a failure ended it before its last step.
    """

    def __init__(self, script: Script, stop_on_failure: bool = False) -> None:
        self.script = script
        self.finished = self.stopped = False
        self._stop_on_failure = stop_on_failure
        self._packets: list[Seen] = []
        self._verdicts: dict[int, Verdict] = {}
        self._guards: dict[int, Expectation] = {}
        self._waiting: Expectation | None = None
        self._next = 0
        self._start_ns: int | None = None
        self._mark_ns = 0
        self._window = Window(0, 0)
        wanted = {each for step in script.steps if step.condition is not None for each in step.condition.msg_ids}
        super().__init__(self._packets.append, wanted.__contains__)

    @classmethod
    def read(cls, path: str | Path, spec: MissionSpec, stop_on_failure: bool = False) -> ScriptRun:
        """The run of a script's file.

        Args:
            path: the file.
            spec: the mission whose packets and applications it names.
            stop_on_failure: the script ends with the first step that fails.

        Raises:
            UsageError: a mistake in it, with file and line.
        """
        return cls(read_script(path, spec, dictionary_of(spec)), stop_on_failure)

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""
        self._scene = Scene(mission, self.script.dictionary, self._packets)

    def advance(self) -> int:
        """Do what is due now.

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
        """The run is over: what is undecided is decided now."""
        if self._waiting is not None:
            self._settle(self._next, self._waiting.decide(self._scene, is_over=True))
        for number, guard in self._guards.items():
            self._settle(number, guard.decide(self._scene, is_over=True))
        for number, step in enumerate(self.script.steps):
            self._verdicts.setdefault(number, Verdict.of(step, False, self._now, OVER))
        return Outcome(self.script.file, tuple(self._verdicts[number] for number in sorted(self._verdicts)))

    @property
    def _now(self) -> int:
        return self._scene.mission.kernel.now

    def _go_on(self) -> int | None:
        """Go one step further; the time to come back when that has to wait."""
        if self._waiting is not None:
            verdict = self._waiting.decide(self._scene)
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

    def _begin(self, step: Step) -> int | None:
        """Begin the next step; the time to come back when it is not time for it yet."""
        if self._start_ns is None:
            self._start_ns = step.at_ns if step.at_ns is not None else self._now + (step.after_ns or 0)
        if self._start_ns > self._now:
            return self._start_ns
        self._start_ns = None
        if step.condition is None or step.at_ns is not None or step.after_ns is not None:
            self._mark_ns, self._window = self._now, self._scene.here()
        if step.condition is None:
            verdict = self._act(step)
            if step.is_reset and verdict.ok:
                self._wait_for(step, ResetCondition(len(self._scene.mission.record.resets)), self._window)
                return None
            self._settle(self._next, verdict)
        elif not step.must_not:
            self._wait_for(step, step.condition, self._window)
            return None
        else:
            self._guards[self._next] = self._expectation(step, step.condition, self._scene.here())
            self._ask_guards()
        self._next += 1
        return None

    def _wait_for(self, step: Step, condition: Condition, window: Window) -> None:
        self._waiting = self._expectation(step, condition, window)

    def _expectation(self, step: Step, condition: Condition, window: Window) -> Expectation:
        return Expectation(step, condition, window, step.deadline_ns(self._mark_ns, self._now))

    def _act(self, step: Step) -> Verdict:
        """Send the step's packet, if it has one."""
        detail = ""
        if step.packet is not None:
            sb = self._scene.mission.cfe.sb
            if step.must_arrive and not receivers(sb, get_msg_id(step.packet)):
                detail = f"nobody subscribes to MsgId 0x{get_msg_id(step.packet):04X} at this time"
            try:
                sb.transmit_msg(step.packet, is_origination=False)
            except CfeError as error:
                detail = str(error)
        return Verdict.of(step, not detail, self._now, detail)

    def _ask_guards(self) -> None:
        """Look whether something came that must not come."""
        for number, guard in list(self._guards.items()):
            verdict = guard.decide(self._scene)
            if verdict is not None:
                del self._guards[number]
                self._settle(number, verdict)

    def _wait_for_guards(self) -> int | None:
        """All steps are done: guards with a time of their own go on until then, the others end with the script."""
        times = [guard.deadline_ns for guard in self._guards.values() if guard.deadline_ns is not None]
        if times:
            return min(times)
        self.finished = True
        return None

    def _settle(self, number: int, verdict: Verdict | None) -> None:
        assert verdict is not None
        self._verdicts[number] = verdict
        if self._stop_on_failure and not verdict.ok:
            self.finished = self.stopped = True


def run_script(
    mission: str | MissionSpec, path: str | Path, *, stop_on_failure: bool = False, **options: Any
) -> Outcome:
    """Fly a mission as a script says, as long as the script takes.

    Args:
        mission: as `Mission` takes it.
        path: the script.
        stop_on_failure: end with the first step that fails.
        options: of `Mission`, such as seed, board, console.

    Raises:
        UsageError: a mistake in the script or the mission, with file and line.
        CfeError: the mission cannot boot.
    """
    spec = mission if isinstance(mission, MissionSpec) else read_mission(mission)
    script = ScriptRun.read(path, spec, stop_on_failure)
    with Mission(spec, attachments=[script], **options) as flown:
        wake_ns = script.advance()
        while not script.finished:
            flown.run_until(wake_ns)
            wake_ns = script.advance()
        outcome = script.end()
        flown.shut_down_nodes()
        return outcome
