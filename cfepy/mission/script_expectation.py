"""An expectation of a mission script while it is open: it looks, until it can be decided."""

from __future__ import annotations

from cfepy.mission.script_conditions import Condition, Scene, Window
from cfepy.mission.script_packets import seen_text
from cfepy.mission.script_text import Step
from cfepy.mission.script_verdicts import OVER, Verdict
from cfepy.mission.watch import Seen
from cfepy.rtos.units import NS_PER_MS

LOOK_NS = 10 * NS_PER_MS  # how often an expectation looks


class Expectation:
    """A condition that is to be met, or must not be met.

    Args:
        step: the step that expects it.
        condition: the step's condition.
        window: from where on things count.
        deadline_ns: virtual time at which it is decided; None for the end of the script.
    """

    def __init__(self, step: Step, condition: Condition, window: Window, deadline_ns: int | None) -> None:
        self.deadline_ns = deadline_ns
        self._step = step
        self._condition = condition
        self._window = self._looked = window

    def wake_ns(self, now_ns: int) -> int | None:
        """When it wants to look again; None when any time will do, because packets wait."""
        needs_to_look = not self._step.must_not or not self._condition.msg_ids
        if not needs_to_look:
            return self.deadline_ns
        look_ns = now_ns + LOOK_NS
        return look_ns if self.deadline_ns is None else min(look_ns, self.deadline_ns)

    def decide(self, scene: Scene, is_over: bool = False) -> Verdict | None:
        """The verdict; None when it is still open.

        Args:
            scene: what there is to see.
            is_over: the script is over, so it must be decided.
        """
        now_ns = scene.mission.kernel.now
        met = self._met(scene, now_ns)
        is_due = self.deadline_ns is not None and now_ns >= self.deadline_ns
        if self._step.must_not:
            return self._decide_against(scene, now_ns, met, is_due, is_over)
        if met is not None:
            return Verdict.of(self._step, True, met[0])
        if is_due or is_over:
            return Verdict.of(self._step, False, now_ns, self._condition.instead(scene, self._window))
        return None

    def _decide_against(
        self, scene: Scene, now_ns: int, met: tuple[int, Seen | None] | None, is_due: bool, is_over: bool
    ) -> Verdict | None:
        """What must not be met."""
        if met is not None:
            at_ns, packet = met
            return Verdict.of(self._step, False, at_ns, seen_text(self._condition, scene, packet, self._window))
        if is_due or (is_over and self.deadline_ns is None):
            return Verdict.of(self._step, True, now_ns)
        return Verdict.of(self._step, False, now_ns, OVER) if is_over else None

    def _met(self, scene: Scene, now_ns: int) -> tuple[int, Seen | None] | None:
        """When it was met, and by which packet; looks only at what is new since the last look."""
        condition, looked = self._condition, self._looked
        self._looked = scene.here()
        if not condition.msg_ids:
            return (now_ns, None) if condition.holds(scene, looked) else None
        for packet in scene.packets[looked.packets :]:
            if self.deadline_ns is not None and packet.at_ns > self.deadline_ns:
                return None
            if packet.msg_id in condition.msg_ids and condition.met_by(scene, packet):
                return packet.at_ns, packet
        return None
